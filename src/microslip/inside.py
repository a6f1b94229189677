"""What happens inside a period: force histories from a given start, and traction fields."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from microslip import hertz
from microslip.choice import choose_model
from microslip.models.contact import forward_slip, full_slip
from microslip.motion import Motion, Resolution, build_contact
from microslip.path import make_path
from microslip.point import checked_point
from microslip.steady import steady_state

STARTS = ("stress-free", "full-slip", "full-rotation")
CELLS = 32
ANGLES = 16
STEPS = 256
STEP_TOLERANCE = 1e-7


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
    poisson=0.0,
    model="auto",
    cells=None,
    steps=None,
    start="stress-free",
    periods=3,
    travel=5.0,
):
    """Forces from an initial state on: ``periods`` periods, or ``travel`` u_lim of a steady motion.

    scene, velocity, amplitude, poisson, model: as for ``microslip.solve``; cells: rings or squares;
    steps: per period (steady scenes: over the whole travel); start: "stress-free" (full stick),
    "full-slip" (forward slip everywhere) or "full-rotation" (rotational slip everywhere).
    Returns a History.  Raises ValueError naming the argument for bad input.
    """
    kind, velocity, amplitude, poisson = checked_point(scene, velocity, amplitude, poisson)
    if velocity <= 0.0:
        raise ValueError(f"velocity = {velocity!r}: a history needs velocity > 0")
    if start not in STARTS:
        raise ValueError(f"start = {start!r}: allowed is one of {', '.join(STARTS)}")
    if start == "full-rotation" and not kind.rotates:
        raise ValueError(f"start = {start!r}: the {kind.name} scene does not rotate")
    for name, count in (("cells", cells), ("steps", steps), ("periods", periods)):
        whole = isinstance(count, int | np.integer) and not isinstance(count, bool)
        if count is not None and not (whole and count >= 1):
            raise ValueError(f"{name} = {count!r}: allowed is a whole number of at least 1")
    if not 0.0 < travel < np.inf:
        raise ValueError(f"travel = {travel!r}: allowed is a finite number above 0")
    motion = Motion(kind, velocity, amplitude, poisson)
    contact = _contact(motion, model, cells)
    end = 2 * np.pi * periods if kind.periodic else travel / velocity
    count = (steps or STEPS) * (periods if kind.periodic else 1)
    path = make_path(motion.displacement, np.linspace(0.0, end, count + 1))
    march = contact.march(path, _start(contact, start), STEP_TOLERANCE)
    return History(
        phase=path.phase,
        displacement_forward=path.positions[:, 0],
        force_forward=march.forces[:, 0],
        force_lateral=march.forces[:, 1],
        torque=march.forces[:, 2] / hertz.TORQUE_FULL_SLIP,
    )


def traction_field(scene, velocity, amplitude=None, *, poisson=0.0, cells=None):
    """Steady tractions of the continuous bore on the whole disc, computed by the polar model.

    Returns a dict of 1-D arrays over points (lateral_position, forward_position over a;
    traction_lateral, traction_forward, bound over mu F_z / a^2; the tractions are those on the
    indenter, which oppose its motion, as in Eq 15) and centre_lateral, where the instantaneous
    centre of rotation lies (Eq 14).  Raises ValueError for bad input or another scene.
    """
    kind, velocity, _, poisson = checked_point(scene, velocity, amplitude, poisson)
    if kind.periodic or velocity <= 0.0:
        raise ValueError(f"scene = {scene!r}: allowed is continuous-bore at velocity > 0")
    motion = Motion(kind, velocity, None, poisson)
    contact = _contact(motion, "polar", cells)
    found = steady_state(contact, motion.displacement, velocity, 1e-6, STEP_TOLERANCE)
    forward, lateral = -found.state
    half = {
        "lateral_position": contact.lateral_position,
        "forward_position": contact.forward_position,
        "traction_lateral": lateral,
        "traction_forward": forward,
        "bound": np.broadcast_to(contact.bound, forward.shape),
    }
    # the other half of the disc is the mirror image across the lateral axis
    odd = {"forward_position", "traction_lateral"}
    field = {
        name: np.concatenate([values.ravel(), (-values if name in odd else values).ravel()])
        for name, values in half.items()
    }
    return field | {"centre_lateral": -velocity}


def _contact(motion, model, cells):
    name = choose_model(motion.scene, motion.poisson, model)
    return build_contact(motion, name, Resolution(cells or CELLS, ANGLES, steps=0))


def _start(contact, start):
    if start == "stress-free":
        return 0.0 * forward_slip(contact)
    if start == "full-slip":
        return forward_slip(contact)
    return full_slip(contact, contact.lateral_position, -contact.forward_position)
