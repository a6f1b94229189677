"""Records to xarray and netCDF, with the limits from theory; questions to datasets."""
