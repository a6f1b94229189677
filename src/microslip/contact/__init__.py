"""Discretised contacts: elastic operators, Coulomb's law and time integration."""
