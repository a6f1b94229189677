"""Solver that computes a periodic, steady or static state in a single run at one resolution."""
