"""Motions in SI units: amplitudes, units and descriptions.

A motion from a user's file, or a motion with parameters such as "elliptic:forward=0.5", is
described by a Motion record.  The amplitude is a length for a pure translation, and an angle for a
pure rotation.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from microslip.foundation.errors import InputError
from microslip.foundation.named_files import speaks_of_file

if TYPE_CHECKING:  # the command line needs only the tables
    from microslip.motions.motion import Motion
    from microslip.si.strokes import Stroke

UNIT_OF_AMPLITUDE = {"transverse": "m", "longitudinal": "m", "zigzag": "m", "bore": "rad"}
"""SI unit of the amplitude for each motion with one oscillation."""
COMBINED = {
    "elliptic": ("amplitude", "forward_amplitude"),
    "transverse-bore": ("amplitude", "rotation_amplitude"),
    "normal": ("load_amplitude",),
}
"""Required amplitudes of the motions with several oscillations."""
PARTS = {
    "amplitude": ("lateral", "m"),
    "forward_amplitude": ("forward", "m"),
    "rotation_amplitude": ("angle", "rad"),
    "load_amplitude": ("load", "N"),
}
"""For each of these amplitudes, its name in the solver's motion text, and its SI unit."""
TAKES = {motion: (*needed, "phase") for motion, needed in COMBINED.items()}
TAKES["normal"] = (*PARTS, "phase")
"""Allowed arguments of the motions with several oscillations."""
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
"""Descriptions of the sphere's motions."""
ALONG_THE_DRIVE = ("longitudinal", "elliptic", "normal")
"""Motions that vibrate along the drive, or have an oscillating load."""
SAME = 1e-3
"""Largest relative difference between two angles that count as equal.  The angles can differ
because one of them is sampled at 721 phases."""


def check_motion(motion: object) -> None:
    """Raise InputError unless the amplitudes of a motion can be stated in SI units."""
    if speaks_of_file(motion):
        _stroke(motion)
    elif not isinstance(motion, str) or motion not in MOTIONS:
        record = _record(motion)
        if record.loads:
            allowed = "allowed is normal with a load_amplitude for an oscillating load"
            raise InputError("motion", motion, allowed)
        if record.periodic and not _unit(record):
            allowed = "allowed is a translation or a rotation; for both use transverse-bore"
            raise InputError("motion", motion, allowed)


def is_steady(motion: str) -> bool:
    """True if nothing oscillates."""
    if motion in MOTIONS or speaks_of_file(motion):
        return motion == "continuous-bore"
    return not _record(motion).periodic


def has_several_amplitudes(motion: str) -> bool:
    """True for a motion with several oscillations, and for a motion from a file."""
    return motion in COMBINED or speaks_of_file(motion)


def unit_of_amplitude(motion: str) -> str | None:
    """SI unit of the amplitude; None for a steady motion or one with several oscillations.

    The amplitude of a motion from a file is a factor, so its unit is empty.
    """
    if speaks_of_file(motion):
        return ""
    if motion in MOTIONS:
        return UNIT_OF_AMPLITUDE.get(motion)
    record = _record(motion)
    return _unit(record) if record.periodic else None


def is_along_the_drive(motion: str) -> bool:
    """True if the vibration may have a component along the drive."""
    if motion in MOTIONS:
        return motion in ALONG_THE_DRIVE
    if speaks_of_file(motion):
        return not {"forward", "load", "indentation"}.isdisjoint(_stroke(motion).columns)
    ahead, _, _ = _oscillation(_record(motion))
    return bool(np.ptp(ahead) > 0.0)


def description(motion: str) -> str:
    """Describe the sphere's motion in words."""
    if speaks_of_file(motion):
        columns = _stroke(motion).columns
        rows = len(next(iter(columns.values())))
        return f"slides forward and follows {rows} samples of its {' and '.join(columns)}"
    return MOTIONS.get(motion) or f"is {_record(motion).summary}"


def _record(motion: Any) -> Motion:
    from microslip.motions.by_name import motion_named

    return motion_named(motion)


def _stroke(motion: str) -> Stroke:
    from microslip.si.strokes import read_stroke

    return read_stroke(motion)


def _oscillation(motion: Motion) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Forward displacement, lateral displacement and angle over one period, at amplitude 1."""
    from microslip.motions.motion import LOOP

    return motion.displacement(LOOP, 0.0, 1.0, 0.0)


def _unit(motion: Motion) -> str | None:
    from microslip.theory import hertz

    ahead, aside, angle = _oscillation(motion)
    turned = float(np.abs(angle).max())
    if turned == 0.0:
        return "m"
    stroke = float(np.hypot(ahead, aside).max())
    of_bore = abs(turned / float(hertz.bore_angle(1.0)) - 1.0) <= SAME
    return "rad" if stroke == 0.0 and of_bore else None
