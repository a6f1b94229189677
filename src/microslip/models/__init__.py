"""Discretised contacts under Coulomb's law: one contract, several resolutions of the contact."""
