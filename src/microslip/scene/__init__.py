"""Prescribed motions of the contact, each in its own file, and the class Problem."""
