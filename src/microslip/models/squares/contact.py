"""Square cells with FFT convolution: any nu, any outline; the general reference, and the paper's
own method.

What tells the rest is enough, see `_images`: tractions have the symmetries that the rigid
displacement, the pressure and the influence of tractions share.
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
"""Difference of two loads, over the largest, below which they are one number: those of a sphere on
192 squares across differ from their images by less than a twentieth of it."""


class CartesianContact(SystemContact):
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
        self.weight = np.full(self.bound.shape, self.area)
        self.stiffness = pressure.stiffness
        convolution, self.scale, self.largest = square_convolution(
            cells, poisson, pressure.G_star, self.images, symmetry
        )
        self.compliance = np.full(self.bound.shape, self.scale)
        rows, columns = self.bound.shape
        self.layout = Layout(1, rows, columns, columns)
        points = np.arange(rows * columns)
        mirror = points if self.images == 4 else points.reshape(rows, columns)[:, ::-1].ravel()
        self.mirror = mirror
        self.operators = convolved(convolution, rows, columns)
        self.resultants = np.ones(3)
        if self.images > 1:  # what the images of the squares cancel
            self.resultants[contact.LATERAL if symmetry == half.MIRROR else contact.TORQUE] = 0.0

    def solver(self, weight: np.ndarray) -> Descent:
        """The solver of a step."""
        length = np.array([1.0 / self.scale])
        return Descent(self.largest, PATIENCE, length, np.empty((3, self.layout.columns)))


def _images(loads: np.ndarray, symmetry: str, poisson: float) -> int:
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


def _is_like(loads: np.ndarray, image: np.ndarray) -> bool:
    """Whether two fields are the same but for rounding."""
    return bool(np.abs(image - loads).max() <= ROUNDED * loads.max())


def _mean_of_images(loads: np.ndarray, images: int, symmetry: str) -> np.ndarray:
    """Loads of the squares that are left, without what rounding makes of images."""
    if images == 1:
        return loads
    ahead = len(loads) // 2
    image = loads[::-1, ::-1] if images == 2 and symmetry == half.TURN else loads[::-1]
    mean = 0.5 * (loads + image)[ahead:]
    return 0.5 * (mean + mean[:, ::-1])[:, ahead:] if images == 4 else mean
