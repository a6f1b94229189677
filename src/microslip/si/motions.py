"""The motions that have a meaning in SI units, in words.

Motions of a user's own, and families with numbers such as "elliptic:forward=0.5", are described by
their records.  Their amplitude is a length (times u_lim) where they do not rotate, and an angle
where they only rotate, as the bore does.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from microslip.foundation.errors import InputError

if TYPE_CHECKING:  # the command line needs the tables alone
    from microslip.motions.motion import Motion

UNIT_OF_AMPLITUDE = {"transverse": "m", "longitudinal": "m", "zigzag": "m", "bore": "rad"}
"""Motions that oscillate in one way, and the SI unit of what they oscillate in."""
COMBINED = {
    "elliptic": ("amplitude", "forward_amplitude"),
    "transverse-bore": ("amplitude", "rotation_amplitude"),
    "normal": ("load_amplitude",),
}
"""Motions that oscillate in several ways at once, and which amplitudes they need."""
PARTS = {
    "amplitude": ("lateral", "m"),
    "forward_amplitude": ("forward", "m"),
    "rotation_amplitude": ("angle", "rad"),
    "load_amplitude": ("load", "N"),
}
"""Amplitudes of such motions: the share of the solver's amplitude that each is, and its unit."""
TAKES = {motion: (*needed, "phase") for motion, needed in COMBINED.items()}
TAKES["normal"] = (*PARTS, "phase")
"""All that such motions take."""
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
"""Motions of this module, and what the sphere does in each."""
ALONG_THE_DRIVE = ("longitudinal", "elliptic", "normal")
"""Motions that can vibrate along the drive, or whose load and so friction force oscillates."""
SAME = 1e-3
"""Relative difference of two angles, one of them from 721 phases, that are equal."""


def check_motion(motion: object) -> None:
    """Raise InputError unless a motion names a motion that can be described in SI units."""
    if not isinstance(motion, str) or motion not in MOTIONS:
        record = _record(motion)
        if record.loads:
            allowed = "allowed is normal with a load_amplitude where the load oscillates"
            raise InputError("motion", motion, allowed)
        if record.periodic and not _unit(record):
            allowed = "allowed is a translation, or a rotation whose amplitude is that of bore"
            raise InputError("motion", motion, f"{allowed}; for both see transverse-bore")


def is_steady(motion: str) -> bool:
    """Whether nothing oscillates."""
    return motion == "continuous-bore" or motion not in MOTIONS and not _record(motion).periodic


def unit_of_amplitude(motion: str) -> str | None:
    """SI unit of the amplitude; None of motions that are steady or oscillate in several ways."""
    if motion in MOTIONS:
        return UNIT_OF_AMPLITUDE.get(motion)
    record = _record(motion)
    return _unit(record) if record.periodic else None


def is_along_the_drive(motion: str) -> bool:
    """Whether the vibration is along the direction of the pull, or may be."""
    if motion in MOTIONS:
        return motion in ALONG_THE_DRIVE
    ahead, _, _ = _oscillation(_record(motion))
    return bool(np.ptp(ahead) > 0.0)


def description(motion: str) -> str:
    """The motion of the sphere, in words."""
    return MOTIONS.get(motion) or f"is {_record(motion).summary}"


def _record(motion: Any) -> Motion:
    from microslip.motions.by_name import motion_named

    return motion_named(motion)


def _oscillation(motion: Motion) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Forward, lateral and angle through a period at the amplitude 1."""
    from microslip.motions.motion import LOOP

    return motion.displacement(LOOP, 0.0, 1.0, 0.0)


def _unit(motion: Motion) -> str | None:
    from microslip.theory import hertz

    ahead, aside, angle = _oscillation(motion)
    turned = float(np.abs(angle).max())
    if turned == 0.0:
        return "m"
    moved = float(np.hypot(ahead, aside).max())
    of_bore = abs(turned / float(hertz.bore_angle(1.0)) - 1.0) <= SAME
    return "rad" if moved == 0.0 and of_bore else None
