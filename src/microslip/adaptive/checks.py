"""Checks of the arguments of a request.  Every error message names the argument."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from microslip.foundation.arguments import (
    LARGEST,
    LARGEST_BODY,
    SMALLEST_STIFFNESS,
    real,
)
from microslip.foundation.errors import InputError
from microslip.motions.by_name import motion_named
from microslip.motions.drive import Drive, Force, Spring
from microslip.motions.motion import Motion
from microslip.motions.problem import Problem
from microslip.pressures.by_name import pressure_named
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Pressure

LARGEST_FORCE = 1e6
"""Largest accepted force divided by mu times the mean normal load.  The contact already runs away
at 1."""


def checked_problem(
    motion: str | Motion | Problem,
    velocity: float | None,
    amplitude: float | None,
    *,
    pressure: str | Pressure = HERTZ,
    poisson: float = 0.0,
) -> Problem:
    """Check the arguments for one contact at a prescribed velocity, and parse strings.

    Parameters
    ----------
    motion : str, Motion or Problem
        A Problem replaces all other arguments.
    velocity, amplitude, pressure, poisson
        See `microslip.solve`.

    Raises
    ------
    InputError
        If an argument is out of range, if a Problem is combined with other arguments, or if the
        Problem has a drive.  The message names the argument.
    """
    problem = _problem(motion, velocity, amplitude, poisson, pressure)
    if problem.drive is not None:
        allowed = "allowed is none here: the velocity is prescribed"
        raise InputError("drive", str(problem.drive), allowed)
    return problem


def checked_driven_problem(
    motion: str | Motion | Problem,
    velocity: float | None,
    amplitude: float | None,
    *,
    pressure: str | Pressure = HERTZ,
    poisson: float = 0.0,
    **drive: float | None,
) -> Problem:
    """Check the arguments for one contact with any drive, and parse strings.

    Parameters
    ----------
    motion, velocity, amplitude, pressure, poisson
        See `microslip.solve`.  The velocity can be negative for self-propelled motions.
    **drive : float or None
        The arguments force, stiffness, mass and damping, see `microslip.solve`.

    Raises
    ------
    InputError
        If an argument is out of range, or if a Problem is combined with other arguments.  The
        message names the argument.
    """
    more: dict[str, Any] = {}
    if isinstance(motion, Problem):
        _refuse_beside_problem(**drive)
        if motion.drive is not None:
            _refuse_drive(motion)
    else:
        more["drive"] = checked_drive(velocity, **drive)
    return replace(_problem(motion, velocity, amplitude, poisson, pressure, backward=True), **more)


def _problem(
    motion: str | Motion | Problem,
    velocity: float | None,
    amplitude: float | None,
    poisson: float,
    pressure: str | Pressure,
    backward: bool = False,
) -> Problem:
    """Build a Problem, or check and return a given Problem.

    backward: whether the velocity of a self-propelled motion can be negative.
    """
    given = motion if isinstance(motion, Problem) else None
    if isinstance(motion, Problem):
        changed = {"pressure": None if pressure == HERTZ else pressure, "poisson": poisson or None}
        _refuse_beside_problem(velocity=velocity, amplitude=amplitude, **changed)
        velocity, amplitude, poisson = motion.velocity, motion.amplitude, motion.poisson
        pressure, motion = motion.pressure, motion.motion
    motion = motion if isinstance(motion, Motion) else motion_named(motion)
    pressure = pressure if isinstance(pressure, Pressure) else pressure_named(pressure)
    slowest = -LARGEST["velocity"] if backward and motion.propels else 0.0
    velocity = real("velocity", 0.0 if velocity is None else velocity, slowest, LARGEST["velocity"])
    if velocity < 0.0 and not pressure.mirrored:
        allowed = f"allowed is a number of at least 0 under {pressure.name}"
        raise InputError("velocity", velocity, f"{allowed}, which need not be symmetric")
    poisson = real("poisson", poisson, 0.0, 0.5)
    if motion.periodic and amplitude is not None:
        amplitude = real("amplitude", amplitude, 0.0, LARGEST["amplitude"])
    return given or Problem(motion, velocity, amplitude, poisson, pressure)


def _refuse_drive(problem: Problem) -> None:
    """Raise InputError if the drive of a Problem is outside the range of the solver."""
    drive = problem.drive
    assert drive is not None  # checked by the caller
    mass, damping = drive.mass or None, drive.damping or None
    if drive.force is None:
        checked_drive(problem.velocity, stiffness=drive.stiffness, mass=mass, damping=damping)
    else:
        checked_drive(None, force=drive.force, mass=mass)


def _refuse_beside_problem(**arguments: object) -> None:
    for name, value in arguments.items():
        if value is not None:
            raise InputError(name, value, "allowed is none beside a Problem, which has its own")


def checked_drive(
    velocity: float | None,
    force: float | None = None,
    stiffness: float | None = None,
    mass: float | None = None,
    damping: float | None = None,
) -> Drive | None:
    """Build the drive, or return None for a prescribed velocity.

    Raises InputError, which names the argument.
    """
    if velocity is None and force is None:
        raise InputError("velocity", None, "needed; allowed is a number, or a force in its place")
    if velocity is not None and force is not None:
        raise InputError("force", force, "allowed is a force or a velocity, not both")
    body = {"stiffness": stiffness, "mass": mass, "damping": damping}
    for name, value in body.items():
        if value is not None:
            softest = SMALLEST_STIFFNESS if name == "stiffness" and force is None else 0.0
            body[name] = real(name, value, softest, LARGEST_BODY)
    if force is not None:
        for name in ("stiffness", "damping"):
            if body[name] is not None:
                allowed = "allowed is none beside a force, which does not pull through a spring"
                raise InputError(name, body[name], allowed)
        return Force(real("force", force, -LARGEST_FORCE, LARGEST_FORCE), body["mass"] or 0.0)
    stiff = body["stiffness"]
    if stiff is None:
        for name in ("mass", "damping"):
            if body[name] is not None:
                allowed = "allowed beside a stiffness alone, for a velocity moves any body"
                raise InputError(name, body[name], allowed)
        return None
    return Spring(stiff, body["mass"] or 0.0, body["damping"] or 0.0)
