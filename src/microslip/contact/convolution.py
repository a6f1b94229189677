"""Compiled code for contacts of equal rectangular cells: convolution and Coulomb steps.

The convolution gives the surface displacement due to tractions.

Along an axis with n cells, the cell j has the coordinate x = j - (n - 1) / 2.  A field is a sum of
cosines and sines of 2 pi k x / (2 n - 1) for k = 0 .. n - 1.  This period is long enough that the
convolution does not wrap around.  The influence of tractions on displacements in the same direction
(forward or lateral) is even along both axes.  This influence multiplies each wave by a number.  The
influence of forward tractions on lateral displacements, and of lateral tractions on forward
displacements, is odd along both axes.  This influence multiplies each wave by a number, and
exchanges cosine and sine.

If a symmetry determines the field at negative forward coordinates, only the cells with positive
forward coordinates are resolved.  Each wave along the lateral axis is then either even or odd along
the forward axis:

- TURN is the symmetry of translations.  A half turn leaves a field unchanged.  Therefore, a field
  has the same parity along both axes.  A quarter of the cells is sufficient if fields are even
  along both axes.
- MIRROR is the symmetry of rotations.  Forward components are even along the forward axis, and
  lateral components are odd along this axis.

The waves are evaluated by matrix products, which are faster than fast Fourier transforms for up to
about 64 cells along a side.

The Coulomb steps are solved by a spectral projected gradient method, because no cheap resolvent is
available for equal cells.  The unknowns are tractions q with |q| <= g.  The slip b - A q occurs
only where |q| = g, in the direction of q.  Gradient steps have Barzilai-Borwein lengths.  There is
no line search, because rounding errors of the energy are much larger than those of the tractions.
If the residual does not decrease for a number of iterations, shorter steps are used until it
decreases; these steps lower the energy in every iteration.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from microslip.contact.operators import padded, shrink, transform
from microslip.contact.splitting import BETWEEN_LOOKS, interrupted
from microslip.foundation.compiled import kernel
from microslip.theory.hertz import G_STAR

TURN, MIRROR = "half turn", "mirror image"
"""Possible symmetries of a field."""


class Convolution(NamedTuple):
    """Matrices of the convolution on R x C resolved cells.

    Along the lateral axis, there are W waves for each parity. The last waves are padding.  The
    number of parities P is 1 if only cells with positive coordinates are resolved, and 2 otherwise.
    Along the forward axis, there are F waves.  F is 2 n if both parities occur, and n otherwise.

    Attributes
    ----------
    columns, columns_back : np.ndarray, shapes (C, P W) and (P W, C)
        Waves along the lateral axis.  The second array is padded along its last axis.
    rows, rows_back : np.ndarray, shapes (2, P, F, R) and (2, P, R, F)
        Waves along the forward axis, for each component and each lateral parity.
    direct : np.ndarray, shape (2, F, W)
        Factor by which a wave of tractions is multiplied to obtain the displacements in the same
        direction.
    cross : np.ndarray, shape (P, F, W)
        Factor by which a wave of forward tractions is multiplied to obtain the lateral
        displacements, which have the opposite parities, and vice versa.
    shift : int
        Difference of the indices of two forward waves with the same frequency and different
        parities.
    """

    columns: np.ndarray
    columns_back: np.ndarray
    rows: np.ndarray
    rows_back: np.ndarray
    direct: np.ndarray
    cross: np.ndarray
    shift: int


@lru_cache(maxsize=8)
def square_convolution(
    cells: int,
    poisson: float,
    modulus: float = G_STAR,
    images: int = 1,
    symmetry: str = TURN,
    half_widths: tuple[float, float] = (1.0, 1.0),
) -> tuple[Convolution, float, float]:
    """Create the convolution on a rectangle of equal cells.  The number of cells along each side is
    `cells`.

    Parameters
    ----------
    cells : int
        Number of cells along a side; it must be even if `images` is 2 or 4.
    poisson, modulus : float
        Poisson's ratio, and G* in working units.
    images : int
        Number of cells of the whole rectangle for each resolved cell.  With 4 (nu = 0 only), fields
        are even along both axes, and only cells with positive coordinates are resolved.  With 2,
        fields have the symmetry given by `symmetry`, and only cells with a positive forward
        coordinate are resolved.
    symmetry : str
        Symmetry of the fields if `images` is 2: TURN or MIRROR.
    half_widths : tuple of float
        Half the forward width and half the lateral width of the rectangle.

    Returns
    -------
    convolution : Convolution
        Matrices of the compiled convolution.
    scale : float
        Displacement of a cell due to a unit traction on the same cell, in u_lim.
    largest : float
        Upper bound on the eigenvalues of the convolution, in u_lim per unit of traction.
    """
    period, width = 2 * cells - 1, padded(cells)
    waves = np.arange(cells)
    angles = 2.0 * np.pi / period * np.outer(waves, waves - 0.5 * (cells - 1))
    every = np.stack([np.cos(angles), np.sin(angles)])
    ahead = every[..., cells // 2 :]
    # waves along the lateral axis, with the axes parities, waves and cells
    lateral = every if images < 4 else ahead[:1]
    wide = np.zeros((lateral.shape[2], len(lateral), width))
    wide[..., :cells] = np.moveaxis(lateral, 2, 0)
    columns = wide.reshape(len(wide), -1)
    back = np.zeros((columns.shape[1], padded(len(columns))))
    back[:, : len(columns)] = columns.T
    if images == 1:
        rows = np.broadcast_to(every.reshape(-1, cells), (2, 2, 2 * cells, cells))
    elif images == 2 and symmetry == MIRROR:
        rows = np.repeat(ahead[:, None], 2, axis=1)
    else:
        rows = np.stack([ahead[: len(lateral)]] * 2)
    normal, conjugate = influence(cells, period, poisson, modulus, half_widths)
    parts = np.fft.fft2([normal - conjugate.real, normal + conjugate.real, -conjugate.imag])
    spectrum = parts.real[:, :cells, :cells]
    largest = np.abs(spectrum[:2]).max() + np.abs(spectrum[2]).max()
    share = np.where(waves > 0, 2.0, 1.0) / period
    factors = np.zeros((3, cells, width))
    factors[..., :cells] = images * share[:, None] * share * spectrum
    # the sign is 1 if a wave of forward tractions has equal parities along both axes
    cross = np.stack([factors[2], factors[2] if symmetry == TURN else -factors[2]])[: len(lateral)]
    if images == 1:
        cross = np.stack([[factors[2], -factors[2]], [-factors[2], factors[2]]])
        factors = np.stack([factors, factors], axis=1)
    convolution = Convolution(
        columns,
        back,
        np.ascontiguousarray(rows),
        np.ascontiguousarray(np.swapaxes(rows, 2, 3)),
        factors[:2].reshape(2, -1, width),
        cross.reshape(len(lateral), -1, width),
        cells if images == 1 else 0,
    )
    return convolution, float(normal[0, 0]), float(largest)


def influence(
    cells: int,
    padded: int,
    poisson: float,
    modulus: float = G_STAR,
    half_widths: tuple[float, float] = (1.0, 1.0),
) -> tuple[np.ndarray, np.ndarray]:
    """Compute the influence coefficients for the traction and for its complex conjugate.

    The result is two arrays of shape (P, P), where P is `padded`.  Their unit is u_lim per unit of
    traction.  The first axis of both arrays is the forward offset between two cells, and the second
    axis is the lateral offset.  Negative offsets are wrapped around.  The complex traction is
    lateral + i forward.  The kernels of influence.py are integrated over a cell in closed form.
    The integrals are evaluated at the centres of cells.
    """
    forward, lateral = (2.0 * half_width / cells for half_width in half_widths)
    offsets = np.fft.fftfreq(padded, 1.0 / padded)
    y, x = np.meshgrid(forward * offsets, lateral * offsets, indexing="ij")
    single, squares, product = np.zeros((3, *x.shape))
    for sx in (1, -1):
        for sy in (1, -1):
            u, v = x + sx * lateral / 2, y + sy * forward / 2
            r = np.hypot(u, v)
            log_u, log_v = np.arcsinh(u / np.abs(v)), np.arcsinh(v / np.abs(u))
            # sign(v) v arcsinh(u/|v|) equals v ln(u + r), except for terms that cancel in the sum
            single = single + sx * sy * (u * log_v + v * log_u)
            squares = squares + sx * sy * (v * log_u - u * log_v)
            product = product - sx * sy * r
    scale = 1.0 / (np.pi * modulus)
    kappa = poisson / (2.0 - poisson)
    return scale * single, scale * kappa * (squares + 2j * product)


def workspace(operator: Convolution) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Create the scratch arrays of `convolve`, for use by a single thread."""
    components, parities, waves, rows = operator.rows.shape
    width = operator.direct.shape[2]
    return (
        np.empty((rows, parities * width)),
        np.empty((components, parities, waves, width)),
        np.empty((rows, operator.columns_back.shape[1])),
    )


