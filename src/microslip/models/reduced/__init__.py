"""Models that neglect elasticity, partial slip or the interaction of points."""
