"""`microslip predict --propulsion`: options to arguments of predict_propulsion."""

from __future__ import annotations

from typing import TYPE_CHECKING

from microslip.foundation.errors import InputError
from microslip.foundation.spec import read

if TYPE_CHECKING:
    from microslip.si.propulsion import RealPropulsionLine

REFUSED = dict.fromkeys(
    ("speed", "force", "reduction", "drive_stiffness", "mass", "damping"),
    "the motion pulls by itself",
)
REFUSED["rotation"] = "such a motion has no rotation"
REFUSED |= dict.fromkeys(
    ("radius_across", "contact_radius", "pressure"), "it is computed for spheres, given by a radius"
)
REFUSED |= dict.fromkeys(
    ("forward_amplitude", "rotation_amplitude", "load_amplitude", "phase"),
    "the numbers of the motion are its shares of the amplitude and its phases",
)
"""Options of predict that --propulsion refuses, and why."""


def ask(motion: str, given: dict) -> RealPropulsionLine:
    """The si.propulsion.RealPropulsionLine; given: options by name.  Raises InputError."""
    from microslip.si.propulsion import predict_propulsion

    for name, reason in REFUSED.items():
        if name in given:
            raise InputError(name, given[name], f"allowed is none with --propulsion: {reason}")
    if "points" in given:
        given = given | {"points": read("points", given["points"], whole=True)}
    missing = dict.fromkeys(("radius", "load", "amplitude", "frequency"))
    return predict_propulsion(motion, **missing | given)
