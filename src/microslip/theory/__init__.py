"""Closed forms and bounds of friction. This package uses no solver, files or plots."""
