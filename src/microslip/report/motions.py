"""The two oscillating motions of the paper: their titles, and the second component of the force."""

from __future__ import annotations

from typing import NamedTuple


class Motion(NamedTuple):
    """Texts of a motion: heading, name of the second force in a period, and its label in HTML."""

    title: str
    force: str
    force_label: str


TORQUE = "torque  <i>M<sub>z</sub></i>/<i>M</i><sub><i>z</i>,0</sub>"
MOTIONS = {
    "transverse": Motion(
        "transverse oscillation", "force_lateral", "lateral force / (<i>μF<sub>z</sub></i>)"
    ),
    "bore": Motion("oscillating bore", "torque", TORQUE),
}
"""Motions with stored periods, a form for real contacts, and panels in the figures of claims."""
