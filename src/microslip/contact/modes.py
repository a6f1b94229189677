"""Contact on rings with angular modes, for rotations at any nu and for translations at nu > 0.

The points are on rings at the angles theta_j = (j + 1/2) pi / M from the lateral axis.  Only one
half of the disc is resolved; the other half follows from symmetry:

- for rotations, a reflection across the lateral axis (forward traction even, lateral traction odd);
- for translations, the point symmetry traction(-z) = traction(z), so that all modes are even.

A motion that combines a rotation and a translation has neither symmetry, so the whole disc is
resolved.

Coulomb's law applies at the points.  The influence operator is block-diagonal in the angular modes.
At nu = 0, the forward tractions of a mode cause only forward displacements, and the lateral
tractions cause only lateral displacements.  The ring matrix is the same for both directions.  At nu
> 0, the forward component minus i times the lateral component is a sum of complex waves
e^{i m theta}.  Influence couples the waves m and 2 - m (see influence.py).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from microslip.contact.contact import LATERAL, TORQUE
from microslip.contact.influence import ring_influence
from microslip.contact.ring_contact import RingContact
from microslip.contact.rings import Focus, make_rings
from microslip.scene.hertz import HERTZ
from microslip.scene.pressure import Pressure

FEWEST_PROLONGED = 16
"""In rotations with at least this number of rings, tractions from a coarser mesh are a better
initial guess than the static limit."""
SHARED_MODES = (9, 17, 33)
"""Possible numbers of modes for which averages of the kernels are computed.  Only few numbers of
modes are possible.  Therefore, runs with 4, 6 and 8 angles share the same averages."""
Wave = tuple[int, int]
"""Number m of a wave, and its part (0 or 1); see `_pairs`."""

WHOLE, ROTATION, TRANSLATION = "whole disc", "mirror image", "half turn"
"""Symmetry by which the tractions on one half of the disc determine the tractions on the other
half.  WHOLE means that there is no such symmetry."""


def _single_waves(
    theta: np.ndarray, angles: int, symmetry: str, near: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the waves at nu = 0: the values of the waves at the points, and the ring matrices.

    The values have the shape (2, points, waves), with forward components first.

    For a rotation, the forward tractions are sums of cosines of multiples of the polar angle, and
    the lateral tractions are sums of sines.  For a translation, the forward and the lateral
    tractions are sums of cosines and sines whose numbers m are even.
    """
    numbers = np.arange(angles + 1)
    cosines, sines = np.cos(np.outer(theta, numbers)), np.sin(np.outer(theta, numbers))
    cosines[:, angles] = 0.0  # the exact value at the points
    if symmetry == ROTATION:
        return np.stack([cosines, sines]), near[numbers]
    step = 2 if symmetry == TRANSLATION else 1
    numbers = np.concatenate([numbers[:angles:step], numbers[step::step]])
    waves = np.concatenate([cosines[:, :angles:step], sines[:, step::step]], axis=1)
    return np.stack([waves, waves]), near[numbers]


def _pairs(angles: int, symmetry: str) -> tuple[list[tuple[Wave, Wave]], list[tuple[Wave, Wave]]]:
    """Return two lists of pairs of waves at nu > 0.  The first list contains the coupled pairs, and
    the second list contains the pairs without coupling.

    A wave is described by (m, part): part 0 is e^{i m theta}, and part 1 is i e^{i m theta}.  For a
    whole disc or a rotation, the waves of the shortest wavelength are not coupled, because their
    cosine is 0 at all points.
    """
    step = 2 if symmetry == TRANSLATION else 1
    parts = (0,) if symmetry == ROTATION else (0, 1)
    highest = angles if symmetry == TRANSLATION else angles - 1
    numbers = range(2 - angles if symmetry == TRANSLATION else 1 - angles, angles + 1, step)
    coupled, single = [], []
    for part in parts:
        for m in numbers:
            if m > highest or 2 - m not in numbers or 2 - m > highest or m == 1:
                single.append((m, part))
            elif m > 1:
                coupled.append(((m, part), (2 - m, part)))
    return coupled, list(zip(single[::2], single[1::2], strict=True))


