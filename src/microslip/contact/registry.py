"""Registry of models, with the motions that each model resolves and the cases in which it is exact.

| model     | transverse, nu = 0 | transverse, nu > 0 | bore (oscillating, continuous)     |
|-----------|--------------------|--------------------|------------------------------------|
| rigid     | approximate, Eq 6  | approximate, Eq 6  | approximate, Eq 29 (steady: exact) |
| slider    | approximate, Eq 7  | approximate        | not applicable: it cannot rotate   |
| dahl      | approximate        | approximate        | not applicable: it cannot rotate   |
| mdr       | approximate        | approximate        | not applicable: it cannot rotate   |
| radial    | exact (rings)      | not applicable     | not applicable                     |
| polar     | exact              | exact              | exact (rings x angular modes)      |
| cartesian | exact              | exact              | exact (squares, any outline)       |

The models mdr, radial and polar support a changing normal load.  For motion along one line at nu =
0, mdr is exact.

An exact model converges to the solution of the contact problem as cells and steps are refined.  An
approximate model neglects elasticity, partial slip or the interaction of points.  Refinement does
not remove the resulting error.

Every model has the interface `contact.Contact`.  To add a model, add a file to this folder
and an entry to `MODELS`.  A model is imported when its first contact is built. Compiled code takes
a while to load, and closed forms do not need any model.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from microslip.contact.contact import Contact
    from microslip.contact.rings import Focus
    from microslip.scene.problem import Problem


@dataclass(frozen=True)
class Model:
    """Functions that build the contact of a model and state where the model applies.

    Attributes
    ----------
    build : callable
        build(problem, cells, angles, focus) returns a Contact.
    refuses : callable
        refuses(problem) returns the reason why the model does not apply, or "" if it applies.
    exact : callable
        exact(problem) returns whether the model converges to the solution of the contact problem.
    axes : callable
        axes(problem) returns the names of the mesh axes that can be refined: "cells", "angles".
    drivable : bool
        Whether the contact can be driven by a force or a spring, and whether a body can rest on
        several such contacts.
    """

    build: Callable
    refuses: Callable
    exact: Callable = lambda problem: True
    axes: Callable = lambda problem: ("cells",)
    drivable: bool = False


def _refusal(model: str, problem: Problem) -> str:
    """Return the reason why a model of the package does not apply to a problem, or "" if it
    applies."""
    motion, pressure = problem.motion, problem.pressure
    rigid_turn = "it has no extension that could rotate" if motion.rotates else ""
    if rigid_turn and model in ("slider", "dahl"):
        return rigid_turn
    if motion.loads and model in ("rigid", "slider", "dahl", "cartesian"):
        return "it allows a constant normal load only"
    if motion.loads and not pressure.is_indenter:
        return f"the load can change for axisymmetric indenters only, not for {pressure.name}"
    if model == "mdr" and not pressure.is_indenter:
        return f"it exists for axisymmetric indenters only, not for {pressure.name}"
    if model == "mdr":
        return rigid_turn
    if model == "rigid" and motion.rotates and not motion.half_disc:
        return "it needs a symmetry between the two halves of the contact"
    on_rings = model in ("radial", "polar") or (model == "rigid" and motion.rotates)
    if on_rings and not pressure.is_round:
        return f"rings cannot resolve the pressure {pressure.name}"
    if model == "radial" and motion.rotates:
        return "rings alone cannot resolve a rotation"
    return (
        "rings alone cannot resolve nu > 0" if model == "radial" and problem.poisson > 0.0 else ""
    )


def _build(
    model: str, problem: Problem, cells: int, angles: int, focus: Focus | float | None
) -> Contact:
    """Build the contact of a model of the package."""
    motion, pressure, whole = problem.motion, problem.pressure, not problem.motion.half_disc
    if model == "radial":
        from microslip.contact.ring_contact import RadialContact

        return RadialContact.resolved(cells, focus, pressure)
    if model == "polar":
        from microslip.contact.modes import polar_contact

        place = (problem.poisson, focus, pressure)
        return polar_contact(cells, angles, motion.rotates, *place, whole=whole)
    if model == "cartesian":
        from microslip.contact.convolution import MIRROR, TURN
        from microslip.contact.squares import CartesianContact

        # symmetry of the tractions if the pressure has the same symmetry
        symmetry = "" if whole else MIRROR if motion.rotates else TURN
        return CartesianContact(cells, problem.poisson, pressure, symmetry)
    from microslip.contact import reduced

    if model == "rigid":
        return reduced.RigidContact(cells, angles, motion.rotates, pressure)
    if model == "slider":
        return reduced.slider_contact()
    if model == "dahl":
        return reduced.DahlContact(pressure.stiffness)
    return reduced.mdr_contact(cells, focus, pressure)


_APPROXIMATE: dict[str, Any] = {"exact": lambda problem: False}
_PROPERTIES: dict[str, dict[str, Any]] = {
    "rigid": {
        "exact": lambda problem: not problem.motion.periodic,
        "axes": lambda problem: ("cells", "angles") if problem.motion.rotates else (),
    },
    "slider": {**_APPROXIMATE, "axes": lambda problem: (), "drivable": True},
    "dahl": {**_APPROXIMATE, "axes": lambda problem: ()},
    "mdr": {**_APPROXIMATE, "drivable": True},
    "radial": {"drivable": True},
    "polar": {"axes": lambda problem: ("cells", "angles"), "drivable": True},
    "cartesian": {"drivable": True},
}
MODELS = {
    name: Model(partial(_build, name), partial(_refusal, name), **own)
    for name, own in _PROPERTIES.items()
}
"""Models by name."""
