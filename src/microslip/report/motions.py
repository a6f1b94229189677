"""For each of the paper's two oscillating motions: the title, and the second force component."""

from __future__ import annotations

from typing import NamedTuple


class Motion(NamedTuple):
    """Texts of a motion: the heading, the name of the second force component in a period, and the
    HTML label of this component."""

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
"""Motions for which the explorer has stored periods and a form for real contacts. These motions
also have panels in the figures of the study `claims`."""
