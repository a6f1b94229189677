"""Build xarray and netCDF datasets from records, add theoretical limits, and interpolate maps."""
