"""Datasets in xarray and netCDF, built from records, with theoretical limits and interpolation."""
