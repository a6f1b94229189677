"""Rings: exact for translation at nu = 0, where the traction vector depends on the radius alone.

A step is solved by a semismooth Newton method on the small dense system (unknown: both components
where a ring sticks, the angle of the traction where it slips), each iteration opened by one
projected Gauss-Seidel sweep that settles which is which.  Where a Newton step does not help,
over-relaxed sweeps take over, and these always converge.  The factorised matrices also carry the
derivative of the march with respect to its start, which makes the periodic state a Newton problem.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numba import njit

from microslip.friction import JIT, shrink
from microslip.halfspace import ring_influence
from microslip.models import contact
from microslip.rings import make_rings

MAX_ITERATIONS = 200
RESCUE_SWEEPS = 12
RESCUE_RELAXATION = 1.4


@njit(**JIT)
def _slip(influence, b, q, out):
    """out = b - A q for complex tractions q on rings."""
    for i in range(len(b)):
        total = b[i]
        for k in range(len(b)):
            total -= influence[i, k] * q[k]
        out[i] = total


@njit(**JIT)
def _residual(influence, q, slip, bound, weight):
    """friction.coulomb_residual for complex tractions on rings."""
    total = 0.0
    for i in range(len(q)):
        p = q[i] + slip[i] / influence[i, i]
        total += weight[i] * abs(p * shrink(p.real, p.imag, bound[i]) - q[i])
    return total


@njit(**JIT)
def _sweep(influence, bound, q, slip, relaxation):
    """One projected Gauss-Seidel sweep; keeps slip = b - A q up to date."""
    for i in range(len(q)):
        new = q[i] + relaxation * slip[i] / influence[i, i]
        new *= shrink(new.real, new.imag, bound[i])
        change = new - q[i]
        if change != 0.0:
            q[i] = new
            for k in range(len(q)):
                slip[k] -= influence[k, i] * change


@njit(**JIT)
def _free_directions(q, slip, bound, direction, ring):
    """Unit vectors along which tractions may change: two per sticking ring, the tangent of the
    bound per slipping ring.  Slipping tractions are put on the bound exactly.  Returns how many."""
    m = 0
    for i in range(len(q)):
        size = abs(q[i])
        along = q[i].real * slip[i].real + q[i].imag * slip[i].imag
        if size >= bound[i] * (1 - 1e-12) and along > 0.0:
            unit = q[i] / size
            q[i] = unit * bound[i]
            direction[m], ring[m] = 1j * unit, i
            m += 1
        else:
            direction[m], ring[m] = 1.0, i
            direction[m + 1], ring[m + 1] = 1j, i
            m += 2
    return m


@njit(**JIT)
def _factorise(influence, weight, bound, slip, direction, ring, m, matrix):
    """Cholesky factor of the tangent problem in the free directions; False if it breaks down."""
    for p in range(m):
        i = ring[p]
        for s in range(p + 1):
            k = ring[s]
            dot = direction[p].real * direction[s].real + direction[p].imag * direction[s].imag
            matrix[p, s] = weight[i] * influence[i, k] * dot
        alone = (p == 0 or ring[p - 1] != i) and (p == m - 1 or ring[p + 1] != i)
        if alone:  # a slipping ring: turning the traction also turns it away from the slip
            matrix[p, p] += weight[i] * abs(slip[i]) / bound[i]
    for j in range(m):
        total = matrix[j, j]
        for k in range(j):
            total -= matrix[j, k] * matrix[j, k]
        if not total > 0.0:
            return False
        pivot = np.sqrt(total)
        matrix[j, j] = pivot
        for i in range(j + 1, m):
            total = matrix[i, j]
            for k in range(j):
                total -= matrix[i, k] * matrix[j, k]
            matrix[i, j] = total / pivot
    return True


@njit(**JIT)
def _back_substitute(matrix, m, x):
    """Solve L L^T x = x in place for all columns of x (first m rows)."""
    columns = x.shape[1]
    for i in range(m):
        for k in range(i):
            factor = matrix[i, k]
            for c in range(columns):
                x[i, c] -= factor * x[k, c]
        factor = 1.0 / matrix[i, i]
        for c in range(columns):
            x[i, c] *= factor
    for i in range(m - 1, -1, -1):
        for k in range(i + 1, m):
            factor = matrix[k, i]
            for c in range(columns):
                x[i, c] -= factor * x[k, c]
        factor = 1.0 / matrix[i, i]
        for c in range(columns):
            x[i, c] *= factor


@njit(**JIT)
def solve_step(influence, b, bound, weight, q, slip, tolerance):
    """Solve one Coulomb step on rings in place.

    influence: (n, n); b: imposed displacement, complex (n,); q: start and result, complex (n,),
    within the bound; slip: receives b - A q.  Returns (iterations, residual); the caller compares
    the residual with the tolerance.
    """
    n = len(b)
    matrix = np.empty((2 * n, 2 * n))
    x = np.empty((2 * n, 1))
    direction = np.empty(2 * n, np.complex128)
    ring = np.empty(2 * n, np.int64)
    trial, trial_slip = np.empty_like(q), np.empty_like(q)
    _slip(influence, b, q, slip)
    residual = _residual(influence, q, slip, bound, weight)
    for iteration in range(MAX_ITERATIONS):
        if residual <= tolerance:
            return iteration, residual
        _sweep(influence, bound, q, slip, 1.0)
        m = _free_directions(q, slip, bound, direction, ring)
        _slip(influence, b, q, slip)
        residual = _residual(influence, q, slip, bound, weight)
        for p in range(m):
            i = ring[p]
            dot = direction[p].real * slip[i].real + direction[p].imag * slip[i].imag
            x[p, 0] = weight[i] * dot
        better = False
        if _factorise(influence, weight, bound, slip, direction, ring, m, matrix):
            _back_substitute(matrix, m, x)
            trial[:] = q
            for p in range(m):
                trial[ring[p]] += x[p, 0] * direction[p]
            for i in range(n):
                trial[i] *= shrink(trial[i].real, trial[i].imag, bound[i])
            _slip(influence, b, trial, trial_slip)
            trial_residual = _residual(influence, trial, trial_slip, bound, weight)
            better = trial_residual < residual
        if better:
            q[:] = trial
            slip[:] = trial_slip
            residual = trial_residual
        else:
            for _ in range(RESCUE_SWEEPS):
                _sweep(influence, bound, q, slip, RESCUE_RELAXATION)
            _slip(influence, b, q, slip)
            residual = _residual(influence, q, slip, bound, weight)
    return MAX_ITERATIONS, residual


@njit(**JIT)
def _carry_tangent(influence, weight, bound, q, slip, db, dq, adq, matrix, direction, ring):
    """Derivative of one solved step: dq/db applied to the columns of db; also A dq.

    db, dq, adq: (2 n, columns), rows: forward part of each ring, then lateral part.
    """
    n = len(q)
    m = _free_directions(q, slip, bound, direction, ring)
    _factorise(influence, weight, bound, slip, direction, ring, m, matrix)
    x = np.empty((m, db.shape[1]))
    for p in range(m):
        i = ring[p]
        along, across = weight[i] * direction[p].real, weight[i] * direction[p].imag
        for c in range(db.shape[1]):
            x[p, c] = along * db[i, c] + across * db[n + i, c]
    _back_substitute(matrix, m, x)
    dq[:] = 0.0
    for p in range(m):
        i = ring[p]
        along, across = direction[p].real, direction[p].imag
        for c in range(db.shape[1]):
            dq[i, c] += along * x[p, c]
            dq[n + i, c] += across * x[p, c]
    adq[:n] = np.dot(influence, dq[:n])
    adq[n:] = np.dot(influence, dq[n:])


@njit(**JIT)
def _march(influence, bound, weight, start, stages, carry, state, tolerance, tangent, forces):
    """March along a path; returns (state, residual sum, iterations, derivative or empty)."""
    n, n_stages = len(bound), stages.shape[1]
    q = state.copy()
    columns = 2 * n if tangent else 0
    dq, adq = np.zeros((2 * n, columns)), np.empty((2 * n, columns))
    dz, db = np.zeros((2 * n, columns)), np.empty((2 * n, columns))
    dslips = np.empty((n_stages, 2 * n, columns))
    if tangent:
        dz[:n, :n] = influence
        dz[n:, n:] = influence
    matrix = np.empty((2 * n, 2 * n))
    direction = np.empty(2 * n, np.complex128)
    ring = np.empty(2 * n, np.int64)
    slips = np.empty((n_stages, n), np.complex128)
    z = np.empty(n, np.complex128)
    origin = complex(start[0], start[1])
    b = np.full(n, 0j)
    _slip(influence, b, q, z)
    z[:] = -z - origin
    total = np.sum(weight * q)
    forces[0, 0], forces[0, 1] = total.real, total.imag
    worst, iterations = 0.0, 0
    for k in range(stages.shape[0]):
        for s in range(n_stages):
            rigid = complex(stages[k, s, 0], stages[k, s, 1])
            b[:] = z + rigid
            for j in range(s):
                b -= carry[s, j] * slips[j]
            count, residual = solve_step(influence, b, bound, weight, q, slips[s], tolerance)
            iterations += count
            worst += residual
            if tangent:
                db[:] = dz
                for j in range(s):
                    db -= carry[s, j] * dslips[j]
                _carry_tangent(
                    influence, weight, bound, q, slips[s], db, dq, adq, matrix, direction, ring
                )
                dslips[s] = db - adq
        z = b - slips[n_stages - 1] - rigid
        if tangent:
            dz[:] = adq
        total = np.sum(weight * q)
        forces[k + 1, 0], forces[k + 1, 1] = total.real, total.imag
    return q, worst, iterations, dq


class RadialContact:
    """Contact of ``cells`` rings (see models.contact.Contact); states have shape (2, 1, cells).

    influence: (cells, cells), mean ring tractions to ring-averaged displacements; bound, weight:
    friction bound and area of each ring.  ``resolved`` builds the half-space's; the elastic slider
    is the one-ring contact of unit compliance.
    """

    has_sensitivity = True
    has_memory = True
    angles = 1

    def __init__(self, influence, bound, weight):
        self.influence = np.ascontiguousarray(influence, dtype=float)
        self.bound, self.weight = bound, weight
        self.compliance = np.diag(self.influence)
        self.forward_position = self.lateral_position = np.zeros((1, len(bound)))

    @classmethod
    def resolved(cls, cells, focus=None):
        """The half-space on ``cells`` rings refined around the radius ``focus``."""
        rings = make_rings(cells, focus)
        return cls(_influence(cells, focus), rings.bound, rings.area)

    def displacement(self, state):
        """A q; shapes (2, 1, cells)."""
        return state @ self.influence.T

    def mirrored(self, state):
        """Lateral traction negated."""
        return state * np.array([1.0, -1.0])[:, None, None]

    def march(self, path, state, tolerance, sensitivity=False):
        """March along ``path`` (translations only); see models.contact.Contact."""
        forces = np.zeros((path.steps + 1, 3))
        q, residual, iterations, derivative = _march(
            self.influence,
            self.bound,
            self.weight,
            path.start,
            path.stages,
            path.carry,
            state[0, 0] + 1j * state[1, 0],
            tolerance,
            sensitivity,
            forces,
        )
        return contact.March(
            state=np.stack([q.real, q.imag])[:, None, :],
            forces=forces,
            residual=residual,
            iterations=iterations,
            solves=path.stages.shape[0] * path.stages.shape[1],
            sensitivity=derivative if sensitivity else None,
        )


@lru_cache(maxsize=64)
def _influence(cells, focus):
    near, _ = ring_influence(make_rings(cells, focus).psi, 1, False)
    return np.ascontiguousarray(near[0])
