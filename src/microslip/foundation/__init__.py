"""Common base of all packages: bad input, names with numbers, compiled functions, sources."""
