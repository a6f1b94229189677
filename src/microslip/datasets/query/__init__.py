"""Questions to a map, between and beyond its nodes."""
