"""Registry of models: which motions each model resolves, and whether it is exact.

| model     | transverse, nu = 0 | transverse, nu > 0 | bore (oscillating, continuous)     |
|-----------|--------------------|--------------------|------------------------------------|
| rigid     | approximate, Eq 6  | approximate, Eq 6  | approximate, Eq 29 (steady: exact) |
| slider    | approximate, Eq 7  | approximate        | not applicable: it cannot rotate   |
| dahl      | approximate        | approximate        | not applicable: it cannot rotate   |
| mdr       | approximate        | approximate        | not applicable: it cannot rotate   |
| radial    | exact (rings)      | not applicable     | not applicable                     |
| polar     | exact              | exact              | exact (rings x angular modes)      |
| cartesian | exact              | exact              | exact (squares, any outline)       |

The models mdr, radial and polar allow the normal load to change.  For motion along one line at nu =
0, mdr is exact.

An exact model converges to the solution of the contact problem as cells and steps are refined.  An
approximate model neglects elasticity, partial slip or the interaction of points, whatever its
resolution.

Every model has the interface `contact.Contact`.  To add a model, add a file to this folder
and an entry to `MODELS`.  A model is imported when its first contact is built, because compiled
code takes a while to load and closed forms do not need it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from microslip.contact.contact import Contact
    from microslip.contact.rings import Focus
    from microslip.scene.problem import Problem


@dataclass(frozen=True)
class Model:
    """How a model is built and where it applies.

    Attributes
    ----------
    build : callable
        build(problem, cells, angles, focus) -> Contact.
    refuses : callable
        refuses(problem) -> reason why the model does not apply, or "".
    exact : callable
        exact(problem) -> whether the model converges to the solution of the contact problem.
    axes : callable
        axes(problem) -> names of the mesh axes that can be refined: "cells", "angles".
    drivable : bool
        Whether the contact can be driven by a force or a spring, and whether a body can rest on
        several such contacts.
    """

    build: Callable
    refuses: Callable
    exact: Callable = lambda problem: True
    axes: Callable = lambda problem: ("cells",)
    drivable: bool = False


def _never(problem: Problem) -> bool:
    return False


LOAD_CHANGES = "it allows a constant normal load only"


def _refuse_pulsation(problem: Problem) -> str:
    return LOAD_CHANGES if problem.motion.loads else ""


def _refuse_other_loads(problem: Problem) -> str:
    if not problem.motion.loads or problem.pressure.is_indenter:
        return ""
    return f"the load can change for axisymmetric indenters only, not for {problem.pressure.name}"


def _any_of(*refusals: Callable[[Problem], str]) -> Callable[[Problem], str]:
    """Combine checks into one that returns the first non-empty reason, or ""."""
    return lambda problem: next(filter(None, (refuse(problem) for refuse in refusals)), "")


def _refuse_rings(problem: Problem) -> str:
    if not problem.pressure.is_round:
        return f"rings cannot resolve the pressure {problem.pressure.name}"
    if problem.motion.rotates:
        return "rings alone cannot resolve a rotation"
    return "rings alone cannot resolve nu > 0" if problem.poisson > 0.0 else ""


def _refuse_rotation(problem: Problem) -> str:
    return "it has no extension that could rotate" if problem.motion.rotates else ""


def _refuse_springs(problem: Problem) -> str:
    if not problem.pressure.is_indenter:
        return f"it exists for axisymmetric indenters only, not for {problem.pressure.name}"
    return _refuse_rotation(problem)


def _refuse_angles(problem: Problem) -> str:
    if problem.pressure.is_round:
        return ""
    return f"rings cannot resolve the pressure {problem.pressure.name}"


def _refuse_rigid(problem: Problem) -> str:
    if problem.motion.rotates and not problem.motion.half_disc:
        return "it needs a symmetry between the two halves of the contact"
    return _refuse_angles(problem) if problem.motion.rotates else ""


_NO_ROTATION = _any_of(_refuse_rotation, _refuse_pulsation)


def _rigid(problem: Problem, cells: int, angles: int, focus: Focus | float | None) -> Contact:
    from microslip.contact.reduced import RigidContact

    return RigidContact(cells, angles, problem.motion.rotates, problem.pressure)


def _slider(problem: Problem, cells: int, angles: int, focus: Focus | float | None) -> Contact:
    from microslip.contact.reduced import slider_contact

    return slider_contact()


def _dahl(problem: Problem, cells: int, angles: int, focus: Focus | float | None) -> Contact:
    from microslip.contact.reduced import DahlContact

    return DahlContact(problem.pressure.stiffness)


def _mdr(problem: Problem, cells: int, angles: int, focus: Focus | float | None) -> Contact:
    from microslip.contact.reduced import mdr_contact

    return mdr_contact(cells, focus, problem.pressure)


def _radial(problem: Problem, cells: int, angles: int, focus: Focus | float | None) -> Contact:
    from microslip.contact.ring_contact import RadialContact

    return RadialContact.resolved(cells, focus, problem.pressure)


def _polar(problem: Problem, cells: int, angles: int, focus: Focus | float | None) -> Contact:
    from microslip.contact.modes import PolarContact

    motion, whole = problem.motion, not problem.motion.half_disc
    place = (problem.poisson, focus, problem.pressure)
    return PolarContact.resolved(cells, angles, motion.rotates, *place, whole=whole)


def _cartesian(problem: Problem, cells: int, angles: int, focus: Focus | float | None) -> Contact:
    from microslip.contact.convolution import MIRROR, TURN
    from microslip.contact.squares import CartesianContact

    symmetry = ""  # symmetry of the tractions, if the pressure has the same one
    if problem.motion.half_disc:
        symmetry = MIRROR if problem.motion.rotates else TURN
    return CartesianContact(cells, problem.poisson, problem.pressure, symmetry)


MODELS = {
    "rigid": Model(
        _rigid,
        _any_of(_refuse_pulsation, _refuse_rigid),
        exact=lambda problem: not problem.motion.periodic,
        axes=lambda problem: ("cells", "angles") if problem.motion.rotates else (),
    ),
    "slider": Model(_slider, _NO_ROTATION, exact=_never, axes=lambda problem: (), drivable=True),
    "dahl": Model(_dahl, _NO_ROTATION, exact=_never, axes=lambda problem: ()),
    "mdr": Model(_mdr, _any_of(_refuse_other_loads, _refuse_springs), exact=_never, drivable=True),
    "radial": Model(_radial, _any_of(_refuse_other_loads, _refuse_rings), drivable=True),
    "polar": Model(
        _polar,
        _any_of(_refuse_other_loads, _refuse_angles),
        axes=lambda problem: ("cells", "angles"),
        drivable=True,
    ),
    "cartesian": Model(_cartesian, _refuse_pulsation, drivable=True),
}
"""Models by name."""
