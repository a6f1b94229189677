"""Contact of equal rectangular cells with FFT convolution, for any nu and any outline.

The cells cover the rectangle around the contact, with the same number along both axes.  For a round
contact they are squares, as in the paper, and this model is the reference for the other models.

Tractions have the symmetries that the rigid displacement, the pressure and the influence operator
have in common.  Of all cells related by these symmetries, only one is resolved (see `_images`).
"""

from __future__ import annotations

import numpy as np

from microslip.contacts.descent import PATIENCE, Descent
from microslip.models import contact
from microslip.models.squares import half
from microslip.models.squares.convolution import convolved, square_convolution
from microslip.models.system_contact import Layout, SystemContact
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Pressure

ROUNDED = 1e-10
"""Two loads count as equal if their difference divided by the largest load is below this value.
For a sphere on 192 x 192 cells, loads differ from their images by less than 1/20 of this
value."""


class CartesianContact(SystemContact):
    """Contact of equal cells over the rectangle around the contact (see models.contact.Contact).

    States have the shape (2, cells, cells), with the forward coordinate along axis 1 and the
    lateral one along axis 2.  With symmetry, axis 1 or both axes have half the length.  A cell cut
    by the edge of the contact carries only the load inside the contact.

    Parameters
    ----------
    cells : int
        Number of cells along a side.
    poisson : float
        Poisson's ratio.
    pressure : pressure.Pressure
        Any pressure.
    symmetry : str
        Symmetry of the motion: half.TURN for translations, half.MIRROR for rotations without a
        lateral displacement, "" for other motions.  The symmetry is used only if the pressure is
        symmetric as well.

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
        convolution, self.scale, self.largest = square_convolution(
            cells, poisson, pressure.G_star, self.images, symmetry, pressure.half_widths
        )
        self.compliance = np.full(self.bound.shape, self.scale)
        rows, columns = self.bound.shape
        self.layout = Layout(1, rows, columns, columns)
        points = np.arange(rows * columns)
        mirror = points if self.images == 4 else points.reshape(rows, columns)[:, ::-1].ravel()
        self.mirror = mirror
        self.operators = convolved(convolution, rows, columns)
        self.resultants = np.ones(3)
        if self.images > 1:  # the images of the cells cancel this force
            self.resultants[contact.LATERAL if symmetry == half.MIRROR else contact.TORQUE] = 0.0

    def solver(self, weight: np.ndarray) -> Descent:
        """Create the solver of Coulomb steps.  It uses projected gradients."""
        length = np.array([1.0 / self.scale])
        return Descent(self.largest, PATIENCE, length, np.empty((3, self.layout.columns)))


def _images(loads: np.ndarray, symmetry: str, poisson: float) -> int:
    """Number of cells of the whole contact for each resolved cell: 1, 2 or 4.

    Displacements of a translation are symmetric under a half turn, and those of a rotation under a
    reflection across the lateral axis.  For translations at nu = 0, forward and lateral
    displacements are independent, and each is even along both axes.
    """
    if len(loads) % 2 or not symmetry:
        return 1
    if symmetry == half.MIRROR:
        return 2 if _is_like(loads, loads[::-1]) else 1
    even = _is_like(loads, loads[::-1]) and _is_like(loads, loads[:, ::-1])
    if even and poisson == 0.0:
        return 4
    return 2 if _is_like(loads, loads[::-1, ::-1]) else 1


def _is_like(loads: np.ndarray, image: np.ndarray) -> bool:
    """Whether two fields are equal up to rounding errors."""
    return bool(np.abs(image - loads).max() <= ROUNDED * loads.max())


def _mean_of_images(loads: np.ndarray, images: int, symmetry: str) -> np.ndarray:
    """Loads of the resolved cells, averaged over their images to remove rounding errors."""
    if images == 1:
        return loads
    ahead = len(loads) // 2
    image = loads[::-1, ::-1] if images == 2 and symmetry == half.TURN else loads[::-1]
    mean = 0.5 * (loads + image)[ahead:]
    return 0.5 * (mean + mean[:, ::-1])[:, ahead:] if images == 4 else mean
