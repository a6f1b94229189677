"""The influence operator on rings x angles, cut into the pieces that symmetry keeps apart.

Points sit on half the disc at theta_j = (j + 1/2) pi / M.  The mirror theta -> pi - theta maps them
onto themselves and commutes with the operator, so *folded* tractions, the parts that are even and
odd under it on the first M/2 angles, split into sectors that do not see each other: even forward
with odd lateral and the reverse, and at nu = 0 all four by themselves.  Each sector is applied as
one dense matrix while that is small, through its angular modes otherwise.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from microslip.contacts.operators import operator
from microslip.foundation.compiled import kernel
from microslip.models.polar.folding import fold, unfold
from microslip.models.polar.symmetry import waves
from microslip.models.rings.influence import ring_influence
from microslip.models.rings.mesh import Focus, make_rings
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Pressure

FUSED = {"fastmath": {"contract"}}
"""Allows fused multiply-add, which keeps the order of operations."""
LARGEST_DENSE = 96
"""Unknowns in a sector up to which its dense matrix is faster than its modes."""

SHARED_MODES = (9, 17, 33)
"""Modes that kernels are averaged for together, so that runs at 4, 6 and 8 angles share them."""


class Sectors(NamedTuple):
    """An operator on folded tractions (4, M/2, N), or (8, M/2, N), for compiled code.

    Attributes
    ----------
    dense : np.ndarray, shape (sectors, n, n)
        Transposed sector matrices, or no sectors where the modes are used.
    to_modes, to_points : np.ndarray, shape (sectors, Z, Z)
        Between the folded angles of a sector and its modes.
    members : np.ndarray, shape (sectors, blocks, 2)
        Modes that a block couples; second -1 if single, first -1 if there is no such block.
    blocks : np.ndarray, shape (sectors, blocks, b N, b N)
        Transposed.
    """

    dense: np.ndarray
    to_modes: np.ndarray
    to_points: np.ndarray
    members: np.ndarray
    blocks: np.ndarray


@kernel(**FUSED)
def _add_columns(matrix, given, result):
    """result += matrix^T given, eight columns at a time (which the compiler vectorises)."""
    n = len(given)
    for j in range(0, n - 7, 8):
        a, b, c, d = given[j], given[j + 1], given[j + 2], given[j + 3]
        e, f, g, h = given[j + 4], given[j + 5], given[j + 6], given[j + 7]
        m = matrix[j : j + 8]
        for i in range(len(result)):
            one = m[0, i] * a + m[1, i] * b + m[2, i] * c + m[3, i] * d
            two = m[4, i] * e + m[5, i] * f + m[6, i] * g + m[7, i] * h
            result[i] += one + two
    for j in range(n - n % 8, n):
        a = given[j]
        for i in range(len(result)):
            result[i] += matrix[j, i] * a


@kernel(**FUSED)
def _transform(matrix, x, out):
    """out = matrix x for short rows of x; x, out: (Z, N)."""
    out[:] = 0.0
    for k in range(matrix.shape[0]):
        for j in range(matrix.shape[1]):
            a, source, target = matrix[k, j], x[j], out[k]
            for i in range(len(target)):
                target[i] += a * source[i]


@kernel(**FUSED)
def apply_sectors(sectors: Sectors, x: np.ndarray, out: np.ndarray) -> None:
    """Apply an operator to folded tractions x, all (4, M/2, N) or (8, M/2, N)."""
    dense, to_modes, to_points, members, blocks = sectors
    n = x.shape[2]
    out[:] = 0.0
    if dense.shape[0] > 0:
        given = x.reshape(dense.shape[0], dense.shape[1])
        result = out.reshape(dense.shape[0], dense.shape[1])
        for s in range(dense.shape[0]):
            _add_columns(dense[s], given[s], result[s])
        return
    count, z = to_modes.shape[0], to_modes.shape[1]
    given, result = x.reshape(count, z, n), out.reshape(count, z, n)
    modes, images = np.empty((z, n)), np.empty((z, n))
    for s in range(count):
        _transform(to_modes[s], given[s], modes)
        images[:] = 0.0
        if blocks.shape[2] == n:
            for k in range(z):
                _add_columns(blocks[s, k], modes[k], images[k])
        else:
            _add_pairs(members[s], blocks[s], modes, images)
        _transform(to_points[s], images, result[s])


class Folded(NamedTuple):
    """An operator on fields, (2, M, N) or (2, 2 M, N) on a whole disc, by its sectors.

    Attributes
    ----------
    sectors : Sectors
        On folded tractions.
    folded, image : np.ndarray, shape (4, M/2, N) or (8, M/2, N)
        Scratch.
    """

    sectors: Sectors
    folded: np.ndarray
    image: np.ndarray


@operator(Folded)
@kernel
def apply_folded(folded: Folded, field: np.ndarray, image: np.ndarray) -> None:
    """image = operator field."""
    fold(field, folded.folded)
    apply_sectors(folded.sectors, folded.folded, folded.image)
    unfold(folded.image, image)


@kernel
def _add_pairs(members, blocks, modes, images):
    """Apply the blocks of coupled modes."""
    n = modes.shape[1]
    pair, image = np.zeros(2 * n), np.empty(2 * n)
    for k in range(members.shape[0]):
        first, second = members[k]
        if first < 0:
            continue
        for i in range(n):
            pair[i] = modes[first, i]
            pair[n + i] = modes[second, i] if second >= 0 else 0.0
        image[:] = 0.0
        _add_columns(blocks[k], pair, image)
        for i in range(n):
            images[first, i] += image[i]
            if second >= 0:
                images[second, i] += image[n + i]


def _mode_blocks(keys, near, far, kappa, ratio):
    """Members and influence blocks of the modes `keys` (nu > 0: m and 2 - m together)."""
    index = {key: k for k, key in enumerate(keys)}
    members, blocks = [], []
    for k, (m, part) in enumerate(keys):
        partner = index.get((2 - m, part)) if kappa != 0.0 and part < 2 else None
        sign = -kappa if part == 0 else kappa
        if partner is None:
            members.append((k, -1))
            blocks.append(near[abs(m)])
        elif partner == k:
            members.append((k, -1))
            blocks.append(near[1] + 0.5 * sign * (far[0] + far[0].T * ratio.T))
        elif m > 2 - m:
            members.append((k, partner))
            cross = sign * far[m - 1]
            blocks.append(np.block([[near[m], cross], [cross.T * ratio.T, near[abs(2 - m)]]]))
    return members, blocks


def _modes_to_know(angles):
    """Modes to average the kernels for: those of more angles too, as runs differ in these alone."""
    return next((most for most in SHARED_MODES if angles < most), angles + 1)


@lru_cache(maxsize=4)
def _shared_influence(psi, n_modes, coupled, modulus):
    """Mode matrices of rings with the edges `psi`, see ring_influence."""
    return ring_influence(np.array(psi), n_modes, coupled, modulus=modulus)


@lru_cache
def _transforms(angles, rotates, coupled):
    """Keys of the modes of every sector, and their values at the points and the inverse of these,
    (sectors, Z, Z) each."""
    groups = waves(angles, rotates, coupled)
    z = len(groups[0])
    to_points = np.zeros((len(groups), z, z))
    for s, group in enumerate(groups):
        rows = [part for part in range(4) if any(wave[part].any() for _, wave in group)]
        to_points[s] = np.stack([wave[rows].ravel() for _, wave in group], axis=1)
    keys = [[key for key, _ in group] for group in groups]
    return keys, to_points, np.linalg.inv(to_points)


@lru_cache(maxsize=32)
def influence_sectors(
    cells: int,
    angles: int,
    rotates: bool,
    poisson: float,
    focus: Focus | float | None,
    pressure: Pressure = HERTZ,
    *,
    whole: bool = False,
) -> tuple[Sectors, np.ndarray]:
    """The operator (a Sectors that keeps its modes) and the self-influence of each ring (N,).

    whole: on a whole disc, of twice as many angles.
    """
    kappa = poisson / (2.0 - poisson)
    rings = make_rings(cells, focus, pressure)
    near, far = _shared_influence(
        tuple(rings.psi), _modes_to_know(angles), poisson > 0.0, pressure.G_star
    )
    ratio = rings.area[:, None] / rings.area[None, :]  # the transpose in the area-weighted product
    groups, to_points, to_modes = _transforms(angles, rotates or whole, poisson > 0.0)
    found = [_mode_blocks(keys, near, far, kappa, ratio) for keys in groups]
    if whole:
        found += [_mode_blocks(keys, near, far, -kappa, ratio) for keys in groups]
        groups = 2 * groups
        to_points, to_modes = (np.tile(one, (2, 1, 1)) for one in (to_points, to_modes))
    most = max(len(members) for members, _ in found)
    size = max(len(block) for _, blocks in found for block in blocks)
    members = np.full((len(groups), most, 2), -1)
    packed = np.zeros((len(groups), most, size, size))
    for s, (pairs, blocks) in enumerate(found):
        members[s, : len(pairs)] = pairs
        for k, block in enumerate(blocks):
            packed[s, k, : len(block), : len(block)] = block.T
    none = np.zeros((0, 0, 0))
    return Sectors(none, to_modes, to_points, members, packed), np.ascontiguousarray(
        np.diag(near[0])
    )


def shifted_inverse(operator: Sectors, shift: np.ndarray) -> Sectors:
    """(A + shift)^-1 of an operator that keeps its modes; shift: one number for each ring, (N,)."""
    blocks, n = np.zeros_like(operator.blocks), len(shift)
    for s, pairs in enumerate(operator.members):
        for k, (first, second) in enumerate(pairs):
            size = 0 if first < 0 else n if second < 0 else 2 * n
            added = np.diag(np.tile(shift, size // n))
            blocks[s, k, :size, :size] = np.linalg.inv(operator.blocks[s, k, :size, :size] + added)
    return operator._replace(blocks=blocks)


def scaled(operator: Sectors, factor: float) -> Sectors:
    """The operator times a number."""
    return operator._replace(dense=operator.dense * factor, blocks=operator.blocks * factor)


def quickest(operator: Sectors) -> Sectors:
    """The same operator in the form that is applied fastest at its size."""
    sectors, z = operator.to_modes.shape[:2]
    rings = operator.blocks.shape[2] // (1 if (operator.members[:, :, 1] < 0).all() else 2)
    if z * rings > LARGEST_DENSE:
        return operator
    dense = np.empty((sectors, z * rings, z * rings))
    _columns(operator, np.zeros((4, sectors * z // 4, rings)), dense)
    return operator._replace(dense=dense)


@kernel
def _columns(operator, unit, dense):
    """Fill dense, (sectors, n, n), with the images of unit tractions; unit: zeros, folded."""
    image = np.empty_like(unit)
    flat, images = unit.reshape(dense.shape[:2]), image.reshape(dense.shape[:2])
    for s in range(dense.shape[0]):
        for j in range(dense.shape[1]):
            flat[s, j] = 1.0
            apply_sectors(operator, unit, image)
            flat[s, j] = 0.0
            for i in range(dense.shape[2]):  # an assignment of rows takes seconds to compile
                dense[s, j, i] = images[s, i]
