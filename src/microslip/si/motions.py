"""The motions that have a meaning in SI units here, in words."""

from __future__ import annotations

UNIT_OF_AMPLITUDE = {"transverse": "m", "longitudinal": "m", "zigzag": "m", "bore": "rad"}
"""Scenes that oscillate in one way, and the SI unit of what they oscillate in."""
COMBINED = {
    "elliptic": ("amplitude", "forward_amplitude"),
    "transverse-bore": ("amplitude", "rotation_amplitude"),
    "normal": ("load_amplitude",),
}
"""Scenes that oscillate in several ways at once, and which amplitudes they need."""
PARTS = {
    "amplitude": ("lateral", "m"),
    "forward_amplitude": ("forward", "m"),
    "rotation_amplitude": ("angle", "rad"),
    "load_amplitude": ("load", "N"),
}
"""Amplitudes of such scenes: the share of the solver's amplitude that each is, and its unit."""
TAKES = {scene: (*needed, "phase") for scene, needed in COMBINED.items()}
TAKES["normal"] = (*PARTS, "phase")
"""All that such scenes take."""
MOTIONS = {
    "transverse": "slides forward and oscillates sideways",
    "longitudinal": "slides forward and oscillates along the same direction",
    "zigzag": "slides forward and moves sideways at constant speed, with abrupt turns",
    "bore": "slides forward and oscillates in spin, which is rotation about the contact normal",
    "elliptic": "slides forward and oscillates along the same direction and sideways",
    "transverse-bore": "slides forward and oscillates sideways and in spin",
    "normal": "slides forward while its normal load oscillates, alone or with a motion",
    "continuous-bore": "slides forward and spins steadily about the contact normal",
}
"""All scenes, and what the sphere does in each."""