@kernel
def convolve(operator: Convolution, scratch: tuple, q: np.ndarray, out: np.ndarray) -> None:
    """Fill `out` with A q.

    q, out: forward and lateral components on the resolved cells, as arrays of shape (2, rows,
    columns).  scratch: arrays from `workspace`.
    """
    lateral, spectrum, image = scratch
    _, parities, waves, _ = operator.rows.shape
    of_parity = lateral.reshape(parities * lateral.shape[0], -1)
    for c in range(2):
        transform(q[c], operator.columns, (0, 1), lateral, (0, 1))
        for p in range(parities):
            transform(operator.rows[c, p], of_parity, (p, parities), spectrum[c, p], (0, 1))
    ahead, aside = operator.direct
    for p in range(parities):
        for f in range(waves):
            g, factors = (f + operator.shift) % waves, operator.cross[p, f]
            first, second = spectrum[0, p, f], spectrum[1, parities - 1 - p, g]
            for k in range(len(first)):
                x, y = first[k], second[k]
                first[k] = ahead[f, k] * x + factors[k] * y
                second[k] = aside[g, k] * y + factors[k] * x
    for c in range(2):
        for p in range(parities):
            transform(operator.rows_back[c, p], spectrum[c, p], (0, 1), of_parity, (p, parities))
        transform(lateral, operator.columns_back, (0, 1), image, (0, 1))
        for row in range(q.shape[1]):
            for column in range(q.shape[2]):
                out[c, row, column] = image[row, column]


