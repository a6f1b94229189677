"""Square cells with FFT convolution: any nu, any outline; the general reference, and the paper's
own method.

The convolution is made linear by zero-padding to twice the size.  A step is solved by a projected
gradient method with Barzilai-Borwein steps and an exact line search along the feasible direction,
so the energy falls in every iteration.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numba import njit
from scipy import fft
from scipy.integrate import quad

from microslip.friction import JIT, shrink
from microslip.hertz import G_STAR
from microslip.models import contact

MAX_ITERATIONS = 3000


class CartesianContact:
    """``cells`` x ``cells`` squares over the circumscribed square of the contact.

    States: (2, cells, cells), axis 1 along the forward axis, axis 2 along the lateral one.  Cells
    that the edge cuts carry the load of their part inside.
    """

    has_sensitivity = False
    has_memory = True
    angles = 1

    def __init__(self, cells, poisson=0.0):
        if cells < 2:
            raise ValueError(f"cells = {cells}: allowed is a whole number of at least 2")
        self.size = 2.0 / cells
        centres = (np.arange(cells) + 0.5) * self.size - 1.0
        self.forward_position, self.lateral_position = np.meshgrid(centres, centres, indexing="ij")
        self.weight = np.full((cells, cells), self.size**2)
        self.bound = _cell_loads(cells) / self.size**2
        self.kernel, self.cross, diagonal = _kernels(cells, poisson)
        self.compliance = np.full((cells, cells), diagonal)

    def displacement(self, state):
        """A q; shapes (2, cells, cells)."""
        return _parts(self._convolve(state[1] + 1j * state[0]))

    def _convolve(self, q):
        """Displacement of complex tractions q = lateral + i forward, (cells, cells)."""
        n = q.shape[0]
        padded = fft.fft2(q, (2 * n, 2 * n))
        out = self.kernel * padded
        if self.cross is not None:
            out += self.cross * fft.fft2(q.conj(), (2 * n, 2 * n))
        return fft.ifft2(out)[:n, :n]

    def mirrored(self, state):
        """Lateral axis reversed, lateral traction negated."""
        return state[:, :, ::-1] * np.array([1.0, -1.0])[:, None, None]

    def march(self, path, state, tolerance, sensitivity=False):
        """March along ``path``; see models.contact.Contact."""
        n_stages = path.stages.shape[1]
        q = (state[1] + 1j * state[0]).copy()
        origin = self._rigid(path.start)
        z = self._convolve(q) - origin
        forces = np.empty((path.steps + 1, 3))
        forces[0] = contact.forces(self, state)
        total, iterations = 0.0, 0
        slips = [None] * n_stages
        for k in range(path.steps):
            for s in range(n_stages):
                rigid = self._rigid(path.stages[k, s])
                b = z + rigid
                for j in range(s):
                    b = b - path.carry[s, j] * slips[j]
                count, residual, slips[s] = self.solve_step(b, q, tolerance)
                iterations += count
                total += residual
            z = b - slips[-1] - rigid
            forces[k + 1] = contact.forces(self, _parts(q))
        return contact.March(_parts(q), forces, total, iterations, path.steps * n_stages)

    def _rigid(self, motion):
        """Rigid displacement lateral + i forward for motion = (forward, lateral, angle)."""
        forward, lateral, angle = motion
        forward_part = forward + angle * self.lateral_position
        return lateral - angle * self.forward_position + 1j * forward_part

    def solve_step(self, b, q, tolerance):
        """Solve one Coulomb step, in place in q; b, q: complex (cells, cells).

        Returns (iterations, residual, slip).
        """
        slip = b - self._convolve(q)
        step = 1.0 / self.compliance[0, 0]
        direction = np.empty_like(q)
        for iteration in range(MAX_ITERATIONS):
            residual = _residual(q, slip, self.bound, self.size**2, self.compliance[0, 0])
            if residual <= tolerance:
                return iteration, residual, slip
            descent = _feasible_direction(q, slip, self.bound, step, direction)
            bent = self._convolve(direction)
            curvature = _dot(direction, bent)
            if not curvature > 0.0:
                break
            length = min(1.0, descent / curvature)
            _advance(q, slip, direction, bent, length)
            step = _dot(direction, direction) / curvature
        return MAX_ITERATIONS, residual, slip


def _parts(q):
    """Forward and lateral parts, (2, n, n), of q = lateral + i forward."""
    return np.stack([q.imag, q.real])


@njit(**JIT)
def _residual(q, slip, bound, weight, scale):
    total = 0.0
    for i in range(q.shape[0]):
        for j in range(q.shape[1]):
            if bound[i, j] > 0.0:
                p = q[i, j] + slip[i, j] / scale
                total += abs(p * shrink(p.real, p.imag, bound[i, j]) - q[i, j])
    return weight * total


@njit(**JIT)
def _feasible_direction(q, slip, bound, step, out):
    """out = P(q + step slip) - q; returns its product with the slip (the descent)."""
    descent = 0.0
    for i in range(q.shape[0]):
        for j in range(q.shape[1]):
            if bound[i, j] > 0.0:
                p = q[i, j] + step * slip[i, j]
                d = p * shrink(p.real, p.imag, bound[i, j]) - q[i, j]
                descent += d.real * slip[i, j].real + d.imag * slip[i, j].imag
            else:
                d = 0j
            out[i, j] = d
    return descent


@njit(**JIT)
def _dot(a, b):
    total = 0.0
    for i in range(a.shape[0]):
        for j in range(a.shape[1]):
            total += a[i, j].real * b[i, j].real + a[i, j].imag * b[i, j].imag
    return total


@njit(**JIT)
def _advance(q, slip, direction, bent, length):
    for i in range(q.shape[0]):
        for j in range(q.shape[1]):
            q[i, j] += length * direction[i, j]
            slip[i, j] -= length * bent[i, j]


@lru_cache(maxsize=8)
def _cell_loads(cells):
    """Friction bound integrated over each square, (cells, cells); sums to 1."""
    size = 2.0 / cells
    edges = np.arange(cells + 1) * size - 1.0
    # cumulative load of the quarter-planes x < x_i, y < y_j, then second differences
    cumulative = np.array([[_corner_load(x, y) for y in edges] for x in edges])
    loads = np.diff(np.diff(cumulative, axis=0), axis=1)
    loads = np.maximum(loads, 0.0)
    loads[loads < 1e-13] = 0.0
    return loads / loads.sum()


def _corner_load(x, y):
    """Load carried where the position is below (x, y) in both coordinates.

    Across y the Hertz bound integrates in closed form; along x numerically.
    """

    def below(t):
        chord = max(1.0 - t * t, 0.0)
        if chord == 0.0:
            return 0.0
        half = np.sqrt(chord)
        s = min(max(y / half, -1.0), 1.0)
        return 1.5 / np.pi * chord * 0.5 * (s * np.sqrt(1 - s * s) + np.arcsin(s) + np.pi / 2)

    if x <= -1.0 or y <= -1.0:
        return 0.0
    kinks = [t for t in (-np.sqrt(1 - y * y), np.sqrt(1 - y * y)) if -1.0 < t < x]
    return quad(below, -1.0, x, points=kinks or None, epsabs=1e-12, epsrel=1e-12, limit=200)[0]


@lru_cache(maxsize=8)
def _kernels(cells, poisson):
    """Transforms of the influence coefficients on the padded grid, and the self-influence.

    Closed forms of the kernels of halfspace.py integrated over a square, taken at cell centres.
    """
    size = 2.0 / cells
    offsets = fft.fftfreq(2 * cells, 1.0 / (2 * cells)) * size
    y, x = np.meshgrid(offsets, offsets, indexing="ij")
    single, squares, product = 0.0, 0.0, 0.0
    for sx in (1, -1):
        for sy in (1, -1):
            u, v = x + sx * size / 2, y + sy * size / 2
            r = np.hypot(u, v)
            log_u, log_v = np.arcsinh(u / np.abs(v)), np.arcsinh(v / np.abs(u))
            # sign(v) v arcsinh(u/|v|) is v ln(u + r) up to terms that cancel in the differences
            single = single + sx * sy * (u * log_v + v * log_u)
            squares = squares + sx * sy * (v * log_u - u * log_v)
            product = product - sx * sy * r
    scale = 1.0 / (np.pi * G_STAR)
    direct = scale * single
    kernel = fft.fft2(direct)
    cross = None
    if poisson > 0.0:
        kappa = poisson / (2.0 - poisson)
        cross = fft.fft2(scale * kappa * (squares + 2j * product))
    return kernel, cross, float(direct[0, 0])
