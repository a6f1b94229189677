"""One period of the periodic state: forces, tractions and slip at all points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from microslip.adaptive.checks import checked_problem
from microslip.adaptive.choice import choose_model
from microslip.adaptive.history import ANGLES, STEP_TOLERANCE
from microslip.adaptive.whole_disc import points_of, whole_disc
from microslip.contact.contact import FORWARD, LATERAL, TORQUE, rigid_displacement
from microslip.contact.modes import PolarContact
from microslip.contact.path import Path
from microslip.foundation.arguments import LARGEST, count
from microslip.foundation.errors import InputError, SolverError
from microslip.motions.motion import Motion
from microslip.motions.problem import Problem
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Pressure
from microslip.solver.discretise import Resolution, contact_of, path_of
from microslip.solver.run import unsolved
from microslip.solver.simulate import simulate
from microslip.solver.snapshots import bounds_at_phases, frames

PERIOD_CELLS, PERIOD_STEPS = 16, 64
"""Default resolution.  The mean force agrees with `solve` within 2e-3, see test_period.py."""
PERIOD_TOLERANCE = 3e-5
"""Largest distance from the periodic state, as a force divided by mu F_z.  It is far below the
discretisation error, 2e-3."""
ON_BOUND = 1.0 - 1e-4
"""Smallest traction of a slipping point, divided by the friction bound."""
MOST_ANGLES = 1000
MOST_VALUES = 1e8
"""Largest number of values (points times steps) in a field."""
MIRRORED_FORCES = np.array([1.0, -1.0, -1.0])
"""Factors by which forward force, lateral force and torque are multiplied after half a period."""


class NoPeriodicState(SolverError, ValueError):
    """Raised if the march failed and there are no tractions.  The message contains the reason."""


@dataclass(frozen=True, eq=False)
class Period:
    """One period of the periodic state on the whole disc, in dimensionless form.

    If the normal load oscillates, F_z and a are those of the reference state, and the points cover
    the largest contact area.

    Attributes
    ----------
    phase : np.ndarray, shape (steps + 1,)
        Phase omega t over one period, starting at a turning point.
    forward, lateral, angle : np.ndarray, shape (steps + 1,)
        Rigid displacements in u_lim, and rotation in u_lim / a.
    force_forward, force_lateral, torque : np.ndarray, shape (steps + 1,)
        Forces divided by mu F_z, and torque divided by its full-slip value.
    forward_position, lateral_position : np.ndarray, shape (points,)
        Positions of the points, in units of a.
    bound : np.ndarray, shape (points,)
        Friction bound, in units of mu F_z / a^2.  If the normal load oscillates, its shape is
        (steps + 1, points), and it is 0 at points out of contact.
    area : np.ndarray, shape (points,)
        Areas of the points, in units of a^2; their sum is pi.
    traction_forward, traction_lateral : np.ndarray, shape (steps + 1, points)
        Tractions on the flat in units of mu F_z / a^2, positive in the sphere's direction of
        motion.
    slip_forward, slip_lateral : np.ndarray, shape (steps + 1, points)
        Slip in the step that ends at each phase, in u_lim.  The first row repeats the last step.
    slips : np.ndarray of bool, shape (steps + 1, points)
        Whether a point slips at the end of the step.
    dissipated_energy_density : np.ndarray, shape (points,)
        Energy that friction dissipates in the period at each point, in mu F_z u_lim / a^2.
    dissipated_energy : float
        Energy that friction dissipates in the period, in mu F_z u_lim.
    mu_macro : float
        Mean of `force_forward` divided by the mean normal load.
    converged : bool
        Whether the state is periodic and every step is solved, at this resolution.
    reason : str
        Reason why the period is not converged, otherwise empty.
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
    dissipated_energy_density: np.ndarray
    dissipated_energy: float
    mu_macro: float
    converged: bool
    reason: str

    def __str__(self) -> str:
        """Mean friction, dissipated energy and resolution."""
        lines = [
            f"mu_macro = {self.mu_macro:.6g}",
            f"dissipated_energy = {self.dissipated_energy:.6g} mu F_z u_lim",
            f"{len(self.area)} points, {len(self.phase) - 1} steps a period",
        ]
        return "\n".join(lines + [f"NOT CONVERGED: {self.reason}"] * (not self.converged))


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
    """Compute forces, tractions and slip over one period of the periodic state, at one resolution.

    Parameters
    ----------
    motion, velocity, amplitude, pressure, poisson
        See `microslip.solve`.  The motion oscillates, velocity and amplitude are above 0, and the
        pressure depends on the radius only.
    cells : int
        Number of rings, an even number.
    angles : int
        Number of points on half a ring, an even number.
    steps : int
        Number of steps in a period, an even number.

    Returns
    -------
    Period
        The forces, and the fields on the whole disc.

    Raises
    ------
    InputError
        If an argument is invalid.  The message names the argument.
    microslip.adaptive.period.NoPeriodicState
        If the march failed.
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
    contact = contact_of(problem, "polar", resolution)
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
        bound = np.tile(bound, 2)  # the other half of the disc has the same bounds
    along = forward * slip_forward + lateral * slip_lateral > 0.0
    density = _work_per_area(forward, slip_forward) + _work_per_area(lateral, slip_lateral)
    displacement = [np.array(part) for part in problem.displacement(phase)]
    return Period(
        phase,
        displacement[0],
        displacement[1],
        displacement[2],
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
        dissipated_energy_density=density,
        dissipated_energy=float(area @ density),
        mu_macro=run.mu,
        converged=run.converged and not reason,
        reason=reason,
    )


def _work_per_area(traction: np.ndarray, slip: np.ndarray) -> np.ndarray:
    """Work done by a traction on a slip over the period, shape (points,).  For the arguments, see
    Period."""
    return 0.5 * np.sum((traction[1:] + traction[:-1]) * slip[1:], axis=0)


def _slip(contact: PolarContact, path: Path, tractions: np.ndarray) -> np.ndarray:
    """Slip in every step, shape (steps, 2, M, N), as rigid minus elastic displacement."""
    elastic = np.array([contact.displacement(change) for change in np.diff(tractions, axis=0)])
    moves = np.diff(path.positions, axis=0).T[..., None, None]
    return np.moveaxis(rigid_displacement(contact, moves), 0, 1) - elastic
