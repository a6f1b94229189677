"""Solver for a single run at one resolution, which computes a periodic, steady or static state."""
