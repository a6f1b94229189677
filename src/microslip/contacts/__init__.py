"""Discretised contacts, the Coulomb step, and the march in time that all of them share."""
