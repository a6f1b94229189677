"""The command `microslip predict --propulsion`: a call of predict_propulsion."""

from __future__ import annotations

from typing import TYPE_CHECKING

from microslip.foundation.errors import InputError

if TYPE_CHECKING:
    from microslip.si.propulsion import RealPropulsionLine

REFUSED = dict.fromkeys(
    ("speed", "force", "reduction", "drive_stiffness", "mass", "damping"),
    "the motion propels the body by itself",
)
REFUSED["rotation"] = "a self-propelled motion has no steady spin"
REFUSED |= dict.fromkeys(("radius_across", "contact_radius", "pressure"), "the body is a sphere")
REFUSED["map"] = "a map contains the friction at a speed"
REFUSED |= dict.fromkeys(
    ("forward_amplitude", "rotation_amplitude", "load_amplitude", "phase"),
    "numbers after the name of the motion set the components and their phases",
)
"""Options of predict that --propulsion does not accept, and the reasons."""


def line_of(motion: str, options: dict) -> RealPropulsionLine:
    """Return the force-speed line of a motion.  Raises InputError.

    options: options of predict, by name.
    """
    from microslip.si.propulsion import predict_propulsion

    for name, reason in REFUSED.items():
        if name in options:
            raise InputError(name, options[name], f"not allowed with --propulsion: {reason}")
    missing = dict.fromkeys(("radius", "load", "amplitude", "frequency"))
    return predict_propulsion(motion, **missing | options)
