"""Solver for one run at one resolution: its periodic, steady or static state."""
