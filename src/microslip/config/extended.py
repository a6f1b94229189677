"""Motions, pressures and drives of sweeps, given by names such as "elliptic:forward=0.5,phase=30".

Every parse of the workflow imports this module.  So the solver is imported inside functions.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from microslip.config.axes import DRIVES
from microslip.config.records import Refusal, Sweep

if TYPE_CHECKING:
    from microslip.motions.problem import Problem


def solver_names(sweep: Sweep) -> tuple[str, str]:
    """Canonical names of the motion and the pressure of a sweep.

    Equal motions and equal pressures have equal names.  Stored points are looked up by these
    names.
    """
    if ":" not in sweep.motion + sweep.pressure:
        return sweep.motion, sweep.pressure  # a name without numbers is canonical
    from microslip.motions.by_name import motion_named
    from microslip.pressures.by_name import pressure_named

    return motion_named(sweep.motion).name, pressure_named(sweep.pressure).name


def refuse_unsolvable(sweep: Sweep) -> None:
    """Raise InputError or Refusal, with the key, for a sweep that the solver refuses."""
    from microslip.adaptive.choice import choose_model
    from microslip.adaptive.under_force import refuse_drive
    from microslip.motions.by_name import motion_named
    from microslip.pressures.by_name import pressure_named

    motion = motion_named(sweep.motion)
    pressure_named(sweep.pressure)
    if motion.periodic and sweep.amplitude is None:
        raise Refusal(f"missing; required for {motion.name}", "amplitude")
    if sweep.amplitude is not None and not motion.periodic:
        message = f"{list(sweep.amplitude)} is not allowed; {motion.name} has no amplitude"
        raise Refusal(message, "amplitude")
    if sweep.model != "auto":
        choose_model(_problem(sweep, 1.0, -1), sweep.model)
    if sweep.velocity[:1] == (0,):
        _problem(sweep, 0.0, 0)
    drives = {name: values for name, values, _ in sweep.drives}
    for end in (0, -1) if drives else ():
        drive = {name: drives[name][end] if name in drives else None for name in DRIVES}
        velocity = sweep.velocity[end] if sweep.velocity else None
        problem = _problem(sweep, velocity, -1, **drive)
        refuse_drive(problem, choose_model(problem, sweep.model))


def _problem(sweep: Sweep, velocity: float | None, end: int, **drive: float | None) -> Problem:
    """Return the problem of a sweep at a velocity, for the smallest or the largest amplitude.
    Raises InputError."""
    from microslip.adaptive.checks import checked_driven_problem

    return checked_driven_problem(
        sweep.motion,
        velocity,
        None if sweep.amplitude is None else sweep.amplitude[end],
        pressure=sweep.pressure,
        poisson=sweep.poisson[-1],
        **drive,
    )
