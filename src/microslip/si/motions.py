"""The motions that have a meaning in SI units here, in words."""

from __future__ import annotations

UNIT_OF_AMPLITUDE = {"transverse": "m", "longitudinal": "m", "zigzag": "m", "bore": "rad"}
"""Scenes that oscillate, and the SI unit of what they oscillate in."""
MOTIONS = {
    "transverse": "slides forward and oscillates sideways",
    "longitudinal": "slides forward and oscillates along the same direction",
    "zigzag": "slides forward and moves sideways at constant speed, with abrupt turns",
    "bore": "slides forward and oscillates in spin, which is rotation about the contact normal",
    "continuous-bore": "slides forward and spins steadily about the contact normal",
}
"""All scenes, and what the sphere does in each."""
