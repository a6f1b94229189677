"""Basic tools for all packages: error classes, parsing of names with parameters, compilation of
functions, and digests of sources."""
