"""Tractions on the whole disc, either during a period of the periodic state or in a steady
motion."""

from __future__ import annotations

import numpy as np

from microslip.answer import limits
from microslip.answer.along import ANGLES, CELLS, ON_BOUND, STEP_TOLERANCE, named_forces
from microslip.answer.answer import Answer
from microslip.contact.contact import StepFailure, rigid_displacement
from microslip.contact.modes import PolarContact
from microslip.foundation.errors import InputError, SolverError
from microslip.periodic.discretise import Resolution, contact_of, path_of, tractions_at_phases
from microslip.periodic.run import unsolved
from microslip.periodic.simulate import simulate, steady_state
from microslip.scene.hertz import HERTZ
from microslip.scene.motion import Motion
from microslip.scene.pressure import Pressure
from microslip.scene.problem import Problem

PERIOD_CELLS, PERIOD_STEPS = 16, 64
"""Default resolution.  The mean force agrees with `solve` within 2e-3, see test_period.py."""
PERIOD_TOLERANCE = 3e-5
"""Largest distance from the periodic state, as a force divided by mu F_z.  This tolerance is far
below the discretisation error of 2e-3."""
STEADY_TOLERANCE = 1e-6
"""Tolerance of the steady state in a traction field, as a force divided by mu F_z."""
MOST_VALUES = 1e8
"""Largest number of values (points times steps) in a field."""
MIRRORED_FORCES = np.array([1.0, -1.0, -1.0])
"""Factors by which forward force, lateral force and torque are multiplied after half a period."""


class NoPeriodicState(SolverError, ValueError):
    """Raised if no tractions could be computed.  The message contains the reason."""


