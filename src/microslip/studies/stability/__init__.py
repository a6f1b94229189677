"""Study of the failures of methods."""
