"""Requests of sweeps, their results, and the store of results."""
