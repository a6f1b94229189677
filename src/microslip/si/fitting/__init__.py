"""Fit a contact's coefficient of friction, and u_lim or G, to measured friction.

`measured` reads and checks the table.  `scales` converts the rows to dimensionless points for a
pair of values of the unknowns.  `friction_models` computes the friction of the points.  `estimate`
contains the least-squares fit and its intervals.  `fit` contains the public function, and `fitted`
contains its result.
"""
