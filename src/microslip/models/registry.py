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
beside these and a row in `MODELS`.  A model is imported when its first contact is built, since
compiled code takes a while to load and closed forms do without it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


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


_NO_ROTATION = _any_of(_refuse_rotation, _refuse_pulsation)


def _rigid(motion, poisson, cells, angles, focus):
    from microslip.models.reduced.rigid import RigidContact

    return RigidContact(cells, angles, motion.rotates, motion.pressure)


def _slider(motion, poisson, cells, angles, focus):
    from microslip.models.reduced.slider import slider_contact

    return slider_contact()


def _dahl(motion, poisson, cells, angles, focus):
    from microslip.models.reduced.dahl import DahlContact

    return DahlContact(motion.pressure.stiffness)


def _mdr(motion, poisson, cells, angles, focus):
    from microslip.models.reduced.mdr import mdr_contact

    return mdr_contact(cells, focus, motion.pressure)


def _radial(motion, poisson, cells, angles, focus):
    from microslip.models.rings.contact import RadialContact

    return RadialContact.resolved(cells, focus, motion.pressure)


def _rings_side_by_side(contacts, shares, extents):
    from microslip.models.rings.side_by_side import RingsSideBySide

    return RingsSideBySide(contacts, shares, extents)


def _polar(motion, poisson, cells, angles, focus):
    from microslip.models.polar.contact import PolarContact

    whole = not motion.half_disc
    return PolarContact(cells, angles, motion.rotates, poisson, focus, motion.pressure, whole=whole)


def _polar_side_by_side(contacts, shares, extents):
    from microslip.models.polar.side_by_side import PolarSideBySide

    return PolarSideBySide(contacts, shares, extents)


def _cartesian(motion, poisson, cells, angles, focus):
    from microslip.models.squares import half
    from microslip.models.squares.contact import CartesianContact

    symmetry = ""  # of the tractions, as far as the pressure has it, too
    if motion.half_disc:
        symmetry = half.MIRROR if motion.rotates else half.TURN
    return CartesianContact(cells, poisson, motion.pressure, symmetry)


def _squares_side_by_side(contacts, shares, extents):
    from microslip.models.squares.side_by_side import SquaresSideBySide

    return SquaresSideBySide(contacts, shares, extents)


MODELS = {
    "rigid": Model(
        _rigid,
        _any_of(_refuse_pulsation, _refuse_rigid),
        exact=lambda motion: not motion.periodic,
        axes=lambda motion: ("cells", "angles") if motion.rotates else (),
    ),
    "slider": Model(
        _slider,
        _NO_ROTATION,
        exact=_never,
        axes=lambda motion: (),
        side_by_side=_rings_side_by_side,
    ),
    "dahl": Model(_dahl, _NO_ROTATION, exact=_never, axes=lambda motion: ()),
    "mdr": Model(
        _mdr,
        _any_of(_refuse_other_loads, _refuse_springs),
        exact=_never,
        side_by_side=_rings_side_by_side,
    ),
    "radial": Model(
        _radial,
        _any_of(_refuse_other_loads, _refuse_rings),
        side_by_side=_rings_side_by_side,
    ),
    "polar": Model(
        _polar,
        _any_of(_refuse_other_loads, _refuse_angles),
        axes=lambda motion: ("cells", "angles"),
        side_by_side=_polar_side_by_side,
    ),
    "cartesian": Model(_cartesian, _refuse_pulsation, side_by_side=_squares_side_by_side),
}
"""Models by name."""
