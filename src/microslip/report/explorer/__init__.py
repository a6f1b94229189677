"""The explorer: an interactive HTML page of all points."""
