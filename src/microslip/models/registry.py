"""The model hierarchy: which model resolves which motion, and how well.

| model     | transverse, nu = 0 | transverse, nu > 0 | bore (oscillating, continuous)     |
|-----------|--------------------|--------------------|------------------------------------|
| rigid     | approximate, Eq 6  | approximate, Eq 6  | approximate, Eq 29 (steady: exact) |
| slider    | approximate, Eq 7  | approximate        | not applicable: it cannot turn     |
| dahl      | approximate        | approximate        | not applicable: it cannot turn     |
| mdr       | approximate        | approximate        | not applicable: it cannot turn     |
| radial    | exact (rings)      | not applicable     | not applicable                     |
| polar     | exact              | exact              | exact (rings x angular modes)      |
| cartesian | exact              | exact              | exact (squares, any outline)       |

In mdr, radial and polar the normal load may change; for motion along one line at nu = 0 mdr is
exact then, too.

"Exact" means: converges to the solution of the contact problem as its cells and steps are refined;
"approximate": leaves out elasticity, partial slip or how points of the contact act on each other,
and no refinement brings it back.

Every model that marches keeps the contract of `models.contact.Contact`.  A new one is a file
beside these and a row in `MODELS`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from microslip.models.polar.contact import PolarContact
from microslip.models.polar.side_by_side import PolarSideBySide
from microslip.models.reduced.dahl import DahlContact
from microslip.models.reduced.mdr import mdr_contact
from microslip.models.reduced.rigid import RigidContact
from microslip.models.reduced.slider import slider_contact
from microslip.models.rings.contact import RadialContact
from microslip.models.rings.side_by_side import RingsSideBySide
from microslip.models.squares import half
from microslip.models.squares.contact import CartesianContact
from microslip.models.squares.side_by_side import SquaresSideBySide


@dataclass(frozen=True)
class Model:
    """How a model is built and where it applies.

    Attributes
    ----------
    build : callable
        build(motion, poisson, cells, angles, focus) -> Contact.
    refuses : callable
        refuses(motion, poisson) -> why it does not apply, or "".
    exact : callable
        exact(motion) -> whether refinement converges to the truth.
    axes : callable
        axes(motion) -> what of its space can be refined: "cells", "angles".
    side_by_side : callable or None
        side_by_side(contacts, shares, extents) -> Contact of a body on several of its contacts,
        each in its own units; None where its contact cannot be pulled, see pull.PullsContact.
    """

    build: Callable
    refuses: Callable
    exact: Callable = lambda motion: True
    axes: Callable = lambda motion: ("cells",)
    side_by_side: Callable | None = None

    @property
    def pulled(self) -> bool:
        """Whether its contact may be pulled."""
        return self.side_by_side is not None


def _never(motion):
    return False


LOAD_CHANGES = "it knows a constant normal load alone"


def _refuse_pulsation(motion, poisson):
    return LOAD_CHANGES if motion.depth is not None else ""


def _refuse_other_loads(motion, poisson):
    if motion.depth is None or motion.pressure.is_indenter:
        return ""
    return f"the load of axisymmetric indenters may change, not that of {motion.pressure.name}"


def _any_of(*refusals):
    """What the first refusal says that says something."""
    return lambda motion, poisson: next(filter(None, (r(motion, poisson) for r in refusals)), "")


def _refuse_rings(motion, poisson):
    if not motion.pressure.is_round:
        return f"rings cannot resolve the pressure {motion.pressure.name}"
    if motion.rotates:
        return "rings alone cannot resolve a rotation"
    return "rings alone cannot resolve nu > 0" if poisson > 0.0 else ""


def _refuse_rotation(motion, poisson):
    return "it has no extension that could turn" if motion.rotates else ""


def _refuse_springs(motion, poisson):
    if not motion.pressure.is_indenter:
        return f"it is known for axisymmetric indenters only, not for {motion.pressure.name}"
    return _refuse_rotation(motion, poisson)


def _refuse_angles(motion, poisson):
    if motion.pressure.is_round:
        return ""
    return f"rings cannot resolve the pressure {motion.pressure.name}"


def _refuse_rigid(motion, poisson):
    if motion.rotates and not motion.half_disc:
        return "half of the contact does not tell the other half"
    return _refuse_angles(motion, poisson) if motion.rotates else ""


def _symmetry(motion):
    """Of tractions on squares, as far as the pressure has it, too."""
    if not motion.half_disc:
        return ""
    return half.MIRROR if motion.rotates else half.TURN


_NO_ROTATION = _any_of(_refuse_rotation, _refuse_pulsation)

MODELS = {
    "rigid": Model(
        lambda motion, poisson, cells, angles, focus: RigidContact(
            cells, angles, motion.rotates, motion.pressure
        ),
        _any_of(_refuse_pulsation, _refuse_rigid),
        exact=lambda motion: not motion.periodic,
        axes=lambda motion: ("cells", "angles") if motion.rotates else (),
    ),
    "slider": Model(
        lambda motion, poisson, cells, angles, focus: slider_contact(),
        _NO_ROTATION,
        exact=_never,
        axes=lambda motion: (),
        side_by_side=RingsSideBySide,
    ),
    "dahl": Model(
        lambda motion, poisson, cells, angles, focus: DahlContact(motion.pressure.stiffness),
        _NO_ROTATION,
        exact=_never,
        axes=lambda motion: (),
    ),
    "mdr": Model(
        lambda motion, poisson, cells, angles, focus: mdr_contact(cells, focus, motion.pressure),
        _any_of(_refuse_other_loads, _refuse_springs),
        exact=_never,
        side_by_side=RingsSideBySide,
    ),
    "radial": Model(
        lambda motion, poisson, cells, angles, focus: RadialContact.resolved(
            cells, focus, motion.pressure
        ),
        _any_of(_refuse_other_loads, _refuse_rings),
        side_by_side=RingsSideBySide,
    ),
    "polar": Model(
        lambda motion, poisson, cells, angles, focus: PolarContact(
            cells,
            angles,
            motion.rotates,
            poisson,
            focus,
            motion.pressure,
            whole=not motion.half_disc,
        ),
        _any_of(_refuse_other_loads, _refuse_angles),
        axes=lambda motion: ("cells", "angles"),
        side_by_side=PolarSideBySide,
    ),
    "cartesian": Model(
        lambda motion, poisson, cells, angles, focus: CartesianContact(
            cells, poisson, motion.pressure, _symmetry(motion)
        ),
        _refuse_pulsation,
        side_by_side=SquaresSideBySide,
    ),
}
"""Models by name."""
