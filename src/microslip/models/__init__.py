"""Discretised contacts under Coulomb's law. All of them have the interface of contact.py."""
