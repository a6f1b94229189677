"""Searches for the periodic state of a contact."""
