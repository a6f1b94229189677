"""What pulls a contact forward, as a march sees it: one unknown more, and one equation.

Let x be how far the contact is ahead of the path that it is marched along.  A body of mass m, held
by a dashpot c and pulled by a spring k, whose far end follows the path, or by a force P, obeys

    m x'' + c x' + k x + f = load,    f: forward force of the contact,

in working units, primes for derivatives by the phase.  The contact's integrator does for the body,
too: with r_i = g x_i' (g: the implicit part of the step) every stage leaves

    stiffness r_i + f(q_i) = pushed,    stiffness = k + c / g + m / g^2,

next to the Coulomb step, which r_i moves on from where earlier stages have left the body.  As f
does not fall with r_i, the two have one solution.  (An equation for x_i would drown in the rounding
of what a heavy body has behind it.)
Without mass and dashpot nothing of the body's past is in it: x is what the tractions make it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.models.contact import March
from microslip.models.path import Path


class Pull(NamedTuple):
    """The equation of the body, for compiled code.

    Attributes
    ----------
    stiffness, damping, mass : float
        k, c and m.
    load : float
        Force that does not change, over mu F_z.
    lengths : np.ndarray, shape (steps,)
        g, the implicit part of every step, in radians.
    start : np.ndarray, shape (2,)
        x and x' at the start; not looked at without mass and dashpot.
    """

    stiffness: float
    damping: float
    mass: float
    load: float
    lengths: np.ndarray
    start: np.ndarray


@dataclass(frozen=True)
class Body:
    """What is pulled and by what, in working units.

    Attributes
    ----------
    stiffness, damping, mass : float
        k over mu F_z / u_lim, c and m by the phase likewise; all 0: the load alone pulls.
    load : float
        Force that does not change, over mu F_z.
    """

    stiffness: float
    damping: float
    mass: float
    load: float

    @property
    def remembers(self) -> bool:
        """Whether x and x' belong to the state: else the tractions tell x."""
        return self.mass > 0.0 or self.damping > 0.0

    def along(self, path: Path, start: np.ndarray) -> Pull:
        """The Pull along a path, from x and x' at its start."""
        share = 1.0 / (1.0 + path.carry[-1].sum())  # a stiffly accurate method carries the rest
        lengths = share * np.diff(path.phase)
        return Pull(
            *map(float, (self.stiffness, self.damping, self.mass, self.load)), lengths, start
        )


@dataclass(frozen=True, eq=False)
class PulledMarch(March):
    """A March of a contact that is pulled.

    Attributes
    ----------
    body : np.ndarray, shape (steps + 1, 2)
        x and x' at every phase.
    """

    body: np.ndarray = None


class PullsContact(Protocol):
    """What a contact.Contact has besides, if its march knows how to be pulled."""

    def pulled_march(
        self,
        path: Path,
        state: np.ndarray,
        tolerance: float,
        body: Body,
        start: np.ndarray,
        previous: PulledMarch | None = None,
    ) -> PulledMarch:
        """As Contact.march, with a body that is at `start` (x, x') at first."""


@kernel(inline="always")
def starting_place(pull: Pull, force: float) -> float:
    """x at the start, where the contact carries `force`."""
    if pull.mass > 0.0 or pull.damping > 0.0:
        return pull.start[0]
    return (pull.load - force) / pull.stiffness if pull.stiffness > 0.0 else 0.0


@kernel(inline="always")
def stage_stiffness(pull: Pull, length: float) -> float:
    """Stiffness of the body in a stage."""
    return pull.stiffness + (pull.damping + pull.mass / length) / length


@kernel(inline="always")
def stage_load(pull: Pull, length: float, place: float, rate: float) -> float:
    """Force that pushes the body in a stage; place, rate: what earlier stages make of x and x'."""
    return pull.load - pull.stiffness * place + pull.mass * rate / length
