"""Compiled Coulomb step and march in time, which all discretised contacts share."""
