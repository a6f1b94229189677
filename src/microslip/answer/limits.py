"""Check the arguments of a request, and choose the contact model.

An error message names the argument, its value and the allowed values.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from microslip.contact.registry import MODELS
from microslip.foundation.arguments import (
    LARGEST,
    LARGEST_BODY,
    SMALLEST_STIFFNESS,
    SMALLEST_TOLERANCE,
    count,
    is_real,
    real,
)
from microslip.foundation.errors import InputError
from microslip.periodic.methods import SHIPPED, method_named, missing
from microslip.scene.by_name import motion_named, pressure_named
from microslip.scene.hertz import HERTZ
from microslip.scene.motion import LOOP, Motion
from microslip.scene.pressure import Pressure
from microslip.scene.problem import Drive, Force, Problem, Spring


class Limit(NamedTuple):
    """Range of allowed values of a number.

    Attributes
    ----------
    low, high : float
        Smallest and largest allowed value.
    kind : str
        "real", "whole" (an integer) or "even".
    """

    low: float
    high: float
    kind: str = "real"


LARGEST_FORCE = 1e6
"""Largest accepted force divided by mu times the mean normal load.  At a value of 1, the contact
already runs away."""
LIMITS = {
    "velocity": Limit(0.0, LARGEST["velocity"]),
    "amplitude": Limit(0.0, LARGEST["amplitude"]),
    "poisson": Limit(0.0, 0.5),
    "force": Limit(-LARGEST_FORCE, LARGEST_FORCE),
    "stiffness": Limit(SMALLEST_STIFFNESS, LARGEST_BODY),
    "mass": Limit(0.0, LARGEST_BODY),
    "damping": Limit(0.0, LARGEST_BODY),
    "tolerance": Limit(SMALLEST_TOLERANCE, 0.1),
    "cells": Limit(4, LARGEST["cells"], "even"),
    "angles": Limit(2, 1000, "even"),
    "steps": Limit(8, LARGEST["steps"], "even"),
    "periods": Limit(1, 10 * LARGEST["steps"], "whole"),
    "travel": Limit(1e-9, 1e6),
    "elements": Limit(1, 10_000, "whole"),
}
"""Limits of the arguments by name.  A function that needs other limits passes them to `within`.
The units are those of `microslip.solve`.  The travel is in u_lim."""
RETURNED = 1e-12
"""A forward oscillation below this fraction of the amplitude is treated as a rounding error."""
CLOSEST_FORCE = 0.9999
"""Forces between this value and 1 are refused.  The forces are divided by mu times the mean normal
load.  With a transverse oscillation, runs converged for forces up to 0.9998.  At this force, the
contact already advances by 200 amplitudes per period."""
CLOSEST_STEADY_FORCE = 1.0 - 1e-7
"""Largest force on a steady rotation, divided by mu times the mean normal load.  The friction has a
rounding error of 1.1e-16.  In the velocity, this error causes a relative error of 1.1e-16 / (2 (1 -
force)).  At this force, the relative error is close to the error estimate of 1e-9."""
STEPLESS = ("rigid", "dahl")
"""Models that need no step solver, because they evaluate a formula at every step."""


def within(name: str, value: object, **changes: Any) -> Any:
    """Return an argument as a number. Raise InputError unless the argument is a number within its
    limits.

    LIMITS has an entry for each argument.  The keyword arguments `changes` replace fields of this
    entry.
    """
    low, high, kind = LIMITS[name]._replace(**changes)
    if kind == "real":
        return real(name, value, low, high)
    return count(name, value, int(low), most=high, even=kind == "even")


# Problems


def problem_of(
    motion: str | Motion | Problem,
    velocity: float | None = None,
    amplitude: float | None = None,
    *,
    pressure: str | Pressure = HERTZ,
    poisson: float = 0.0,
    drive: Mapping[str, float | None] | None = None,
) -> Problem:
    """Check the arguments that describe a contact, and create the `Problem`.

    Parameters
    ----------
    motion : str, Motion or Problem
        A Problem replaces all other arguments.
    velocity, amplitude, pressure, poisson
        See `microslip.solve`.
    drive : mapping of float or None
        The arguments force, stiffness, mass and damping of `microslip.solve`; missing ones are
        None.  If the mapping itself is None, the velocity is prescribed and at least 0.

    Raises
    ------
    InputError
        If an argument is out of range, or if a Problem is combined with other arguments.  The
        message names the argument.
    """
    given, own = motion if isinstance(motion, Problem) else None, None
    if isinstance(motion, Problem):
        beside: dict[str, object] = {"velocity": velocity, "amplitude": amplitude, **(drive or {})}
        beside |= {"pressure": None if pressure is HERTZ else pressure}
        beside |= {"poisson": None if is_real(poisson) and poisson == 0.0 else poisson}
        for name, value in beside.items():
            if value is not None:
                raise InputError(name, value, "allowed is none beside a Problem, which has its own")
        own, velocity, amplitude = motion.drive, motion.velocity, motion.amplitude
        kind, shape = motion.motion, motion.pressure
        if own is not None and drive is None:
            raise InputError("drive", str(own), "allowed is none here: the velocity is prescribed")
        if own is not None:
            body = {name: getattr(own, name) or None for name in ("stiffness", "mass", "damping")}
            _drive_of(None if own.force is not None else velocity, own.force, **body)
    else:
        kind, shape = motion_named(motion), pressure_named(pressure)
        own = None if drive is None else _drive_of(velocity, **drive)
    slowest = -LARGEST["velocity"] if drive is not None and kind.propels else 0.0
    velocity = within("velocity", 0.0 if velocity is None else velocity, low=slowest)
    if velocity < 0.0 and not shape.mirrored:
        allowed = f"allowed is a number of at least 0 under {shape.name}"
        raise InputError("velocity", velocity, f"{allowed}, which need not be symmetric")
    if kind.periodic and amplitude is not None:
        amplitude = within("amplitude", amplitude)
    return given or Problem(kind, velocity, amplitude, poisson, shape, own)


def _drive_of(
    velocity: float | None,
    force: float | None = None,
    stiffness: float | None = None,
    mass: float | None = None,
    damping: float | None = None,
) -> Drive | None:
    """Build the drive, or return None for a prescribed velocity."""
    if velocity is None and force is None:
        raise InputError("velocity", None, "needed; allowed is a number, or a force in its place")
    if velocity is not None and force is not None:
        raise InputError("force", force, "allowed is a force or a velocity, not both")
    given = {"stiffness": stiffness, "mass": mass, "damping": damping}
    body = {name: within(name, value) for name, value in given.items() if value is not None}
    if force is None and stiffness is not None:
        return Spring(**body)
    allowed = "allowed beside a stiffness alone, for a velocity moves any body"
    if force is not None:
        allowed = "allowed is none beside a force, which does not pull through a spring"
    for name, value in body.items():
        if force is None or name != "mass":
            raise InputError(name, value, allowed)
    return None if force is None else Force(within("force", force), **body)


# Oscillations under a force


def oscillates_forward(problem: Problem) -> bool:
    """Return whether the oscillation has a forward component."""
    forward = problem.displacement(LOOP, 0.0)[0]
    return float(np.ptp(forward)) > RETURNED * max(problem.size, 1.0)


def oscillates(problem: Problem) -> bool:
    """Return whether the motion or the normal load oscillates."""
    parts = problem.displacement(LOOP, 0.0)
    moves = max(float(np.ptp(part)) for part in parts) > RETURNED * max(problem.size, 1.0)
    return moves or (problem.depth is not None and problem.size > 0.0)


def without_forward_motion(problem: Problem) -> Problem:
    """Return the problem without the oscillation along the direction of the force.

    Under a constant force, the forward force on a contact without mass is constant.  Then the body
    follows the forward oscillation. Therefore, the forward oscillation has no effect.
    """
    return replace(problem, follows=True) if oscillates_forward(problem) else problem


def is_even(problem: Problem) -> bool:
    """Return whether the oscillation alone exerts no forward force at any time.

    If the oscillation exerts no forward force, the contact moves under every force above the static
    limit, and under no smaller force.
    """
    motion, pressure = problem.motion, problem.pressure
    if oscillates_forward(problem) or not motion.half_disc:
        return False
    if motion.rotates:
        return pressure.is_round or (pressure.mirrored and not motion.loads)
    return pressure.is_round or pressure.mirrored or problem.poisson == 0.0


def least_load(problem: Problem) -> float:
    """Return the smallest normal load in a period, divided by the mean normal load."""
    if not problem.motion.periodic or problem.depth is None:
        return 1.0
    loads = problem.pressure.total(np.asarray(problem.depth(LOOP), dtype=float))
    return max(float(loads.min()), 0.0) / problem.mean_load


def runs_away(problem: Problem) -> str:
    """Return the reason why a contact under a force has no mean velocity, or "" if it has one."""
    drive, force = problem.drive, problem.force
    if drive is None or force is None:
        return ""
    if abs(force) >= 1.0:
        return f"runs away: the force {force:g} is at least full friction"
    least = least_load(problem)
    if drive.mass == 0.0 and force >= least:
        return (
            f"runs away: without mass it slides off at the least normal load, {least:.3g} of the "
            "mean, which limits the friction"
        )
    return ""


# Models and contradictions


def choose_model(problem: Problem, model: str = "auto") -> str:
    """Return the name of the model.

    For "auto", the result is the cheapest exact model.  Any other `model` is returned unchanged.
    Rings are chosen if the traction depends only on the radius (translation at nu = 0).  Angular
    modes are chosen for other motions of a round contact, and squares in all other cases.  Squares
    are also chosen for the static limit of a contact without symmetry, because the stick zone of
    such a contact is not round.  The slider and the rigid contact are never chosen.  For these two
    models, the model error could only be bounded with a run on rings.  Such a run already gives the
    result.

    Parameters
    ----------
    problem : problem.Problem
        The problem.  At velocity 0 without a drive, the result is the static limit.
    model : str
        "auto", or a name in contact.registry.MODELS.

    Raises
    ------
    InputError
        If the model is unknown or does not apply.
    """
    if not isinstance(model, str) or model not in ("auto", *MODELS):
        raise InputError("model", model, f"allowed is one of auto, {', '.join(MODELS)}")
    motion, name = problem.motion, model
    if model == "auto":
        static = problem.velocity == 0.0 and problem.drive is None and motion.periodic
        by_squares = static and not motion.loads and not motion.half_disc
        name = "polar" if motion.rotates or problem.poisson > 0.0 else "radial"
        if by_squares or not problem.pressure.is_round:
            name = "cartesian"
    refusal = MODELS[name].refuses(problem)
    if not refusal:
        return name
    if model != "auto":
        raise InputError("model", model, f"does not apply to {motion.name}: {refusal}")
    why = f"only {name} could resolve it, and {refusal}"
    if problem.pressure == HERTZ and problem.poisson == 0.0:
        raise InputError("motion", motion.name, why)
    argument: tuple[str, object] = ("poisson", problem.poisson)
    if problem.pressure != HERTZ:
        argument = ("pressure", problem.pressure.name)
    raise InputError(*argument, f"does not go with {motion.name}: {why}")


def method_refusal(problem: Problem, model: str, method: str) -> str:
    """Return the reason why a method does not apply to a model and a motion, or "" if it
    applies."""
    motion = problem.motion
    if method == SHIPPED:
        return ""
    how = method_named(method)
    if how.run is not None:
        if model != how.model:
            return f"it is a run of the model {how.model}"
        if not motion.periodic:
            return "nothing oscillates"
        if motion.loads:
            return "it supports a constant normal load only"
        return "it supports translations only" if motion.rotates and not how.turns else ""
    if motion.loads and (how.dress is not None or how.integrator.end < 1.0):
        return "its steps support a constant friction bound only"
    if model in STEPLESS:
        return "the model has no steps to solve"
    if not motion.periodic and how.dress is None:
        return "nothing oscillates"
    if model == "cartesian" and how.dress is not None:
        return "the matrix of all squares would be too large"
    return ""


def refuse(problem: Problem, model: str, method: str = SHIPPED) -> None:
    """Raise InputError if arguments contradict each other.

    Parameters
    ----------
    problem : problem.Problem
        The problem, see `problem_of`.
    model : str
        Name of the model, see `choose_model`.
    method : str
        Name of the method.
    """
    motion, drive, periodic = problem.motion, problem.drive, problem.motion.periodic
    if not isinstance(method, str):
        raise InputError("method", method, f"allowed is a name such as {SHIPPED}")
    shipped = method == SHIPPED
    if not shipped:
        lack = missing(method)
        if lack:
            raise InputError("method", method, lack)
        refusal = method_refusal(problem, model, method)
        if not refusal and method_named(method).run is not None:
            refusal = "it is one run, which cannot be refined"
        if refusal:
            where = f"does not apply to {motion.name}, model {model}"
            raise InputError("method", method, f"{where}: {refusal}")
    if drive is None:
        return
    force, pulls = drive.force, "stiffness" if drive.force is None else "force"
    if force is not None and force < 0.0 and not problem.propels:
        reason = f"{motion.name} propels nothing"
        raise InputError("force", force, f"allowed is a number of at least 0: {reason}")
    if not MODELS[model].drivable:
        raise InputError("model", model, f"supports no {pulls}, only a prescribed velocity")
    if not shipped:
        raise InputError("method", method, f"allowed is {SHIPPED} with a {pulls}")
    if force is None:
        if periodic and problem.velocity == 0.0 and not is_even(problem):
            allowed = f"allowed is a number above 0 for {motion.name} with a spring"
            raise InputError("velocity", 0.0, allowed)
        return
    if not periodic and (motion.name != "continuous-bore" or not problem.pressure.is_round):
        place = f"{motion.name} under {problem.pressure.name}"
        raise InputError("force", force, f"allowed is none for {place}, which has no closed form")
    closest = CLOSEST_FORCE if periodic else CLOSEST_STEADY_FORCE
    if closest <= abs(force) < 1.0 and not runs_away(problem):
        moving = problem if drive.mass or not periodic else without_forward_motion(problem)
        if not periodic or oscillates(moving):
            allowed = f"allowed is a force below {closest:.9g} (of mu times the mean normal load), "
            allowed += "or from 1 on, where the contact runs away; in between the velocity is too "
            raise InputError("force", force, allowed + "large to be computed")
