"""Fit of a contact's coefficient of friction, and of u_lim or G, to measured friction.

`measured` reads and checks the table, `scales` turns its rows into dimensionless
points for a guess of both numbers, `friction_models` answers for the points, `estimate` is the
least squares with its intervals, `fit` puts them together and `fitted` holds the answer.
"""
