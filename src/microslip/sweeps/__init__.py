"""Requests and results of sweeps, and the store in which results are kept."""
