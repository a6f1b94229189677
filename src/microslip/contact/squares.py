"""Contact of equal rectangular cells with a compiled convolution, for any nu and any outline.

The cells cover the rectangle around the contact, with the same number of cells along both axes.
For a round contact, the cells are squares, as in the paper. This model is the reference for the
other models.

Tractions have the symmetries that the rigid displacement, the pressure and the influence operator
have in common.  The common symmetries divide the cells into sets.  Only one cell of each set is
resolved (see `_images`).
"""

from __future__ import annotations

import signal

import numpy as np

from microslip.contact import convolution
from microslip.contact.contact import (
    LATERAL,
    MIRROR,
    TORQUE,
    Body,
    Contact,
    March,
    Step,
    march_by_steps,
)
from microslip.contact.path import Path
from microslip.scene.hertz import HERTZ
from microslip.scene.pressure import Pressure

MOST_DISPLACEMENTS = 60
"""Largest number of trial displacements of a driven body in each step."""
FLATTEST = 1e-3
"""Smallest slope in the secant method, as a fraction of the largest possible slope.  Flatter
secants are replaced by this slope."""
INNER = 0.3
"""Allowed residual at each trial displacement, divided by the tolerance of the step."""
ROUNDED = 1e-10
"""Two loads are treated as equal if their difference divided by the largest load is below this
value.  For a sphere on 192 x 192 cells, the loads of symmetric cells differ by less than 1/20 of
this value."""


