"""Datasets: from records to xarray and netCDF, with limits from theory; interpolation."""