def _coupled_waves(
    theta: np.ndarray, angles: int, symmetry: str, influence: tuple, area: np.ndarray, kappa: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the waves at nu > 0: the values of the waves at the points, and the matrices of all
    pairs.

    The coupled pairs come first, followed by the pairs without coupling.  The values have the shape
    (1, 2 points, 2 pairs).  The matrices have the shape (pairs, 2 n, 2 n).
    """
    pairs, single = _pairs(angles, symmetry)
    (near, far), n = influence, len(area)
    ratio = area[None, :] / area[:, None]  # weights for the transpose
    out = np.zeros((len(pairs) + len(single), 2, n, 2, n))
    for block, ((m, part), (other, _)) in zip(out, pairs, strict=False):
        cross = (kappa if part else -kappa) * far[m - 1]
        block[0, :, 0], block[1, :, 1] = near[m], near[abs(other)]
        block[0, :, 1], block[1, :, 0] = cross, cross.T * ratio
    for block, waves in zip(out[len(pairs) :], single, strict=True):
        for k, (m, part) in enumerate(waves):
            block[k, :, k] = near[abs(m)]
            if m == 1:
                sign = kappa if part else -kappa
                block[k, :, k] += 0.5 * sign * (far[0] + far[0].T * ratio)
    every = [wave for pair in (*pairs, *single) for wave in pair]
    values = np.array([1j**part * np.exp(1j * m * theta) for m, part in every])
    if symmetry != TRANSLATION:
        values.real[[m == angles and part == 0 for m, part in every]] = 0.0
    to_points = np.concatenate([values.real, -values.imag], axis=1).T[None]
    return to_points, out.reshape(len(out), 2 * n, 2 * n)


class PolarContact(RingContact):
    """Contact that is discretised into rings, and into angles on each ring; see contact.Contact.

    States have the shape (2, angles, cells).

    Parameters
    ----------
    cells, angles : int
        Number of rings, and number of points of each ring on one half of the disc.  The latter
        number must be even.
    rotates : bool
        True for a rotation, which has mirror symmetry; False for a translation.
    poisson : float
        Poisson's ratio.
    focus : rings.Focus, float or None
        Radii towards which the rings are graded.
    pressure : pressure.Pressure
        Pressure that depends on the radius alone.
    whole : bool
        Whether the whole disc is resolved.  States then have the shape (2, 2 angles, cells).

    Raises
    ------
    ValueError
        If `angles` is odd or below 2.
    """

    def __init__(
        self,
        cells: int,
        angles: int,
        rotates: bool,
        poisson: float = 0.0,
        focus: Focus | float | None = None,
        pressure: Pressure = HERTZ,
        *,
        whole: bool = False,
    ):
        if angles < 2 or angles % 2:
            raise ValueError(f"angles = {angles}: allowed is an even number of at least 2")
        rings = make_rings(cells, focus, pressure)
        self.rotates, self.whole, rows = rotates, whole, 2 * angles if whole else angles
        self.theta = theta = (np.arange(rows) + 0.5) * np.pi / angles
        symmetry = WHOLE if whole else ROTATION if rotates else TRANSLATION
        modes, kappa = angles + 1, poisson / (2.0 - poisson)
        for most in reversed(SHARED_MODES):
            modes = most if angles < most else modes
        influence = ring_influence(tuple(rings.psi), modes, kappa > 0.0, pressure.G_star)
        if kappa == 0.0:
            to_points, matrices = _single_waves(theta, angles, symmetry, influence[0])
        else:
            place = theta, angles, symmetry
            to_points, matrices = _coupled_waves(*place, influence, rings.area, kappa)
        to_points = np.ascontiguousarray(to_points)
        to_waves = np.ascontiguousarray(np.linalg.pinv(to_points))
        super().__init__(
            influence[0][0],
            rings.bound,
            rings.area,
            np.stack([np.sin(theta), np.cos(theta)])[..., None] * rings.radius,
            stiffness=pressure.stiffness,
            waves=(to_waves, to_points, matrices),
            rings=rings,
        )
        self.prolongs = not whole and (not rotates or cells >= FEWEST_PROLONGED)
        self.mirror_rows = np.roll(np.arange(rows)[::-1], angles if whole else 0)
        self.resultants = np.ones(3)
        if not whole:  # the other half of the disc cancels this force
            self.resultants[LATERAL if rotates else TORQUE] = 0.0


polar_contact = lru_cache(maxsize=32)(PolarContact)
"""Function that creates a PolarContact.  Calls with equal arguments return the same object, which
must not be modified."""