class CartesianContact(Contact):
    """Contact of equal cells that cover the rectangle around the contact; see contact.Contact.

    States have the shape (2, cells, cells), with the forward coordinate along axis 1 and the
    lateral coordinate along axis 2.  If the contact uses symmetries, only half of the cells along
    axis 1, or along both axes, are resolved.  A cell cut by the edge of the contact carries only
    the load inside the contact.

    Parameters
    ----------
    cells : int
        Number of cells along each side.
    poisson : float
        Poisson's ratio.
    pressure : pressure.Pressure
        Any pressure.
    symmetry : str
        Symmetry of the motion: convolution.TURN for translations, convolution.MIRROR for rotations
        without a lateral displacement, "" for other motions.  The symmetry is used only if the
        pressure is symmetric as well.

    Attributes
    ----------
    widths : np.ndarray, shape (2,)
        Forward and lateral width of a cell.
    images : int
        Number of cells of the whole contact for each resolved cell: 4 if only cells with positive
        coordinates are resolved, 2 if only cells with a positive forward coordinate are resolved,
        otherwise 1.

    Raises
    ------
    ValueError
        If `cells` is below 2.
    """

    angles = 1
    sticks = True
    radius = 1.0

    def __init__(
        self,
        cells: int,
        poisson: float = 0.0,
        pressure: Pressure = HERTZ,
        symmetry: str = "",
    ):
        if cells < 2:
            raise ValueError(f"cells = {cells}: allowed is a whole number of at least 2")
        half_widths = np.array(pressure.half_widths)
        self.widths = 2.0 * half_widths / cells
        centres = (np.arange(cells) + 0.5) * (2.0 / cells) - 1.0
        area = float(self.widths.prod())
        self.bound = pressure.cell_loads(cells) / area
        self.images = _images(self.bound, symmetry, poisson)
        rows = centres[cells // 2 :] if self.images > 1 else centres
        columns = centres[cells // 2 :] if self.images == 4 else centres
        self.bound = _mean_of_images(self.bound, self.images, symmetry)
        self.forward_position, self.lateral_position = np.meshgrid(
            half_widths[0] * rows, half_widths[1] * columns, indexing="ij"
        )
        self.area = self.images * area
        self.weight = np.full(self.bound.shape, self.area)
        self.stiffness = pressure.stiffness
        self.convolution, self.scale, self.largest = convolution.square_convolution(
            cells, poisson, pressure.G_star, self.images, symmetry, pressure.half_widths
        )
        self.compliance = np.full(self.bound.shape, self.scale)
        self.resultants = np.ones(3)
        if self.images > 1:  # this force is cancelled by the images of the cells
            self.resultants[LATERAL if symmetry == convolution.MIRROR else TORQUE] = 0.0

    def displacement(self, state: np.ndarray) -> np.ndarray:
        """Return the elastic displacement A q of each cell under tractions q."""
        out = np.empty_like(state)
        convolution.convolve(
            self.convolution,
            convolution.workspace(self.convolution),
            np.ascontiguousarray(state),
            out,
        )
        return out

    def mirrored(self, state: np.ndarray) -> np.ndarray:
        """Return the mirror image of a state, in which the lateral direction is reversed.  The
        reflection negates lateral tractions."""
        return (state if self.images == 4 else state[:, :, ::-1]) * MIRROR

    def march(
        self,
        path: Path,
        state: np.ndarray,
        tolerance: float,
        previous: March | None = None,
        *,
        body: Body | None = None,
        start: np.ndarray | None = None,
    ) -> March:
        """Integrate the contact along a path; see contact.Contact."""
        solver = DescentSolver(self, tolerance)
        march = march_by_steps(self, solver, path, state, previous, body=body, start=start)
        return march._replace(forces=march.forces * self.resultants)


class DescentSolver:
    """Solver of the Coulomb steps of a contact of equal cells.

    Parameters
    ----------
    contact : CartesianContact
        The contact.
    tolerance : float
        Largest allowed residual of a step, as a force divided by mu F_z.
    patience : int or None
        Replaces convolution.PATIENCE; None to use this default.
    """

    def __init__(self, contact: CartesianContact, tolerance: float, patience: int | None = None):
        self.contact, self.tolerance = contact, float(tolerance)
        self.patience = convolution.PATIENCE if patience is None else patience
        self._length = 1.0 / contact.scale
        rows, columns = contact.bound.shape
        self._scratch = convolution.workspace(contact.convolution), np.empty((4, rows, columns))

    def solve(self, b: np.ndarray, guess: np.ndarray, share: float = 1.0) -> Step:
        """Solve one step in which the displacement b is imposed.

        share: factor by which the tolerance is multiplied.  Returns the tractions, the slip, the
        number of iterations, the residual, and the displacement of a driven body.  This
        displacement is 0 here.
        """
        contact, q, slip = self.contact, np.array(guess), np.empty_like(b)
        while True:
            count, residual, self._length = convolution.descend(
                contact.convolution,
                (contact.area, contact.scale, contact.largest),
                (contact.bound, b, q, slip),
                self._scratch,
                (self._length, share * self.tolerance, self.patience),
            )
            if count >= 0:
                return q, slip, count, residual, 0.0
            signal.raise_signal(signal.SIGINT)

    def balance(self, b: np.ndarray, guess: np.ndarray, stiffness: float, load: float) -> Step:
        """Solve a step of a driven body; see march.py.  Returns the same values as `solve`.

        The secant method finds the displacement d at which the forces balance.  The forward force
        never decreases as d increases. The slope of the forward force is at most the stiffness of
        the contact.
        """
        steepest = stiffness + self.contact.stiffness
        place, slope, low, high, before, last_gap = 0.0, steepest, -np.inf, np.inf, np.nan, np.nan
        q, iterations = guess, 0
        for _ in range(MOST_DISPLACEMENTS):
            moved = b.copy()
            moved[0] += place
            q, slip, count, residual, _ = self.solve(moved, q, INNER)
            iterations += count
            gap = load - stiffness * place - self.contact.area * float(q[0].sum())
            if residual + abs(gap) <= self.tolerance:
                break
            low, high = (max(low, place), high) if gap > 0.0 else (low, min(high, place))
            if place != before and not np.isnan(before):
                slope = np.clip((last_gap - gap) / (place - before), FLATTEST * steepest, steepest)
            before, last_gap = place, gap
            place += gap / slope
            if not low < place < high:
                place = 0.5 * (low + high)
        return q, slip, iterations, residual + abs(gap), place


def _images(loads: np.ndarray, symmetry: str, poisson: float) -> int:
    """Return the number of cells of the whole contact for each resolved cell: 1, 2 or 4.

    Displacements in a translation are symmetric under a half turn.  Displacements in a rotation are
    symmetric under a reflection across the lateral axis.  For translations at nu = 0, forward and
    lateral displacements are independent. Each of the two fields is even along both axes.
    """
    if len(loads) % 2 or not symmetry:
        return 1
    if symmetry == convolution.MIRROR:
        return 2 if _is_like(loads, loads[::-1]) else 1
    even = _is_like(loads, loads[::-1]) and _is_like(loads, loads[:, ::-1])
    if even and poisson == 0.0:
        return 4
    return 2 if _is_like(loads, loads[::-1, ::-1]) else 1


def _is_like(loads: np.ndarray, image: np.ndarray) -> bool:
    """Return whether two fields are equal up to rounding errors."""
    return bool(np.abs(image - loads).max() <= ROUNDED * loads.max())


def _mean_of_images(loads: np.ndarray, images: int, symmetry: str) -> np.ndarray:
    """Return the loads of the resolved cells, averaged over the images to remove rounding
    errors."""
    if images == 1:
        return loads
    ahead = len(loads) // 2
    image = loads[::-1, ::-1] if images == 2 and symmetry == convolution.TURN else loads[::-1]
    mean = 0.5 * (loads + image)[ahead:]
    return 0.5 * (mean + mean[:, ::-1])[:, ahead:] if images == 4 else mean
