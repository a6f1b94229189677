"""`microslip predict --driving`: options to arguments of predict_driving."""

from __future__ import annotations

from microslip.foundation.errors import InputError
from microslip.foundation.spec import read

REFUSED = ("speed", "force", "rotation", "reduction", "drive_stiffness", "mass", "damping")
REFUSED += ("radius_across", "contact_radius", "pressure", "forward_amplitude")
REFUSED += ("rotation_amplitude", "load_amplitude", "phase")
"""Of predict, what has no meaning where the motion itself pulls."""


def ask(scene: str, given: dict) -> object:
    """The si.driving.RealDrivingLine; given: options by name.  Raises InputError."""
    from microslip.si.driving import predict_driving

    for name in REFUSED:
        if name in given:
            allowed = "allowed is none with --driving: the motion pulls by itself"
            raise InputError(name, given[name], allowed)
    if "points" in given:
        given = given | {"points": read("points", given["points"], whole=True)}
    missing = dict.fromkeys(("radius", "load", "amplitude", "frequency"))
    return predict_driving(scene, **missing | given)
