"""Compiled Coulomb step and march in time, used by all discretised contacts."""
