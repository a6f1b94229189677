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
> 0, consider the complex waves e^{i m theta} of forward - i lateral.  Influence couples the waves m
and 2 - m (see influence.py).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from microslip.contact.contact import LATERAL, MIRROR, TORQUE
from microslip.contact.influence import ring_influence
from microslip.contact.ring_contact import RingContact, interpolate
from microslip.contact.rings import Focus, Rings, make_rings
from microslip.scene.hertz import HERTZ
from microslip.scene.pressure import Pressure

FEWEST_PROLONGED = 16
"""In rotations with at least this number of rings, tractions from a coarser mesh are a better
initial guess than the static limit."""
SHARED_MODES = (9, 17, 33)
"""Possible numbers of modes for which averages of the kernels are computed.  Because few numbers
are possible, runs with 4, 6 and 8 angles share the same averages."""
Wave = tuple[int, int]
"""Number m of a wave, and its part (0 or 1); see `_pairs`."""

WHOLE, ROTATION, TRANSLATION = "whole disc", "mirror image", "half turn"
"""Symmetry by which the tractions on one half of the disc determine the tractions on the other
half.  WHOLE means that there is no such symmetry."""


def _single_waves(
    theta: np.ndarray, angles: int, symmetry: str
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the waves at nu = 0 as three arrays.

    The first array contains the number m of each wave.  The second and the third array contain the
    values of the waves at the points, for the forward and the lateral component.  Both arrays have
    the shape (waves, points).

    For a rotation, the forward tractions are sums of cosines of multiples of the polar angle, and
    the lateral tractions are sums of sines.  For a translation, the tractions in both directions
    are cosines and sines with even numbers m.
    """
    numbers = np.arange(angles + 1)
    cosines, sines = np.cos(np.outer(numbers, theta)), np.sin(np.outer(numbers, theta))
    cosines[angles] = 0.0  # the exact value at the points
    if symmetry == ROTATION:
        return numbers, cosines, sines
    step = 2 if symmetry == TRANSLATION else 1
    numbers = np.concatenate([numbers[:angles:step], numbers[step::step]])
    waves = np.concatenate([cosines[:angles:step], sines[step::step]])
    return numbers, waves, waves


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


def _coupled_matrices(
    pairs: Sequence[tuple[Wave, Wave]],
    single: Sequence[tuple[Wave, Wave]],
    influence: tuple[np.ndarray, np.ndarray],
    ratio: np.ndarray,
    kappa: float,
) -> np.ndarray:
    """Return the matrices of all pairs, first the coupled pairs, and then the pairs without
    coupling.

    The result is an array of shape (pairs, 2, n, 2, n).
    """
    near, far = influence
    n = near.shape[1]
    out = np.zeros((len(pairs) + len(single), 2, n, 2, n))
    for block, ((m, part), (other, _)) in zip(out, pairs, strict=False):
        cross = (kappa if part else -kappa) * far[m - 1]
        block[0, :, 0], block[1, :, 1] = near[m], near[abs(other)]
        block[0, :, 1], block[1, :, 0] = cross, cross.T * ratio.T
    for block, waves in zip(out[len(pairs) :], single, strict=True):
        for k, (m, part) in enumerate(waves):
            block[k, :, k] = near[abs(m)]
            if m == 1:
                sign = kappa if part else -kappa
                block[k, :, k] += 0.5 * sign * (far[0] + far[0].T * ratio.T)
    return out


@lru_cache(maxsize=4)
def _shared_influence(
    psi: tuple[float, ...], n_modes: int, coupled: bool, modulus: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the influence matrices of modes on rings with the edges `psi`; see ring_influence."""
    return ring_influence(np.array(psi), n_modes, coupled, modulus=modulus)


def influence_modes(
    rings: Rings, angles: int, symmetry: str, poisson: float, modulus: float
) -> tuple[tuple[np.ndarray, np.ndarray, np.ndarray], np.ndarray]:
    """Compute the influence operator for points on rings.

    Parameters
    ----------
    rings : rings.Rings
        Mesh of n rings.
    angles : int
        Number of points on one half of each ring.
    symmetry : str
        WHOLE, ROTATION or TRANSLATION.
    poisson, modulus : float
        Poisson's ratio, and G* in working units.

    Returns
    -------
    waves : tuple of np.ndarray
        The argument `waves` of ring_contact.RingContact.
    influence : np.ndarray, shape (n, n)
        Ring matrix of the mode 0.
    """
    kappa = poisson / (2.0 - poisson)
    modes = next((most for most in SHARED_MODES if angles < most), angles + 1)
    influence = near, _ = _shared_influence(tuple(rings.psi), modes, poisson > 0.0, modulus)
    points = 2 * angles if symmetry == WHOLE else angles
    theta = (np.arange(points) + 0.5) * np.pi / angles
    if kappa == 0.0:
        numbers, forward, lateral = _single_waves(theta, angles, symmetry)
        to_points, matrices = np.stack([forward.T, lateral.T]), near[numbers]
    else:
        pairs, single = _pairs(angles, symmetry)
        ratio = rings.area[:, None] / rings.area[None, :]  # weights for the transpose
        matrices = _coupled_matrices(pairs, single, influence, ratio, kappa)
        matrices = matrices.reshape(len(matrices), 2 * len(ratio), -1)
        waves = [wave for pair in (*pairs, *single) for wave in pair]
        values = np.array([1j**part * np.exp(1j * m * theta) for m, part in waves])
        values.real[
            np.array([m == angles and symmetry != TRANSLATION and part == 0 for m, part in waves])
        ] = 0.0
        to_points = np.concatenate([values.real, -values.imag], axis=1).T[None]
    to_waves = np.ascontiguousarray(np.linalg.pinv(to_points))
    return (to_waves, np.ascontiguousarray(to_points), matrices), near[0]


class PolarContact(RingContact):
    """Contact with points on rings and at angles; see contact.Contact.

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
        self._theta = theta = (np.arange(rows) + 0.5) * np.pi / angles
        symmetry = WHOLE if whole else ROTATION if rotates else TRANSLATION
        waves, influence = influence_modes(rings, angles, symmetry, poisson, pressure.G_star)
        positions = np.stack([np.sin(theta), np.cos(theta)])[..., None] * rings.radius
        place = influence, rings.bound, rings.area, positions
        super().__init__(*place, stiffness=pressure.stiffness, waves=waves, rings=rings)
        self.mirror_rows = np.roll(np.arange(rows)[::-1], angles if whole else 0)
        self.resultants = np.ones(3)
        if not whole:  # the other half of the disc cancels this force
            self.resultants[LATERAL if rotates else TORQUE] = 0.0

    def prolong(self, state: np.ndarray) -> np.ndarray | None:
        """Interpolate tractions from a coarser mesh to the points of this contact.

        The tractions have the shape (2, angles, cells).  Returns None in three cases: for whole
        discs, for changing loads, and for rotations with too few rings (see FEWEST_PROLONGED).
        """
        few = self.rotates and len(self.bound) < FEWEST_PROLONGED
        on_rings = None if few or self.whole else super().prolong(state)
        if on_rings is None:
            return None
        # extend the angles beyond the lateral axis, across which forward tractions are even;
        # lateral tractions are odd for a rotation and even for a translation
        beyond, count = on_rings[:, [0, -1]] * (MIRROR if self.rotates else 1.0), state.shape[1]
        fields = np.concatenate([beyond[:, :1], on_rings, beyond[:, 1:]], axis=1)
        angles = (np.arange(-1, count + 1) + 0.5) / count
        return interpolate(self._theta / np.pi, angles, fields.swapaxes(1, 2)).swapaxes(1, 2)


polar_contact = lru_cache(maxsize=32)(PolarContact)
"""Function that creates a PolarContact.  Calls with equal arguments return the same object, which
must not be modified."""
