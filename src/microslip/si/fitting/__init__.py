"""Fit of a contact's coefficient of friction, and of u_lim or G, to measured friction.

`measured` reads and checks the table.  `scales` converts its rows to dimensionless points for a
guess of both numbers.  `friction_models` computes the friction of the points.  `estimate` is the
least squares with its intervals.  `fit` is the public function, and `fitted` its result.
"""
