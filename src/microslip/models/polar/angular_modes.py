"""The influence operator for points on rings and at angles.  It is block-diagonal in angular modes.

Points are at the angles theta_j = (j + 1/2) pi / M of half the disc or of the whole disc.  At nu =
0, the forward tractions of a mode cause only forward displacements, and the lateral tractions cause
only lateral displacements.  Both have the same ring matrix.  At nu > 0, the complex waves e^{i m
theta} of forward - i lateral are coupled in pairs m and 2 - m (see rings/influence.py).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from microslip.contacts.lanes import LANES, NOTHING, four, plus_multiple, put
from microslip.contacts.operators import Matrices, multiply_rows, operator, packed, start
from microslip.contacts.splitting import PENALTIES, best_penalty
from microslip.foundation.compiled import kernel
from microslip.models.rings.influence import ring_influence
from microslip.models.rings.mesh import Rings

SHARED_MODES = (9, 17, 33)
"""Possible numbers of modes with averaged kernels.  Runs at 4, 6 and 8 angles share the same
averages."""


Wave = tuple[int, int]
"""Number m of a wave and its part (0 or 1), see `_pairs`."""


class Modes(NamedTuple):
    """Operators on fields, for one or several contacts.  The points are on rings and at angles.

    Rows of a field have equal width.  At nu = 0, there are two sectors, forward and lateral.  At
    nu > 0, there is one sector.

    Attributes
    ----------
    to_modes : np.ndarray, shape (sectors, waves, rows of points)
        Matrix that transforms values at the points into amplitudes of the waves.
    to_points : np.ndarray, shape (sectors, rows of points, waves)
        Matrix that transforms amplitudes of the waves into values at the points.
    blocks : np.ndarray, shape (operators, contacts waves, chunks, columns, LANES)
        Matrices.blocks of each wave at nu = 0, or of each pair of neighbouring waves at nu > 0.  A
        pair forms one row of twice the width.
    points, waves : np.ndarray of int, shape (sectors contacts, ...)
        Indices of the rows that belong to a sector of a contact, in a field and in `amplitudes`.
    amplitudes, images : np.ndarray, shape (sectors, contacts waves width)
        Scratch arrays.
    """

    to_modes: np.ndarray
    to_points: np.ndarray
    blocks: np.ndarray
    points: np.ndarray
    waves: np.ndarray
    amplitudes: np.ndarray
    images: np.ndarray

    def own(self) -> Modes:
        """Return a copy of these operators with separate scratch arrays."""
        return self._replace(
            amplitudes=np.empty_like(self.amplitudes), images=np.empty_like(self.images)
        )


def modes_of(
    to_modes: np.ndarray, to_points: np.ndarray, blocks: np.ndarray, contacts: int, width: int
) -> Modes:
    """Create Modes for a number of contacts, with scratch arrays."""
    sectors, waves, rows = to_modes.shape
    points = np.arange(2 * contacts * (rows * sectors // 2)).reshape(2, contacts, -1)
    if sectors == 1:
        points = np.moveaxis(points, 0, 1)
    scratch = np.empty((2, sectors, contacts * waves * width))
    return Modes(
        np.ascontiguousarray(to_modes),
        np.ascontiguousarray(to_points),
        blocks,
        np.ascontiguousarray(points.reshape(sectors * contacts, rows)),
        np.arange(sectors * contacts * waves).reshape(sectors * contacts, waves),
        scratch[0],
        scratch[1],
    )


@operator(Modes)
@kernel
def apply_modes(modes: Modes, number: int, field: np.ndarray, image: np.ndarray) -> None:
    """Fill `image` with an operator applied to `field`, see operators.operator."""
    sectors, waves, _ = modes.to_modes.shape
    contacts, amplitudes, images = len(modes.points) // sectors, modes.amplitudes, modes.images
    width = amplitudes.shape[1] // (contacts * waves)
    source, target = field.reshape(-1, width), image.reshape(-1, width)
    between, beyond = amplitudes.reshape(-1, width), images.reshape(-1, width)
    for part in range(sectors * contacts):
        matrix = modes.to_modes[part // contacts]
        combine(matrix, source, modes.points[part], between, modes.waves[part])
    if sectors == 2:
        multiply_rows(Matrices(modes.blocks), number, amplitudes, images)
    else:
        multiply_pairs(Matrices(modes.blocks), number, amplitudes, images)
    for part in range(sectors * contacts):
        matrix = modes.to_points[part // contacts]
        combine(matrix, beyond, modes.waves[part], target, modes.points[part])


@kernel
def combine(
    matrix: np.ndarray,
    source: np.ndarray,
    columns: np.ndarray,
    target: np.ndarray,
    rows: np.ndarray,
) -> None:
    """Set target[rows] = matrix source[columns]; both arrays have the shape (..., width)."""
    width = source.shape[1]
    for after in range(0, len(rows), 2):
        one = min(after, len(rows) - 2)  # two rows at a time; the last two can be computed twice
        first, second = matrix[one], matrix[one + 1]
        for chunk in range(-(-width // LANES)):
            at = start(chunk, width)
            a = b = c = d = e = f = g = h = NOTHING
            for k in range(len(columns)):
                x, y, values = first[k], second[k], source[columns[k], at : at + LANES]
                m = four(values, 0)
                a, e = plus_multiple(a, m, x), plus_multiple(e, m, y)
                m = four(values, 4)
                b, f = plus_multiple(b, m, x), plus_multiple(f, m, y)
                m = four(values, 8)
                c, g = plus_multiple(c, m, x), plus_multiple(g, m, y)
                m = four(values, 12)
                d, h = plus_multiple(d, m, x), plus_multiple(h, m, y)
            put(target[rows[one], at : at + LANES], a, b, c, d)
            put(target[rows[one + 1], at : at + LANES], e, f, g, h)


@kernel
def multiply_pairs(operators: Matrices, number: int, field: np.ndarray, image: np.ndarray) -> None:
    """Set image[0, row] = matrix[row] field[0, row].  This is operators.multiply_rows for one
    component."""
    _, rows, chunks, columns, _ = operators.blocks.shape
    width = field.shape[1] // rows
    for row in range(rows):
        blocks, at = operators.blocks[number, row], row * width
        values = field[0, at:]
        for chunk in range(chunks):
            a = b = c = d = NOTHING
            for k in range(columns):
                x, m = values[k], blocks[chunk, k]
                a, b = plus_multiple(a, four(m, 0), x), plus_multiple(b, four(m, 4), x)
                c, d = plus_multiple(c, four(m, 8), x), plus_multiple(d, four(m, 12), x)
            first = at + start(chunk, width)
            put(image[0, first : first + LANES], a, b, c, d)


WHOLE, ROTATION, TRANSLATION = "whole disc", "mirror image", "half turn"
"""Symmetry by which the tractions on half of the disc determine those on the other half.  WHOLE
means that there is no such symmetry."""


def _single_waves(
    theta: np.ndarray, angles: int, symmetry: str
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Waves at nu = 0: their numbers m, and their forward and lateral values, (waves, points).

    For a rotation, forward tractions are cosines and lateral tractions are sines.  For a
    translation, both are cosines and sines with even numbers m.
    """
    numbers = np.arange(angles + 1)
    cosines, sines = np.cos(np.outer(numbers, theta)), np.sin(np.outer(numbers, theta))
    cosines[angles] = 0.0  # its exact value at the points
    if symmetry == ROTATION:
        return numbers, cosines, sines
    step = 2 if symmetry == TRANSLATION else 1
    numbers = np.concatenate([numbers[:angles:step], numbers[step::step]])
    waves = np.concatenate([cosines[:angles:step], sines[step::step]])
    return numbers, waves, waves


