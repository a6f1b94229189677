"""Basic functions for all packages: errors, names with numbers, compiled functions, source
digests."""
