"""Interpolation between the nodes of a map, and estimates outside the tabulated range."""