def _pairs(angles: int, symmetry: str) -> tuple[list[tuple[Wave, Wave]], list[tuple[Wave, Wave]]]:
    """Pairs of waves at nu > 0: first the coupled pairs, then the pairs without coupling.

    A wave is (m, part): part 0 is e^{i m theta}, and part 1 is i e^{i m theta}.  The shortest waves
    of a whole disc or of a rotation are not coupled, because their cosine is 0 at all points.
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
    """Matrices (pairs, 2, n, 2, n) of coupled pairs and of pairs without coupling."""
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


def _modes_to_average(angles: int) -> int:
    """Number of modes with averaged kernels, at least angles + 1; see SHARED_MODES."""
    return next((most for most in SHARED_MODES if angles < most), angles + 1)


@lru_cache(maxsize=4)
def _shared_influence(
    psi: tuple[float, ...], n_modes: int, coupled: bool, modulus: float
) -> tuple[np.ndarray, np.ndarray]:
    """Influence matrices of modes on rings with the edges `psi`, see ring_influence."""
    return ring_influence(np.array(psi), n_modes, coupled, modulus=modulus)


def influence_modes(
    rings: Rings, angles: int, symmetry: str, poisson: float, modulus: float, width: int
) -> tuple[Modes, np.ndarray]:
    """Create the operator A and its resolvents for points on rings, and the self-influence of each
    ring.

    Parameters
    ----------
    rings : mesh.Rings
        Mesh of N rings.
    angles : int
        Number of points on half of each ring.
    symmetry : str
        WHOLE, ROTATION or TRANSLATION.
    poisson, modulus : float
        Poisson's ratio, and G* in working units.
    width : int
        Number of columns of a field, at least N.

    Returns
    -------
    operators : Modes
        The operators, for one contact.
    scale : np.ndarray, shape (N,)
        Mean displacement of each ring under a unit traction on the same ring.
    """
    kappa, n = poisson / (2.0 - poisson), len(rings.bound)
    influence = near, _ = _shared_influence(
        tuple(rings.psi), _modes_to_average(angles), poisson > 0.0, modulus
    )
    scale = np.ascontiguousarray(np.diag(near[0]))
    points = 2 * angles if symmetry == WHOLE else angles
    theta = (np.arange(points) + 0.5) * np.pi / angles
    shifts = PENALTIES[:, None] * best_penalty(scale, n)
    if kappa == 0.0:
        numbers, forward, lateral = _single_waves(theta, angles, symmetry)
        to_points = np.stack([forward.T, lateral.T])
        matrices, columns = near[numbers], width
    else:
        pairs, single = _pairs(angles, symmetry)
        ratio = rings.area[:, None] / rings.area[None, :]  # weights of the transpose
        matrices = _coupled_matrices(pairs, single, influence, ratio, kappa)
        matrices = matrices.reshape(-1, 2 * n, 2 * n)
        waves = [wave for pair in (*pairs, *single) for wave in pair]
        values = np.array([1j**part * np.exp(1j * m * theta) for m, part in waves])
        values.real[
            np.array([m == angles and symmetry != TRANSLATION and part == 0 for m, part in waves])
        ] = 0.0
        to_points = np.concatenate([values.real, -values.imag], axis=1).T[None]
        shifts, columns = np.tile(shifts, 2), 2 * width
    diagonals = shifts[:, None, :, None] * np.eye(shifts.shape[1])
    stacked = np.concatenate([matrices[None], np.linalg.inv(matrices + diagonals)])
    if kappa != 0.0:
        padded = np.zeros((*stacked.shape[:2], 2, width, 2, width))
        padded[:, :, :, :n, :, :n] = stacked.reshape(*stacked.shape[:2], 2, n, 2, n)
        stacked = padded.reshape(*stacked.shape[:2], columns, columns)
    to_modes = np.linalg.pinv(to_points)
    return modes_of(to_modes, to_points, packed(stacked, columns), 1, width), scale
