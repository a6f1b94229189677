"""Square cells with FFT convolution: any nu, any outline; the general reference, and the paper's
own method."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from microslip.models import contact
from microslip.models.interrupts import unbroken
from microslip.models.path import Path
from microslip.models.pull import Body, PulledMarch
from microslip.models.squares import march as square_march
from microslip.models.squares.convolution import convolve, square_convolution, workspace
from microslip.pressures.by_name import HERTZ
from microslip.pressures.pressure import Pressure

MAX_REMEMBERED = 4_000_000
"""Numbers that a march keeps as first guesses for the next one; longer marches keep none."""


class CartesianContact:
    """Squares over the circumscribed square of the contact (see models.contact.Contact).

    States: (2, cells, cells), axis 1 along the forward axis, axis 2 along the lateral one.  Cells
    that the edge cuts carry the load of their part inside.

    Parameters
    ----------
    cells : int
        Along a side.
    poisson : float
        Poisson's ratio.
    pressure : pressure.Pressure
        Any.

    Raises
    ------
    ValueError
        For fewer than 2 cells.
    """

    has_sensitivity = False
    sticks = True
    angles = 1

    def __init__(self, cells: int, poisson: float = 0.0, pressure: Pressure = HERTZ):
        if cells < 2:
            raise ValueError(f"cells = {cells}: allowed is a whole number of at least 2")
        self.size = 2.0 / cells
        centres = (np.arange(cells) + 0.5) * self.size - 1.0
        self.forward_position, self.lateral_position = np.meshgrid(centres, centres, indexing="ij")
        self.weight = np.full((cells, cells), self.size**2)
        self.bound = pressure.cell_loads(cells) / self.size**2
        self.stiffness = pressure.stiffness
        self.operator, self.scale, self.largest = square_convolution(
            cells, poisson, pressure.G_star
        )
        self.compliance = np.full((cells, cells), self.scale)

    def squares(self) -> square_march.Squares:
        """The march.Squares of this contact, for one thread at a time."""
        room = workspace(self.operator)
        scales = self.scale, self.largest
        return square_march.Squares(self.operator, room, *scales, self.bound, self.size**2)

    def displacement(self, state: np.ndarray) -> np.ndarray:
        """A q; shapes (2, cells, cells)."""
        out = np.empty(state.shape)
        convolve(self.operator, workspace(self.operator), np.ascontiguousarray(state), out)
        return out

    def mirrored(self, state: np.ndarray) -> np.ndarray:
        """Lateral axis reversed, lateral traction negated."""
        return state[:, :, ::-1] * contact.MIRROR

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
        """The PulledMarch of several contacts like this one, states (contacts, 2, cells, cells);
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
        solves = path.stages.shape[0] * path.stages.shape[1]
        return PulledMarch(state, forces, residual, iterations, solves, body=at)
