"""What a point is asked with, checked: every refusal names the argument."""

from __future__ import annotations

from collections.abc import Callable

from microslip.foundation.arguments import (
    LARGEST,
    LARGEST_BODY,
    SMALLEST_STIFFNESS,
    count,
    is_real,
    real,
)
from microslip.foundation.errors import InputError
from microslip.motions.by_name import motion_named
from microslip.motions.drive import Drive
from microslip.motions.motion import Motion

SMALLEST_TOLERANCE = 1e-6
LARGEST_FORCE = 1e6
"""Over mu times the mean normal load: it runs away from 1 on, which is an answer."""


def checked_point(
    motion: str,
    velocity: float,
    amplitude: float | None,
    poisson: float,
    pressure: str = "hertz",
    *,
    backward: bool = False,
) -> tuple[Motion, float, float | None, float]:
    """Motion record and numbers of a point; raises InputError naming the argument at fault.

    backward: whether the velocity may be below 0 where the motion propels the contact.
    """
    motion = motion_named(motion, pressure)
    slowest = -LARGEST["velocity"] if backward and motion.propels else 0.0
    velocity = real("velocity", velocity, slowest, LARGEST["velocity"])
    if velocity < 0.0 and not motion.pressure.mirrored:
        allowed = f"allowed is a number of at least 0 under {motion.pressure.name}"
        raise InputError("velocity", velocity, f"{allowed}, which need not be symmetric")
    poisson = real("poisson", poisson, 0.0, 0.5)
    if motion.periodic:
        if amplitude is None:
            raise InputError("amplitude", None, f"{motion.name} needs an amplitude >= 0")
        amplitude = real("amplitude", amplitude, 0.0, LARGEST["amplitude"])
    elif amplitude is not None:
        raise InputError("amplitude", amplitude, f"{motion.name} has no amplitude")
    return motion, velocity, amplitude, poisson


def checked_propulsion(
    motion: str, amplitude: float, poisson: float, pressure: str = "hertz"
) -> tuple[Motion, float, float]:
    """Motion record and numbers of a motion that may drive; raises InputError naming the argument
    at fault."""
    if not motion_named(motion, pressure).propels:
        allowed = (
            "allowed is a self-propelled motion, such as elliptic:forward_cycles=2,phase=0 or "
        )
        raise InputError("motion", motion, f"{allowed}normal:forward=1,phase=90")
    record, _, amplitude, poisson = checked_point(motion, 0.0, amplitude, poisson, pressure)
    if not record.pressure.mirrored:
        raise InputError("pressure", pressure, "allowed is one that is its own mirror image")
    if amplitude == 0.0:
        raise InputError("amplitude", amplitude, "allowed is a number above 0")
    return record, amplitude, poisson


def checked_drive(
    velocity: float | None,
    force: float | None,
    stiffness: float | None,
    mass: float | None,
    damping: float | None,
) -> Drive | None:
    """What pulls, None where the velocity alone does; raises InputError naming the argument."""
    if velocity is None and force is None:
        raise InputError("velocity", None, "allowed is a number, or a force in its place")
    if velocity is not None and force is not None:
        raise InputError("force", force, "allowed is a force or a velocity, not both")
    body = {"stiffness": stiffness, "mass": mass, "damping": damping}
    for name, value in body.items():
        if value is not None:
            body[name] = real(name, value, 0.0, LARGEST_BODY)
    if force is not None:
        for name in ("stiffness", "damping"):
            if body[name] is not None:
                allowed = "allowed is none beside a force, which does not pull through a spring"
                raise InputError(name, body[name], allowed)
        return Drive(
            force=real("force", force, -LARGEST_FORCE, LARGEST_FORCE), mass=body["mass"] or 0.0
        )
    if stiffness is None:
        for name in ("mass", "damping"):
            if body[name] is not None:
                allowed = "allowed beside a stiffness alone, for a velocity moves any body"
                raise InputError(name, body[name], allowed)
        return None
    if body["stiffness"] < SMALLEST_STIFFNESS:
        allowed = "allowed is a number above 0, at least "
        allowed += f"{SMALLEST_STIFFNESS:g} and at most {LARGEST_BODY:g}"
        raise InputError("stiffness", stiffness, allowed)
    return Drive(None, body["stiffness"], body["mass"] or 0.0, body["damping"] or 0.0)


def checked_request(
    tolerance: float | None, cells: int | None, steps: int | None
) -> tuple[float | None, int | None, int | None]:
    """Tolerance, if any, and imposed resolution; raises InputError naming the argument at fault."""
    cells, steps = _count("cells", cells, 4), _count("steps", steps, 8)
    if tolerance is not None:
        tolerance = real("tolerance", tolerance, SMALLEST_TOLERANCE, 0.1)
    return tolerance, cells, steps


def refuse_bounds(**given: float | None) -> None:
    """Raise InputError for a bound, None or a number, that is not above 0."""
    for name, value in given.items():
        if value is not None and not (is_real(value) and value > 0.0):
            raise InputError(name, value, "allowed is a number above 0")


def refuse_progress(progress: Callable | None) -> None:
    """Raise InputError where `progress` is neither None nor callable."""
    if progress is not None and not callable(progress):
        raise InputError("progress", progress, "allowed is a function of one argument")


def _count(name, value, low):
    return None if value is None else count(name, value, low, most=LARGEST[name], even=True)
