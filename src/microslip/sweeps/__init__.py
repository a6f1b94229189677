"""Requests to the solver, their names, their answers and where these are kept."""
