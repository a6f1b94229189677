"""Datasets in xarray and netCDF, built from records, with limits from theory and interpolation."""