class Period(Answer):
    """One period of the periodic state on the whole disc, in dimensionless form.

    If the normal load oscillates, F_z and a are those of the reference state. The points then cover
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
        Area that each point represents, in units of a^2; the sum of the areas is pi.
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
        Reason why the period has not converged, otherwise empty.
    """

    axes = ("phase", "point")

    def __str__(self) -> str:
        """Return the mean friction, the dissipated energy and the resolution as text."""
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
        See `microslip.solve`.  The motion must oscillate, the velocity and the amplitude must be
        above 0, and the pressure must depend on the radius only.
    cells : int
        Even number of rings.
    angles : int
        Even number of points on half a ring.
    steps : int
        Even number of steps in a period.

    Returns
    -------
    Period
        The forces, and the fields on the whole disc.

    Raises
    ------
    InputError
        If an argument is invalid.  The message names the argument.
    microslip.answer.period.NoPeriodicState
        If the time integration failed.
    """
    problem = limits.problem_of(motion, velocity, amplitude, pressure=pressure, poisson=poisson)
    if not problem.motion.periodic:
        raise InputError("motion", problem.motion.name, "allowed is one that oscillates")
    for name, value in (("velocity", problem.velocity), ("amplitude", problem.size)):
        if value <= 0.0:
            raise InputError(name, value, f"a period needs {name} > 0")
    cells, angles = limits.within("cells", cells, low=2), limits.within("angles", angles)
    steps = limits.within("steps", steps, low=4)
    if cells * angles * steps > MOST_VALUES:
        allowed = f"allowed is at most {MOST_VALUES:g} for cells x angles x steps"
        raise InputError("steps", steps, allowed)
    model, resolution = limits.choose_model(problem, "polar"), Resolution(cells, angles, steps // 2)
    run = simulate(problem, model, resolution, PERIOD_TOLERANCE)
    if run.state is None:
        raise NoPeriodicState(f"velocity = {problem.velocity!r}: {run.reason}")
    contact = contact_of(problem, model, resolution)
    assert isinstance(contact, PolarContact)
    path = path_of(problem, contact, steps // 2)
    march = contact.march(path, run.state, STEP_TOLERANCE)
    tractions, bounds = tractions_at_phases(contact, path, march)
    failure = unsolved(march, STEP_TOLERANCE)
    phase, forces = path.phase, march.forces
    # slip in every step: rigid minus elastic displacement
    elastic = np.array([contact.displacement(change) for change in np.diff(tractions, axis=0)])
    moves = np.diff(path.positions, axis=0).T[..., None, None]
    slip = np.moveaxis(rigid_displacement(contact, moves), 0, 1) - elastic
    if problem.half_period_mirror:  # the second half is the mirror image of the first
        tractions = np.concatenate([tractions, [contact.mirrored(q) for q in tractions[1:]]])
        slip = np.concatenate([slip, [contact.mirrored(part) for part in slip]])
        forces = np.concatenate([forces, forces[1:] * MIRRORED_FORCES])
        phase = np.concatenate([phase, phase[1:] + np.pi])
        bounds = np.concatenate([bounds, bounds[1:]])
    slip_forward, slip_lateral = _whole_disc(contact, np.concatenate([slip[-1:], slip]))
    forward, lateral = _whole_disc(contact, tractions)
    place = _points(contact)
    bound = bounds.reshape(len(bounds), -1)
    if not contact.whole:
        bound = np.tile(bound, 2)  # the other half of the disc has the same bounds
    along_slip = forward * slip_forward + lateral * slip_lateral > 0.0
    density = _work(forward, slip_forward) + _work(lateral, slip_lateral)
    values = {
        "phase": phase,
        **dict(zip(("forward", "lateral", "angle"), problem.displacement(phase), strict=True)),
        **named_forces(problem, forces),
        **place,
        "bound": bound if problem.motion.loads else bound[0],
        "traction_forward": forward,
        "traction_lateral": lateral,
        "slip_forward": slip_forward,
        "slip_lateral": slip_lateral,
        "slips": along_slip & (np.hypot(forward, lateral) >= ON_BOUND * bound),
        "dissipated_energy_density": density,
        "dissipated_energy": float(place["area"] @ density),
        "mu_macro": run.mu,
    }
    return Period(problem, values, reason=run.reason or failure)


def patches(motion: str, velocity: float, amplitude: float, **settings: object) -> dict:
    """Compute stick areas and tractions over one period of the periodic state.

    The result is used by figures and checks.

    Parameters
    ----------
    motion, velocity, amplitude, **settings
        See `period`.  The second half of the period must mirror the first.

    Returns
    -------
    dict
        - mu_macro, converged, reason: see `microslip.solve`.
        - phase, shape (steps + 1,): phase in radians.
        - stick_right, stick_left, shape (steps + 1,): stick area at positive and at negative
          lateral positions, as fractions of the contact area.
        - least_stick: smallest sum of `stick_right` and `stick_left` over the period.
        - forward_position, lateral_position, area: positions of the points in units of a and their
          areas in units of a^2; the sum of the areas is pi.
        - moment_phase: phases of four moments: the moment of the smallest stick area in a stroke,
          the middle of this stroke, and both moments half a period later.
        - moment_share, shape (moments, points): traction divided by the friction bound at these
          moments; 1 at points that slip.

    Raises
    ------
    InputError
        See `period`.
    """
    cycle = period(motion, velocity, amplitude, **settings)  # type: ignore[arg-type]
    sticking = np.where(cycle.slips, 0.0, cycle.area / np.pi)
    right, half = cycle.lateral_position > 0.0, len(cycle.phase) // 2
    # the first row repeats the last one, so a stroke consists of rows 1 to half
    least = 1 + int(np.argmin(sticking[1 : half + 1].sum(axis=1)))
    moments = np.array([least, half // 2, least + half, half // 2 + half])
    share = np.hypot(cycle.traction_forward, cycle.traction_lateral)[moments] / cycle.bound
    same = ("mu_macro", "converged", "reason", "phase")
    place = ("forward_position", "lateral_position", "area")
    return {
        **{name: getattr(cycle, name) for name in same},
        "stick_right": sticking[:, right].sum(axis=1),
        "stick_left": sticking[:, ~right].sum(axis=1),
        "least_stick": sticking[1:].sum(axis=1).min(),
        **{name: getattr(cycle, name) for name in place},
        "moment_phase": cycle.phase[moments],
        "moment_share": np.where(cycle.slips[moments], 1.0, np.minimum(share, 1.0)),
    }


def traction_field(
    motion: str | Motion | Problem,
    velocity: float | None = None,
    amplitude: float | None = None,
    *,
    poisson: float = 0.0,
    cells: int | None = None,
) -> dict:
    """Compute the steady tractions of the continuous bore on the whole disc with the polar model.

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
    problem = limits.problem_of(motion, velocity, amplitude, poisson=poisson)
    velocity = problem.velocity
    if problem.motion.periodic:
        raise InputError("motion", problem.motion.name, "allowed is continuous-bore")
    if velocity <= 0.0:
        raise InputError("velocity", velocity, "a traction field needs velocity > 0")
    cells = CELLS if cells is None else limits.within("cells", cells, low=2, kind="whole")
    model = limits.choose_model(problem, "polar")
    contact = contact_of(problem, model, Resolution(cells, ANGLES, steps=0))
    assert isinstance(contact, PolarContact)
    run = steady_state(contact, problem, STEADY_TOLERANCE)
    if run.state is None or not run.converged:
        failure = f"{run.reason}, residual {run.residual:.1e}"
        raise StepFailure(f"velocity = {velocity!r}: {failure}")
    (forward,), (lateral,) = _whole_disc(contact, -run.state[None])
    bound = np.broadcast_to(contact.bound, contact.forward_position.shape).ravel()
    place = _points(contact)
    return {
        "lateral_position": place["lateral_position"],
        "forward_position": place["forward_position"],
        "traction_lateral": lateral,
        "traction_forward": forward,
        "bound": bound if contact.whole else np.tile(bound, 2),
        "centre_lateral": -velocity,
    }


def _work(traction: np.ndarray, slip: np.ndarray) -> np.ndarray:
    """Compute the work of the traction on the slip during the period, per area, at every point."""
    return 0.5 * np.sum((traction[1:] + traction[:-1]) * slip[1:], axis=0)


def _points(contact: PolarContact) -> dict[str, np.ndarray]:
    """Return a dictionary with the positions of the points on the whole disc and the areas that
    they represent."""
    forward, lateral = contact.forward_position.ravel(), contact.lateral_position.ravel()
    area = np.broadcast_to(contact.weight, contact.forward_position.shape).ravel()
    if not contact.whole:  # the weight of a point on the half disc includes its mirror image
        forward = np.concatenate([forward, -forward])
        lateral = np.concatenate([lateral, lateral if contact.rotates else -lateral])
        area = np.tile(0.5 * area, 2)
    return {"forward_position": forward, "lateral_position": lateral, "area": area}


def _whole_disc(contact: PolarContact, field: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Extend a field of shape (n, 2, M, N) to the whole disc.

    Returns the forward and the lateral component as arrays of shape (n, points).  For a rotation,
    the other half of the disc is the mirror image across the lateral axis.  For a translation, the
    other half is the first half rotated by 180 degrees.
    """
    flat = field.reshape(len(field), 2, -1)
    if not contact.whole:
        other = flat * [[1.0], [-1.0]] if contact.rotates else flat
        flat = np.concatenate([flat, other], axis=2)
    return flat[:, 0], flat[:, 1]
