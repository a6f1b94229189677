"""What every room stands on: bad input, names with numbers, compiled functions, sources."""
