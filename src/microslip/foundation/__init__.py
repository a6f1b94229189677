"""Basic functions for all packages: errors, names with parameters, compiled functions, source
digests."""
