"""Force histories from an initial state, and traction fields of steady motions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from microslip.adaptive.checks import checked_problem
from microslip.adaptive.choice import choose_model
from microslip.adaptive.whole_disc import points_of, whole_disc
from microslip.contact.contact import Contact, StepFailure, forward_slip, full_slip
from microslip.contact.modes import PolarContact
from microslip.contact.path import make_path
from microslip.foundation.arguments import LARGEST, count, real
from microslip.foundation.errors import InputError
from microslip.motions.motion import Motion
from microslip.motions.problem import Problem
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Pressure
from microslip.solver.discretise import Resolution, contact_of
from microslip.solver.run import unsolved
from microslip.solver.steady import steady_state

STARTS = ("stress-free", "full-slip", "full-rotation")
CELLS = 32
ANGLES = 16
STEPS = 256
STEP_TOLERANCE = 1e-7
LONGEST_TRAVEL = 1e6
"""Largest travel of a steady motion, in u_lim.  The motion becomes steady within about 10 u_lim."""
LONGEST_PHASE = 1e12
"""Largest rotation of a steady motion, in u_lim / a.  At larger rotations, successive phases could
be equal because of rounding."""
MOST_STEPS = 10 * LARGEST["steps"]
"""Largest number of steps in a history, over all periods."""


@dataclass(frozen=True, eq=False)
class History:
    """Forces along a path, as dimensionless arrays of shape (steps + 1,).

    Attributes
    ----------
    phase : np.ndarray
        Phase omega t; for steady motions, the angle of rotation in u_lim / a.
    displacement_forward : np.ndarray
        Forward displacement in u_lim.
    force_forward, force_lateral : np.ndarray
        Forces on the flat divided by mu F_z, positive in the sphere's direction of motion.
    torque : np.ndarray
        Torque divided by its full-slip value.
    """

    phase: np.ndarray
    displacement_forward: np.ndarray
    force_forward: np.ndarray
    force_lateral: np.ndarray
    torque: np.ndarray

    def __str__(self) -> str:
        """Number of steps, range of the phase, and forces at the end."""
        first, last = self.phase[0], self.phase[-1]
        names = ("force_forward", "force_lateral", "torque")
        ends = (f"{name} = {getattr(self, name)[-1]:.6g}" for name in names)
        steps = f"{len(self.phase) - 1} steps from phase {first:.6g} to {last:.6g}; at the end:"
        return "\n".join([steps, *ends])


def history(
    motion: str | Motion | Problem,
    velocity: float | None = None,
    amplitude: float | None = None,
    *,
    pressure: str | Pressure = HERTZ,
    poisson: float = 0.0,
    model: str = "auto",
    cells: int | None = None,
    steps: int | None = None,
    start: str = "stress-free",
    periods: int = 3,
    travel: float = 5.0,
) -> History:
    """Compute the force history of an oscillation or a steady motion from an initial state.

    Parameters
    ----------
    motion, velocity, amplitude, pressure, poisson, model
        See `microslip.solve`; the velocity is above 0.
    cells : int or None
        Number of rings, or of squares along a side, at least 2.  Defaults to 32.
    steps : int or None
        Number of steps in a period; for steady motions, number of steps over the whole travel.
        Defaults to 256.
    start : str
        "stress-free" (full stick), "full-slip" (forward slip everywhere) or "full-rotation"
        (rotational slip everywhere).
    periods : int
        Number of periods of an oscillation.
    travel : float
        Travel of a steady motion, in u_lim.

    Returns
    -------
    History
        The forces at every step, including the initial state.

    Raises
    ------
    InputError
        If an argument is invalid.  The message names the argument.
    microslip.contact.contact.StepFailure
        If a step is not solved.
    """
    problem = checked_problem(motion, velocity, amplitude, pressure=pressure, poisson=poisson)
    motion, velocity = problem.motion, problem.velocity
    if velocity <= 0.0:
        raise InputError("velocity", velocity, "a history needs velocity > 0")
    if not isinstance(start, str) or start not in STARTS:
        raise InputError("start", start, f"allowed is one of {', '.join(STARTS)}")
    if start == "full-rotation" and not motion.rotates:
        raise InputError("start", start, f"the {motion.name} motion does not rotate")
    if cells is not None:
        count("cells", cells, 2, most=LARGEST["cells"])
    if steps is not None:
        count("steps", steps, 1, most=LARGEST["steps"])
    steps = int(steps or STEPS)
    periods = count("periods", periods, 1, most=MOST_STEPS // steps)
    if real("travel", travel, 0.0, LONGEST_TRAVEL) == 0.0:
        raise InputError("travel", travel, "allowed is a finite number above 0")
    if not motion.periodic and travel / velocity > LONGEST_PHASE:
        allowed = f"allowed is at least {LONGEST_PHASE:g} times less than the travel, {travel:g}"
        raise InputError("velocity", velocity, allowed)
    contact = _contact(problem, model, cells)
    end = 2 * np.pi * periods if motion.periodic else travel / velocity
    total = steps * (periods if motion.periodic else 1)
    path = make_path(problem.displacement, np.linspace(0.0, end, total + 1), depth=problem.depth)
    march = contact.march(path, tractions_at_start(contact, start), STEP_TOLERANCE)
    failure = unsolved(march.residual, march.solves, STEP_TOLERANCE)
    if failure:
        raise StepFailure(f"velocity = {velocity!r}: {failure}")
    return History(
        phase=path.phase,
        displacement_forward=path.positions[:, 0],
        force_forward=march.forces[:, 0],
        force_lateral=march.forces[:, 1],
        torque=march.forces[:, 2] / problem.pressure.torque,
    )


def traction_field(
    motion: str | Motion | Problem,
    velocity: float | None = None,
    amplitude: float | None = None,
    *,
    poisson: float = 0.0,
    cells: int | None = None,
) -> dict:
    """Compute the steady tractions of the continuous bore on the whole disc, by the polar model.

    Parameters
    ----------
    motion, velocity, amplitude, poisson
        See `microslip.solve`; the motion is "continuous-bore".
    cells : int or None
        Number of rings.  Defaults to 32.

    Returns
    -------
    dict
        - lateral_position, forward_position: positions of the points, in units of a.
        - traction_lateral, traction_forward, bound: tractions on the indenter and friction bound at
          these points, in units of mu F_z / a^2.  The tractions oppose the motion, as in Eq 15.
        - centre_lateral: lateral position of the instantaneous centre of rotation (Eq 14), in units
          of a.

    Raises
    ------
    InputError
        If an argument is invalid or the motion is not "continuous-bore".
    microslip.contact.contact.StepFailure
        If no steady state is reached, or a step is not solved.
    """
    problem = checked_problem(motion, velocity, amplitude, poisson=poisson)
    velocity = problem.velocity
    if problem.motion.periodic:
        raise InputError("motion", problem.motion.name, "allowed is continuous-bore")
    if velocity <= 0.0:
        raise InputError("velocity", velocity, "a traction field needs velocity > 0")
    if cells is not None:
        count("cells", cells, 2, most=LARGEST["cells"])
    contact = _contact(problem, "polar", cells)
    assert isinstance(contact, PolarContact)
    run = steady_state(contact, problem, 1e-6)
    if not run.converged:
        failure = f"{run.reason}, residual {run.residual:.1e}"
        raise StepFailure(f"velocity = {velocity!r}: {failure}")
    assert run.state is not None  # true for every steady state
    (forward,), (lateral,) = whole_disc(contact, -run.state[None])
    forward_position, lateral_position, bound, _ = points_of(contact)
    return {
        "lateral_position": lateral_position,
        "forward_position": forward_position,
        "traction_lateral": lateral,
        "traction_forward": forward,
        "bound": bound,
        "centre_lateral": -velocity,
    }


def _contact(problem: Problem, model: str, cells: int | None) -> Contact:
    name = choose_model(problem, model)
    return contact_of(problem, name, Resolution(cells or CELLS, ANGLES, steps=0))


def tractions_at_start(contact: Contact, start: str) -> np.ndarray:
    """Tractions of a contact in the initial state `start`, one of STARTS."""
    if start == "stress-free":
        return 0.0 * forward_slip(contact)
    if start == "full-slip":
        return forward_slip(contact)
    return full_slip(contact, contact.lateral_position, -contact.forward_position)
