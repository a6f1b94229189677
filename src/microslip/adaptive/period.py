"""A period of the state that repeats itself: forces, tractions and slip everywhere."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from microslip.adaptive.checks import checked_problem
from microslip.adaptive.choice import choose_model
from microslip.adaptive.history import ANGLES, STEP_TOLERANCE
from microslip.adaptive.whole_disc import points_of, whole_disc
from microslip.foundation.arguments import LARGEST, count
from microslip.foundation.errors import InputError, SolverError
from microslip.models.contact import FORWARD, LATERAL, TORQUE
from microslip.models.path import Path
from microslip.models.polar.contact import PolarContact
from microslip.motions.motion import Motion
from microslip.motions.problem import Problem
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Pressure
from microslip.solver.discretise import Resolution, build_contact, path_of
from microslip.solver.run import unsolved
from microslip.solver.simulate import simulate
from microslip.solver.snapshots import bounds_at_phases, frames

PERIOD_CELLS, PERIOD_STEPS = 16, 64
"""Default resolution: mean force within 2e-3 of `solve` (tests/adaptive/test_period.py)."""
PERIOD_TOLERANCE = 3e-5
"""Largest distance from the periodic state, a force over mu F_z: small beside those 2e-3."""
ON_BOUND = 1.0 - 1e-4
"""Share of the friction bound from which on a traction along the slip counts as slipping."""
MOST_ANGLES = 1000
MOST_VALUES = 1e8
"""Largest size of a field of a period: points times steps."""
MIRRORED_FORCES = np.array([1.0, -1.0, -1.0])
"""Signs of the forces half a period later."""


class NoPeriodicState(SolverError, ValueError):
    """There are no tractions to show: the march broke off, as the message says."""


@dataclass(frozen=True, eq=False)
class Period:
    """A period of the state that repeats itself, on the whole disc; dimensionless.

    Where the normal load changes, F_z and a are those of the reference state, and points fill the
    contact at its largest.

    Attributes
    ----------
    phase : np.ndarray, shape (steps + 1,)
        omega t, from turning point to turning point and back.
    forward, lateral, angle : np.ndarray, shape (steps + 1,)
        Rigid displacement in u_lim, and in u_lim / a.
    force_forward, force_lateral, torque : np.ndarray, shape (steps + 1,)
        Over mu F_z, and over the full-slip value of the torque.
    forward_position, lateral_position : np.ndarray, shape (points,)
        Over a.
    bound : np.ndarray, shape (points,)
        Over mu F_z / a^2; where the normal load changes one at each phase, shape (steps + 1,
        points), 0 for a point out of contact.
    area : np.ndarray, shape (points,)
        Over a^2, pi in all.
    traction_forward, traction_lateral : np.ndarray, shape (steps + 1, points)
        On the flat, in the direction of the motion that they resist, over mu F_z / a^2.
    slip_forward, slip_lateral : np.ndarray, shape (steps + 1, points)
        In the step that ends at this phase (first row: in the last step), in u_lim.
    slips : np.ndarray of bool, shape (steps + 1, points)
        Whether a point slips when the step ends.
    mu_macro : float
        Mean of force_forward over that of the load.
    converged : bool
        Whether this is the periodic state of this resolution.
    reason : str
        Why it is not, else empty.
    """

    phase: np.ndarray
    forward: np.ndarray
    lateral: np.ndarray
    angle: np.ndarray
    force_forward: np.ndarray
    force_lateral: np.ndarray
    torque: np.ndarray
    forward_position: np.ndarray
    lateral_position: np.ndarray
    bound: np.ndarray
    area: np.ndarray
    traction_forward: np.ndarray
    traction_lateral: np.ndarray
    slip_forward: np.ndarray
    slip_lateral: np.ndarray
    slips: np.ndarray
    mu_macro: float
    converged: bool
    reason: str


def period(
    motion: str | Motion | Problem,
    velocity: float | None = None,
    amplitude: float | None = None,
    *,
    pressure: str | Pressure = HERTZ,
    poisson: float = 0.0,
    cells: int = PERIOD_CELLS,
    angles: int = ANGLES,
    steps: int = PERIOD_STEPS,
) -> Period:
    """Forces, tractions and slip over one period of the periodic state, at one resolution.

    Parameters
    ----------
    motion, velocity, amplitude, pressure, poisson
        As for `microslip.solve`: a motion that oscillates, velocity and amplitude above 0, a
        pressure that depends on the radius alone.
    cells : int
        Rings, an even number.
    angles : int
        Points on half a ring, an even number.
    steps : int
        In a period, an even number.

    Returns
    -------
    Period
        On the whole disc.

    Raises
    ------
    InputError
        For bad input; it names the argument.
    microslip.adaptive.period.NoPeriodicState
        Where the march broke off.
    """
    problem = checked_problem(motion, velocity, amplitude, pressure=pressure, poisson=poisson)
    velocity, amplitude = problem.velocity, problem.size
    if not problem.motion.periodic:
        raise InputError("motion", problem.motion.name, "allowed is one that oscillates")
    for name, value in (("velocity", velocity), ("amplitude", amplitude)):
        if value <= 0.0:
            raise InputError(name, value, f"a period needs {name} > 0")
    cells = count("cells", cells, 2, most=LARGEST["cells"], even=True)
    angles = count("angles", angles, 2, most=MOST_ANGLES, even=True)
    steps = count("steps", steps, 4, most=LARGEST["steps"], even=True)
    if cells * angles * steps > MOST_VALUES:
        allowed = f"allowed is at most {MOST_VALUES:g} for cells x angles x steps"
        raise InputError("steps", steps, allowed)
    choose_model(problem, "polar")
    resolution = Resolution(cells, angles, steps // 2)
    run = simulate(problem, "polar", resolution, PERIOD_TOLERANCE)
    if run.state is None:
        raise NoPeriodicState(f"velocity = {velocity!r}: {run.reason}")
    contact = build_contact(problem, "polar", resolution)
    assert isinstance(contact, PolarContact)
    path = path_of(problem, contact, steps // 2)
    tractions, forces, residual, solves = frames(contact, path, run.state, STEP_TOLERANCE)
    reason = run.reason or unsolved(residual, solves, STEP_TOLERANCE)
    slip = _slip(contact, path, tractions)
    bounds = np.broadcast_to(bounds_at_phases(contact, path), tractions[:, 0].shape)
    phase = path.phase
    if problem.half_period_mirror:  # the second half is the mirror image of the first
        tractions = np.concatenate([tractions, [contact.mirrored(q) for q in tractions[1:]]])
        slip = np.concatenate([slip, [contact.mirrored(part) for part in slip]])
        forces = np.concatenate([forces, forces[1:] * MIRRORED_FORCES])
        phase = np.concatenate([phase, phase[1:] + np.pi])
        bounds = np.concatenate([bounds, bounds[1:]])
    slip_forward, slip_lateral = whole_disc(contact, np.concatenate([slip[-1:], slip]))
    forward, lateral = whole_disc(contact, tractions)
    forward_position, lateral_position, _, area = points_of(contact)
    bound = bounds.reshape(len(bounds), -1)
    if not contact.whole:
        bound = np.tile(bound, 2)  # the other half has the same
    along = forward * slip_forward + lateral * slip_lateral > 0.0
    moved = [np.array(part) for part in problem.displacement(phase)]
    return Period(
        phase,
        moved[0],
        moved[1],
        moved[2],
        forces[:, FORWARD],
        forces[:, LATERAL],
        forces[:, TORQUE] / problem.pressure.torque,
        forward_position,
        lateral_position,
        bound if problem.motion.loads else bound[0],
        area,
        forward,
        lateral,
        slip_forward,
        slip_lateral,
        along & (np.hypot(forward, lateral) >= ON_BOUND * bound),
        mu_macro=run.mu,
        converged=run.converged and not reason,
        reason=reason,
    )


def _slip(contact: PolarContact, path: Path, tractions: np.ndarray) -> np.ndarray:
    """Rigid motion in every step less what the material follows, (steps, 2, M, N)."""
    elastic = np.array([contact.displacement(change) for change in np.diff(tractions, axis=0)])
    forward, lateral, angle = np.diff(path.positions, axis=0).T[..., None, None]
    rigid = (
        forward + angle * contact.lateral_position,
        lateral - angle * contact.forward_position,
    )
    return np.stack(rigid, axis=1) - elastic
