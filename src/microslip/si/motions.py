"""Motions in SI units: their arguments, amplitudes and descriptions.

A motion from a user's file, or a motion with parameters such as "elliptic:forward=0.5", is
described by a Motion record.  The amplitude is a length for a pure translation, and an angle for a
pure rotation.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from microslip.foundation.errors import InputError
from microslip.foundation.named_files import speaks_of_file

if TYPE_CHECKING:
    from microslip.si.strokes import Stroke

PARTS = {
    "amplitude": "lateral",
    "forward_amplitude": "forward",
    "rotation_amplitude": "angle",
    "load_amplitude": "load",
}
"""Arguments with amplitudes, and their names in the solver's motion text."""
SAME = 1e-3
"""Largest relative difference between two angles that count as equal.  The angles can differ
because one of them is sampled at 721 phases."""


@dataclass(frozen=True)
class RealMotionKind:
    """Arguments of `predict` for a motion, and its description.

    Attributes
    ----------
    description : str
        What the sphere does.
    unit : str or None
        SI unit of the amplitude, if it is the only one.  It is empty for a motion from a file,
        whose amplitude is a factor.
    needed, optional : tuple of str
        Required and optional arguments.
    along_the_drive : bool
        True if the vibration may have a component along the drive, or if the load oscillates.
    stroke : Stroke or None
        One period of the motion, if it is read from a file.
    """

    description: str
    unit: str | None = None
    needed: tuple[str, ...] = ("amplitude", "frequency")
    optional: tuple[str, ...] = ()
    along_the_drive: bool = False
    stroke: Stroke | None = None

    @property
    def steady(self) -> bool:
        """True if nothing oscillates."""
        return "frequency" not in self.needed

    @property
    def several(self) -> bool:
        """True for a motion with several oscillations, and for a motion from a file."""
        return not (self.unit or self.steady)


MOTIONS = {
    "transverse": RealMotionKind("slides forward and oscillates sideways", "m"),
    "longitudinal": RealMotionKind(
        "slides forward and oscillates along the same direction", "m", along_the_drive=True
    ),
    "zigzag": RealMotionKind(
        "slides forward and moves sideways at constant speed, with abrupt turns", "m"
    ),
    "bore": RealMotionKind(
        "slides forward and oscillates in spin, which is rotation about the contact normal", "rad"
    ),
    "elliptic": RealMotionKind(
        "slides forward and oscillates along the same direction and sideways",
        needed=("amplitude", "forward_amplitude", "frequency"),
        optional=("phase",),
        along_the_drive=True,
    ),
    "transverse-bore": RealMotionKind(
        "slides forward and oscillates sideways and in spin",
        needed=("amplitude", "rotation_amplitude", "frequency"),
        optional=("phase",),
    ),
    "normal": RealMotionKind(
        "slides forward while its normal load oscillates, alone or with a motion",
        needed=("load_amplitude", "frequency"),
        optional=(*PARTS, "phase"),
        along_the_drive=True,
    ),
    "continuous-bore": RealMotionKind(
        "slides forward and spins steadily about the contact normal", needed=("rotation",)
    ),
}
FIT_MOTIONS = ("transverse", "longitudinal", "zigzag")
"""Motions for which `microslip.fit` is possible."""


def kind_of(motion: Any) -> RealMotionKind:
    """The kind of a motion.  Raises InputError unless its amplitudes can be stated in SI units."""
    from microslip.motions.by_name import motion_named
    from microslip.motions.motion import LOOP
    from microslip.si.strokes import read_stroke

    if speaks_of_file(motion):
        stroke = read_stroke(motion)
        rows, names = len(next(iter(stroke.columns.values()))), list(stroke.columns)
        text = f"slides forward and follows {rows} samples of its {' and '.join(names)}"
        along = not {"forward", "load", "indentation"}.isdisjoint(names)
        return RealMotionKind(text, "", along_the_drive=along, stroke=stroke)
    if isinstance(motion, str) and motion in MOTIONS:
        return MOTIONS[motion]
    record = motion_named(motion)
    text = f"is {record.summary}"
    if record.loads:
        allowed = "allowed is normal with a load_amplitude for an oscillating load"
        raise InputError("motion", motion, allowed)
    if not record.periodic:
        return RealMotionKind(text, needed=("rotation",))
    ahead, aside, angle = record.displacement(LOOP, 0.0, 1.0, 0.0)
    unit = _unit(float(np.hypot(ahead, aside).max()), float(np.abs(angle).max()))
    if unit is None:
        allowed = "allowed is a translation or a rotation; for both use transverse-bore"
        raise InputError("motion", motion, allowed)
    return RealMotionKind(text, unit, along_the_drive=bool(np.ptp(ahead) > 0.0))


def _unit(stroke: float, angle: float) -> str | None:
    """SI unit of the amplitude; None for a motion with both a stroke and a rotation.

    stroke, angle: largest displacement and rotation at amplitude 1.
    """
    from microslip.theory import hertz

    if angle == 0.0:
        return "m"
    of_bore = abs(angle / float(hertz.bore_angle(1.0)) - 1.0) <= SAME
    return "rad" if stroke == 0.0 and of_bore else None
