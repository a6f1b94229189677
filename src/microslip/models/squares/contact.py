"""Square cells with FFT convolution: any nu, any outline; the general reference, and the paper's
own method.

What tells the rest is enough, see `_images`: tractions have the symmetries that the rigid
displacement, the pressure and the influence of tractions share.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from microslip.models import contact
from microslip.models.interrupts import unbroken
from microslip.models.path import Path
from microslip.models.pull import Body, PulledMarch
from microslip.models.squares import half
from microslip.models.squares import march as square_march
from microslip.models.squares.convolution import convolve, square_convolution, workspace
from microslip.pressures.by_name import HERTZ
from microslip.pressures.pressure import Pressure

MAX_REMEMBERED = 4_000_000
"""Numbers that a march keeps as first guesses for the next one; longer marches keep none."""
ROUNDED = 1e-10
"""Difference of two loads, over the largest, below which they are one number: those of a sphere on
192 squares across differ from their images by less than a twentieth of it."""


class CartesianContact:
    """Squares over the circumscribed square of the contact (see models.contact.Contact).

    States: (2, cells, cells), axis 1 along the forward axis, axis 2 along the lateral one, or half
    as many along axis 1, or both, where these tell the rest.  Cells that the edge cuts carry the
    load of their part inside.

    Parameters
    ----------
    cells : int
        Along a side.
    poisson : float
        Poisson's ratio.
    pressure : pressure.Pressure
        Any.
    symmetry : str
        half.TURN of translations, half.MIRROR of rotations with nothing lateral besides, "" of
        all else.  Squares then stand for their images, too, as far as the pressure has it.

    Attributes
    ----------
    images : int
        Squares that one stands for, itself included: 4 where both coordinates are positive, 2 where
        the forward one is, 1.

    Raises
    ------
    ValueError
        For fewer than 2 cells.
    """

    has_sensitivity = False
    sticks = True
    angles = 1

    def __init__(
        self,
        cells: int,
        poisson: float = 0.0,
        pressure: Pressure = HERTZ,
        symmetry: str = "",
    ):
        if cells < 2:
            raise ValueError(f"cells = {cells}: allowed is a whole number of at least 2")
        self.size = 2.0 / cells
        centres = (np.arange(cells) + 0.5) * self.size - 1.0
        self.bound = pressure.cell_loads(cells) / self.size**2
        self.images = _images(self.bound, symmetry, poisson)
        rows = centres[cells // 2 :] if self.images > 1 else centres
        columns = centres[cells // 2 :] if self.images == 4 else centres
        self.bound = _mean_of_images(self.bound, self.images, symmetry)
        self.forward_position, self.lateral_position = np.meshgrid(rows, columns, indexing="ij")
        self.area = self.images * self.size**2
        self._cancelled = contact.LATERAL if symmetry == half.MIRROR else contact.TORQUE
        self.weight = np.full(self.bound.shape, self.area)
        self.stiffness = pressure.stiffness
        self.operator, self.scale, self.largest = square_convolution(
            cells, poisson, pressure.G_star, self.images, symmetry
        )
        self.compliance = np.full(self.bound.shape, self.scale)

    def squares(self) -> square_march.Squares:
        """The march.Squares of this contact, for one thread at a time."""
        room = workspace(self.operator)
        scales = self.scale, self.largest
        return square_march.Squares(self.operator, room, *scales, self.bound, self.area)

    def displacement(self, state: np.ndarray) -> np.ndarray:
        """A q; shapes of a state."""
        out = np.empty(state.shape)
        convolve(self.operator, workspace(self.operator), np.ascontiguousarray(state), out)
        return out

    def mirrored(self, state: np.ndarray) -> np.ndarray:
        """Lateral axis reversed, lateral traction negated."""
        return (state if self.images == 4 else state[:, :, ::-1]) * contact.MIRROR

    def _without_what_cancels(self, forces):
        """Set to zero what symmetry forbids, and the images of the squares cancel."""
        if self.images > 1:
            forces[:, self._cancelled] = 0.0

    def march(
        self,
        path: Path,
        state: np.ndarray,
        tolerance: float,
        sensitivity: bool = False,
        previous: contact.March | None = None,
    ) -> contact.March:
        """March along `path`; see models.contact.Contact."""
        steps, n_stages, _ = path.stages.shape
        guided = previous is not None and previous.stages is not None
        remembers = steps * n_stages * state.size <= MAX_REMEMBERED
        tractions = np.zeros((steps if remembers else 1, n_stages, *state.shape))
        state, forces, residual, iterations = unbroken(
            square_march.march,
            self.squares(),
            (self.forward_position, self.lateral_position),
            path.under(self.bound[None]),
            np.ascontiguousarray(state),
            tolerance,
            square_march.Guide(previous.stages if guided else tractions, guided, tractions),
        )
        self._without_what_cancels(forces)
        stages = tractions if remembers else None
        return contact.March(state, forces, residual, iterations, steps * n_stages, stages=stages)

    def pulled_march(
        self,
        path: Path,
        state: np.ndarray,
        tolerance: float,
        body: Body,
        start: np.ndarray,
        previous: PulledMarch | None = None,
    ) -> PulledMarch:
        """March from which a body may stay behind or run ahead; see models.pull.PullsContact."""
        moved = np.concatenate([path.positions[:1], path.stages.reshape(-1, 3)])
        standing = np.ones(1), np.ones(1), moved[None]
        march = self.pulled_along(path, standing, state[None], tolerance, (body, start))
        return replace(march, state=march.state[0])

    def pulled_along(
        self, path: Path, standing: tuple, state: np.ndarray, tolerance: float, pulled: tuple
    ) -> PulledMarch:
        """The PulledMarch of several contacts like this one, states along the first axis;
        standing: shares, extents and displacements, see pulled_march.py; pulled: a pull.Body and
        where it is."""
        from microslip.models.squares.pulled_march import (  # only now: as for rings
            Carried,
            pulled_march,
        )

        (shares, extents, moved), (body, start) = standing, pulled
        positions = self.forward_position, self.lateral_position
        state, at, forces, residual, iterations = unbroken(
            pulled_march,
            self.squares(),
            (positions, Carried(shares, extents), moved),
            path.under(self.bound[None]),
            body.along(path, start),
            np.ascontiguousarray(state),
            (float(tolerance), float((self.stiffness * shares / extents).sum())),
        )
        self._without_what_cancels(forces)
        solves = path.stages.shape[0] * path.stages.shape[1]
        return PulledMarch(state, forces, residual, iterations, solves, body=at)


def _images(loads, symmetry, poisson):
    """Squares that one stands for.

    Translations move all points alike, and a half turn takes that to its opposite; so do rotations
    and a mirror across the lateral axis.  At nu = 0 forward and lateral displacements of
    translations do not mix, and each of them is even along both axes.
    """
    if len(loads) % 2 or not symmetry:
        return 1
    if symmetry == half.MIRROR:
        return 2 if _is_like(loads, loads[::-1]) else 1
    even = _is_like(loads, loads[::-1]) and _is_like(loads, loads[:, ::-1])
    if even and poisson == 0.0:
        return 4
    return 2 if _is_like(loads, loads[::-1, ::-1]) else 1


def _is_like(loads, image):
    """Whether two fields are the same but for rounding."""
    return bool(np.abs(image - loads).max() <= ROUNDED * loads.max())


def _mean_of_images(loads, images, symmetry):
    """Loads of the squares that are left, without what rounding makes of images."""
    if images == 1:
        return loads
    ahead = len(loads) // 2
    image = loads[::-1, ::-1] if images == 2 and symmetry == half.TURN else loads[::-1]
    mean = 0.5 * (loads + image)[ahead:]
    return 0.5 * (mean + mean[:, ::-1])[:, ahead:] if images == 4 else mean