MOST_ITERATIONS = 5000
"""Largest number of iterations of a step."""
PATIENCE = 60
"""Barzilai-Borwein steps must halve the residual within this number of iterations.  The value is
calibrated by benchmarks/splitting.py."""
SHORT_STEP_BELOW = 0.3
"""The shorter Barzilai-Borwein length is used if its ratio to the longer length is below this
value.  Usual values are 0.1 to 0.5 (Zhou, Gao and Dai 2006)."""


@kernel
def descend(
    convolution: Convolution,
    cell: tuple[float, float, float],
    fields: tuple,
    scratch: tuple,
    control: tuple[float, float, int],
) -> tuple[int, float, float]:
    """Solve a Coulomb step on equal cells.

    Parameters
    ----------
    convolution : Convolution
        The operator A.
    cell : tuple of float
        Area of a cell, displacement of a cell due to a unit traction on the same cell, and upper
        bound on the eigenvalues of A.
    fields : tuple of np.ndarray, shapes (rows, columns) and (2, rows, columns)
        Four arrays: the friction bound; the imposed displacement b; the tractions, which contain
        the initial guess on entry and the solution, within the bound, on return; and the slip,
        which is an output.
    scratch : tuple of np.ndarray
        Arrays from `workspace`, and an array of shape (4, rows, columns).
    control : tuple
        Length of the first gradient step; largest allowed residual, as a force divided by mu F_z;
        patience, see PATIENCE.

    Returns
    -------
    iterations : int
        Number of iterations; -1 after an interrupt.
    residual, length : float
        Residual as defined by contact.coulomb_residual, and length of the last gradient step.
    """
    weight, scale, largest = cell
    bound, b, q, slip = fields
    length, tolerance, patience = control
    room, values = scratch
    trial, elastic = values[:2], values[2:]
    rows, columns = bound.shape
    sums = np.empty((3, columns))  # one sum for each column, so that the compiler can vectorise
    for i in range(rows):
        for j in range(columns):
            f = shrink(q[0, i, j], q[1, i, j], bound[i, j])
            trial[0, i, j], trial[1, i, j] = f * q[0, i, j], f * q[1, i, j]
            q[0, i, j], q[1, i, j] = trial[0, i, j], trial[1, i, j]
    between = int(BETWEEN_LOOKS / (rows * columns)) + 1
    best, best_at, residual = np.inf, 0, np.inf
    for iteration in range(MOST_ITERATIONS):
        convolve(convolution, room, trial, elastic)
        sums[:] = 0.0
        for c in range(2):
            for i in range(rows):
                for j in range(columns):
                    dq = trial[c, i, j] - q[c, i, j]
                    now = b[c, i, j] - elastic[c, i, j]
                    ds = slip[c, i, j] - now if bound[i, j] > 0.0 else 0.0
                    sums[0, j] += dq * dq
                    sums[1, j] += dq * ds
                    sums[2, j] += ds * ds
                    q[c, i, j], slip[c, i, j] = trial[c, i, j], now
        dd, ds, ss = sums[0].sum(), sums[1].sum(), sums[2].sum()
        if iteration > 0:
            if iteration - best_at > patience or not ds > 0.0:
                length = 1.0 / largest
            elif ds * ds < SHORT_STEP_BELOW * dd * ss:
                length = ds / ss
            else:
                length = dd / ds
        sums[0] = 0.0
        for i in range(rows):
            for j in range(columns):
                forward, lateral = (
                    q[0, i, j] + length * slip[0, i, j],
                    q[1, i, j] + length * slip[1, i, j],
                )
                f = shrink(forward, lateral, bound[i, j])
                trial[0, i, j], trial[1, i, j] = f * forward, f * lateral
                forward, lateral = (
                    q[0, i, j] + slip[0, i, j] / scale,
                    q[1, i, j] + slip[1, i, j] / scale,
                )
                f = shrink(forward, lateral, bound[i, j])
                forward, lateral = f * forward - q[0, i, j], f * lateral - q[1, i, j]
                sums[0, j] += np.sqrt(forward * forward + lateral * lateral)
        residual = weight * sums[0].sum()
        if residual <= tolerance:
            return iteration, residual, length
        if residual < 0.5 * best:
            best, best_at = residual, iteration
        if iteration % between == between - 1 and interrupted():
            return -1, residual, length
    return MOST_ITERATIONS, residual, length
