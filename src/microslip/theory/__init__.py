"""Closed forms and bounds for friction. This package does not use the solver, files or plots."""
