"""Discretised contacts: elastic operators, Coulomb's law, and the march in time."""
