"""Closed forms and bounds of friction. Needs no solver, files or plots."""
