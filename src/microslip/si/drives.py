"""The drive of a contact in SI units: reading and checking its arguments."""

from __future__ import annotations

import math
from collections.abc import Mapping

from microslip.foundation.errors import InputError
from microslip.si.bodies import TwoBodies
from microslip.si.dimensionless import RealDrive, RealMotion, drive_groups
from microslip.si.quantities import read

SPRING = "a drive_stiffness"


def read_drive(
    motion: RealMotion,
    *,
    speed: object,
    force: object,
    drive_stiffness: object,
    mass: object,
    damping: object,
    sought: str | None = None,
) -> tuple[RealDrive, dict]:
    """The drive, and a dict of texts of what was understood; raises InputError.

    speed: as it was given, and read with the motion; sought: what is looked for.
    """
    given = {"drive_stiffness": drive_stiffness, "mass": mass, "damping": damping}
    if speed is None and force is None and sought != "speed":
        raise InputError("speed", None, "needed, or a force in its place")
    if speed is not None and force is not None:
        raise InputError("force", force, "allowed is a force or a speed, not both")
    steady = motion.steady
    for name, value in given.items():
        if value is not None and steady:
            allowed = f"allowed is none for {motion.name}, which is steady: nothing swings"
            raise InputError(name, value, allowed)
    if force is not None:
        for name in ("drive_stiffness", "damping"):
            if given[name] is not None:
                allowed = "allowed is none beside a force, which does not pull through a spring"
                raise InputError(name, given[name], allowed)
    elif drive_stiffness is None:
        for name, others in (("mass", f"a force or {SPRING}"), ("damping", SPRING)):
            if given[name] is not None:
                allowed = f"allowed beside {others}, for a speed alone moves any body"
                raise InputError(name, given[name], allowed)
    if drive_stiffness is not None and motion.name == "longitudinal" and motion.speed == 0.0:
        allowed = "allowed is a speed above 0 where a spring pulls a longitudinal motion"
        raise InputError("speed", speed, allowed)
    return _read(given | {"force": force})


def _read(given: Mapping[str, object]) -> tuple[RealDrive, dict[str, str]]:
    units = {
        "force": ("force", "N", True),
        "drive_stiffness": ("stiffness", "N/m", True),
        "mass": ("mass", "kg", False),
        "damping": ("damping", "N*s/m", False),
    }
    values, texts = {}, {}
    for name, (field, unit, above_zero) in units.items():
        if given[name] is not None:
            one = read(name, given[name], unit, low_open=above_zero)
            values[field], texts[name] = one.si, one.text
    return RealDrive(**values), texts


def checked_drive_groups(
    drive: RealDrive, motion: RealMotion, contact: TwoBodies, given: Mapping[str, object]
) -> dict:
    """drive_groups of a drive; raises InputError, with the value as it was given, for one that is
    beyond floating-point numbers.

    given: values by the names of the arguments.
    """
    found = drive_groups(drive, motion, contact)
    for name, value in found.items():
        if not math.isfinite(value):
            argument = "drive_stiffness" if name == "stiffness" else name
            problem = "over that of the contact, it is beyond the range of floating-point numbers"
            allowed = f"{problem}; allowed is what a laboratory can have"
            raise InputError(argument, given[argument], allowed)
    return found
