"""Closed forms and bounds: no solver, no files, no pictures."""
