"""Discretisation error: levels of resolution, Richardson extrapolation, refinement."""
