"""Motions and pressures of the contact, and the class Problem."""
