"""Discretised contacts under Coulomb's law, which share one interface (contact.py)."""
