"""Interpolation between the nodes of a map, and estimates outside its tabulated range."""
