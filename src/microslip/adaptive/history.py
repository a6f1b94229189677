"""What happens inside: force histories from a given start, traction fields, a whole period."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from microslip.adaptive.choice import choose_model
from microslip.adaptive.point import checked_point
from microslip.foundation.arguments import LARGEST, count, real
from microslip.foundation.errors import InputError
from microslip.models.contact import FORWARD, LATERAL, TORQUE, forward_slip, full_slip
from microslip.models.path import make_path
from microslip.solver.problem import Motion, Resolution, build_contact
from microslip.solver.simulate import simulate
from microslip.solver.snapshots import bounds_at_phases, frames
from microslip.solver.steady import steady_state

STARTS = ("stress-free", "full-slip", "full-rotation")
CELLS = 32
ANGLES = 16
STEPS = 256
STEP_TOLERANCE = 1e-7
PERIOD_CELLS, PERIOD_STEPS = 16, 64
PERIOD_TOLERANCE = 1e-4
ON_BOUND = 1.0 - 1e-4
"""Share of the friction bound from which on a traction along the slip counts as slipping."""
LONGEST_TRAVEL = 1e6
"""u_lim of a steady motion; ten are enough to see it settle."""
LONGEST_PHASE = 1e12
"""Angle that a steady motion turns by, u_lim / a; floats tell its steps apart."""
MOST_STEPS = 10 * LARGEST["steps"]
"""Of a history, over all of its periods."""
MOST_ANGLES = 1000
MOST_VALUES = 1e8
"""Of each field of a period: points times steps."""
MIRRORED_FORCES = np.array([1.0, -1.0, -1.0])
"""Signs of the forces half a period later."""


class NoPeriodicState(ValueError):
    """There are no tractions to show: the march broke off, as the message says."""


@dataclass(frozen=True, eq=False)
class History:
    """Forces along a path, arrays of shape (steps + 1,), dimensionless.

    phase: omega t (steady scenes: turned angle in u_lim / a); displacement_forward: travel in
    u_lim; force_forward, force_lateral: over mu F_z, in the direction of the motion they resist;
    torque: over its full-slip value.
    """

    phase: np.ndarray
    displacement_forward: np.ndarray
    force_forward: np.ndarray
    force_lateral: np.ndarray
    torque: np.ndarray


def history(
    scene,
    velocity,
    amplitude=None,
    *,
    pressure="hertz",
    poisson=0.0,
    model="auto",
    cells=None,
    steps=None,
    start="stress-free",
    periods=3,
    travel=5.0,
):
    """Forces from an initial state on: ``periods`` periods, or ``travel`` u_lim of a steady motion.

    scene, velocity, amplitude, pressure, poisson, model: as for ``microslip.solve``; cells: rings
    or squares; steps: per period (steady scenes: over the whole travel); start: "stress-free" (full
    stick), "full-slip" (forward slip everywhere) or "full-rotation" (rotational slip everywhere).
    Returns a History.  Raises InputError naming the argument for bad input.
    """
    kind, velocity, amplitude, poisson = checked_point(
        scene, velocity, amplitude, poisson, pressure
    )
    if velocity <= 0.0:
        raise InputError("velocity", velocity, "a history needs velocity > 0")
    if not isinstance(start, str) or start not in STARTS:
        raise InputError("start", start, f"allowed is one of {', '.join(STARTS)}")
    if start == "full-rotation" and not kind.rotates:
        raise InputError("start", start, f"the {kind.name} scene does not rotate")
    if cells is not None:
        count("cells", cells, 1, most=LARGEST["cells"])
    if steps is not None:
        count("steps", steps, 1, most=LARGEST["steps"])
    steps = int(steps or STEPS)
    periods = count("periods", periods, 1, most=MOST_STEPS // steps)
    if real("travel", travel, 0.0, LONGEST_TRAVEL) == 0.0:
        raise InputError("travel", travel, "allowed is a finite number above 0")
    if not kind.periodic and travel / velocity > LONGEST_PHASE:
        allowed = f"allowed is at least {LONGEST_PHASE:g} times less than the travel, {travel:g}"
        raise InputError("velocity", velocity, allowed)
    motion = Motion(kind, velocity, amplitude, poisson)
    contact = _contact(motion, model, cells)
    end = 2 * np.pi * periods if kind.periodic else travel / velocity
    total = steps * (periods if kind.periodic else 1)
    path = make_path(motion.displacement, np.linspace(0.0, end, total + 1), depth=motion.depth)
    march = contact.march(path, _start(contact, start), STEP_TOLERANCE)
    return History(
        phase=path.phase,
        displacement_forward=path.positions[:, 0],
        force_forward=march.forces[:, 0],
        force_lateral=march.forces[:, 1],
        torque=march.forces[:, 2] / kind.pressure.torque,
    )


def traction_field(scene, velocity, amplitude=None, *, poisson=0.0, cells=None):
    """Steady tractions of the continuous bore on the whole disc, computed by the polar model.

    Returns a dict of 1-D arrays over points (lateral_position, forward_position over a;
    traction_lateral, traction_forward, bound over mu F_z / a^2; the tractions are those on the
    indenter, which oppose its motion, as in Eq 15) and centre_lateral, where the instantaneous
    centre of rotation lies (Eq 14).  Raises InputError for bad input or another scene.
    """
    kind, velocity, _, poisson = checked_point(scene, velocity, amplitude, poisson)
    if kind.periodic:
        raise InputError("scene", scene, "allowed is continuous-bore")
    if velocity <= 0.0:
        raise InputError("velocity", velocity, "a traction field needs velocity > 0")
    if cells is not None:
        count("cells", cells, 2, most=LARGEST["cells"])
    motion = Motion(kind, velocity, None, poisson)
    contact = _contact(motion, "polar", cells)
    found = steady_state(contact, motion.displacement, velocity, 1e-6, STEP_TOLERANCE)
    (forward,), (lateral,) = _whole_disc(contact, -found.state[None])
    forward_position, lateral_position, bound, _ = _points(contact)
    return {
        "lateral_position": lateral_position,
        "forward_position": forward_position,
        "traction_lateral": lateral,
        "traction_forward": forward,
        "bound": bound,
        "centre_lateral": -velocity,
    }


@dataclass(frozen=True, eq=False)
class Period:
    """A period of the state that repeats itself, on the whole disc; dimensionless.

    phase: omega t, from turning point to turning point and back, shape (steps + 1,); forward,
    lateral: rigid displacement in u_lim, angle: in u_lim / a, same shape; force_forward,
    force_lateral: over mu F_z, torque: over its full-slip value, same shape.
    forward_position, lateral_position: points, over a, shape (points,); bound: over mu F_z / a^2,
    and area, over a^2 and pi in all, same shape.  traction_forward, traction_lateral: on the flat,
    in the direction of the motion that they resist, over mu F_z / a^2, shape (steps + 1, points);
    slip_forward, slip_lateral: in the step that ends at this phase (first row: in the last step),
    in u_lim, and slips: whether a point slips when the step ends, same shape.  mu_macro: mean of
    force_forward over that of the load; converged, reason: whether this is the periodic state of
    this resolution, else why not.
    Where the normal load changes, F_z and a are those of the reference state, points fill the
    contact at its largest, and bound is one at each phase, shape (steps + 1, points), 0 for a point
    out of contact.
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
    scene,
    velocity,
    amplitude,
    *,
    pressure="hertz",
    poisson=0.0,
    cells=PERIOD_CELLS,
    angles=ANGLES,
    steps=PERIOD_STEPS,
):
    """Forces, tractions and slip over one period of the periodic state, at one resolution.

    scene: one that oscillates; velocity > 0, amplitude > 0, pressure (one that depends on the
    radius alone), poisson: as for ``microslip.solve``; cells: rings; angles: points on half a ring;
    steps: in a period; both even numbers.  Returns a Period.  Raises InputError naming the argument
    for bad input.
    """
    kind, velocity, amplitude, poisson = checked_point(
        scene, velocity, amplitude, poisson, pressure
    )
    if not kind.periodic:
        raise InputError("scene", scene, "allowed is one that oscillates")
    for name, value in (("velocity", velocity), ("amplitude", amplitude)):
        if value <= 0.0:
            raise InputError(name, value, f"a period needs {name} > 0")
    cells = count("cells", cells, 2, most=LARGEST["cells"], even=True)
    angles = count("angles", angles, 2, most=MOST_ANGLES, even=True)
    steps = count("steps", steps, 4, most=LARGEST["steps"], even=True)
    if cells * angles * steps > MOST_VALUES:
        allowed = f"allowed is at most {MOST_VALUES:g} for cells x angles x steps"
        raise InputError("steps", steps, allowed)
    choose_model(kind, poisson, "polar")
    motion = Motion(kind, velocity, amplitude, poisson)
    resolution = Resolution(cells, angles, steps // 2)
    run = simulate(kind, velocity, amplitude, poisson, "polar", resolution, PERIOD_TOLERANCE)
    if run.state is None:
        raise NoPeriodicState(f"velocity = {velocity!r}: {run.reason}")
    contact = build_contact(motion, "polar", resolution)
    path = motion.path(contact, steps // 2)
    tractions, forces = frames(contact, path, run.state, STEP_TOLERANCE)
    slip = _slip(contact, path, tractions)
    bounds = np.broadcast_to(bounds_at_phases(contact, path), tractions[:, 0].shape)
    phase = path.phase
    if kind.half_period_mirror:  # the second half is the mirror image of the first
        tractions = np.concatenate([tractions, [contact.mirrored(q) for q in tractions[1:]]])
        slip = np.concatenate([slip, [contact.mirrored(part) for part in slip]])
        forces = np.concatenate([forces, forces[1:] * MIRRORED_FORCES])
        phase = np.concatenate([phase, phase[1:] + np.pi])
        bounds = np.concatenate([bounds, bounds[1:]])
    slip_forward, slip_lateral = _whole_disc(contact, np.concatenate([slip[-1:], slip]))
    forward, lateral = _whole_disc(contact, tractions)
    forward_position, lateral_position, _, area = _points(contact)
    bound = np.tile(bounds.reshape(len(bounds), -1), 2)  # the other half has the same
    along = forward * slip_forward + lateral * slip_lateral > 0.0
    return Period(
        phase,
        *(np.array(part) for part in motion.displacement(phase)),
        forces[:, FORWARD],
        forces[:, LATERAL],
        forces[:, TORQUE] / kind.pressure.torque,
        forward_position,
        lateral_position,
        bound if kind.depth is not None else bound[0],
        area,
        forward,
        lateral,
        slip_forward,
        slip_lateral,
        along & (np.hypot(forward, lateral) >= ON_BOUND * bound),
        mu_macro=run.mu,
        converged=run.converged,
        reason=run.reason,
    )


def _slip(contact, path, tractions):
    """Rigid motion in every step less what the material follows, (steps, 2, M, N)."""
    elastic = np.array([contact.displacement(change) for change in np.diff(tractions, axis=0)])
    forward, lateral, angle = np.diff(path.positions, axis=0).T[..., None, None]
    rigid = (
        forward + angle * contact.lateral_position,
        lateral - angle * contact.forward_position,
    )
    return np.stack(rigid, axis=1) - elastic


def _points(contact):
    """Forward and lateral positions, bounds and areas on the whole disc, (points,) each."""
    forward, lateral = contact.forward_position, contact.lateral_position
    other = lateral if contact.rotates else -lateral
    bound = np.broadcast_to(contact.bound, forward.shape)
    # a point of the half that is resolved stands for its image, too
    area = np.broadcast_to(0.5 * contact.weight, forward.shape)
    parts = (forward, -forward), (lateral, other), (bound, bound), (area, area)
    return [np.concatenate([half.ravel() for half in part]) for part in parts]


def _whole_disc(contact, field):
    """Forward and lateral parts of a field (n, 2, M, N) on the whole disc, (n, points) each: the
    other half is the mirror image across the lateral axis, of a translation the same turned round.
    """
    flat = field.reshape(len(field), 2, -1)
    other = flat * [[1.0], [-1.0]] if contact.rotates else flat
    both = np.concatenate([flat, other], axis=2)
    return both[:, 0], both[:, 1]


def _contact(motion, model, cells):
    name = choose_model(motion.scene, motion.poisson, model)
    return build_contact(motion, name, Resolution(cells or CELLS, ANGLES, steps=0))


def _start(contact, start):
    if start == "stress-free":
        return 0.0 * forward_slip(contact)
    if start == "full-slip":
        return forward_slip(contact)
    return full_slip(contact, contact.lateral_position, -contact.forward_position)
