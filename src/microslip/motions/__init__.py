"""Prescribed motions of the contact, one in each file, and the problem that they belong to."""
