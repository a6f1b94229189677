"""Models that leave elasticity or partial slip out."""
