"""The explorer, an interactive HTML page that shows all points."""
