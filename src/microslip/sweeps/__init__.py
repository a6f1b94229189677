"""Requests and results of sweeps, and the store of results."""
