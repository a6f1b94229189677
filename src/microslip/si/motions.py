"""The motions that have a meaning in SI units, in words.

Motions of a user's own, and families with numbers such as "elliptic:forward=0.5", are described by
their records.  Their amplitude is a length (times u_lim) where they do not rotate, and an angle
where they only rotate, as the bore does.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from microslip.foundation.errors import InputError

if TYPE_CHECKING:  # the command line needs the tables alone
    from microslip.motions.motion import Motion

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
"""Scenes of this module, and what the sphere does in each."""
ALONG_THE_PULL = ("longitudinal", "elliptic", "normal")
"""Those that vibrate along the pull, or may; or whose load, and so the force, oscillates."""
SAME = 1e-3
"""Relative difference of two angles, one of them from 721 phases, that are equal."""


def check_scene(scene: object) -> None:
    """Raise InputError unless a scene names a motion that can be described in SI units."""
    if not isinstance(scene, str) or scene not in MOTIONS:
        motion = _record(scene)
        if motion.depth is not None:
            allowed = "allowed is normal with a load_amplitude where the load oscillates"
            raise InputError("scene", scene, allowed)
        if motion.periodic and not _unit(motion):
            allowed = "allowed is a translation, or a rotation whose amplitude is that of bore"
            raise InputError("scene", scene, f"{allowed}; for both see transverse-bore")


def is_steady(scene: str) -> bool:
    """Whether nothing oscillates."""
    return scene == "continuous-bore" or scene not in MOTIONS and not _record(scene).periodic


def unit_of_amplitude(scene: str) -> str | None:
    """SI unit of the amplitude; None of scenes that are steady or oscillate in several ways."""
    if scene in MOTIONS:
        return UNIT_OF_AMPLITUDE.get(scene)
    motion = _record(scene)
    return _unit(motion) if motion.periodic else None


def is_along_the_pull(scene: str) -> bool:
    """Whether the vibration is along the direction of the pull, or may be."""
    if scene in MOTIONS:
        return scene in ALONG_THE_PULL
    ahead, _, _ = _oscillation(_record(scene))
    return bool(np.ptp(ahead) > 0.0)


def description(scene: str) -> str:
    """What the sphere does, in words."""
    return MOTIONS.get(scene) or f"is {_record(scene).summary}"


def _record(scene) -> Motion:
    from microslip.motions.by_name import motion_named

    return motion_named(scene)


def _oscillation(motion):
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
