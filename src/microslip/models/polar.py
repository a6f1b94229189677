"""Rings times angular modes: rotating scenes at any nu, translation at nu > 0.

Points sit on rings at angles theta_j = (j + 1/2) pi / M, theta from the lateral axis; the other
half of the disc follows from symmetry:

- scenes that rotate: mirror image across the lateral axis (forward traction even, lateral odd);
- translation: point symmetry, traction(-z) = traction(z), so even modes only.

Coulomb's law is asked for at the points; the elastic operator is block-diagonal in the angular
modes, one small ring matrix each (two modes m and 2 - m together where nu > 0).  A step is solved
by ADMM: the quadratic part through the blocks factorised once, the friction bound point by point.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numba import njit

from microslip.friction import JIT, coulomb_residual, shrink
from microslip.halfspace import ring_influence
from microslip.models import contact
from microslip.rings import make_rings

MAX_ITERATIONS = 4000
CHECK_EVERY = 4
PENALTY = 1.0
"""Augmentation over the self-influence of a ring; iterations double at half and at twice it."""
RELAXATION = 1.7


@njit(**JIT)
def apply_blocks(to_modes, to_points, members, blocks, x):
    """Operator given by its mode blocks, on flattened points.

    to_modes, to_points: (2 M, 2 M); members: coefficients of each block, (blocks, 2), second -1 if
    single; blocks: transposed, (blocks, b N, b N); x: (2 M, N).  Returns (2 M, N).
    """
    modes = np.dot(to_modes, x)
    out = np.zeros_like(modes)
    n = x.shape[1]
    for k in range(members.shape[0]):
        for source in range(2):
            if members[k, source] < 0:
                break
            given = modes[members[k, source]]
            for target in range(2):
                if members[k, target] < 0:
                    break
                result = out[members[k, target]]
                for j in range(n):
                    # column by column, which the compiler turns into vector instructions
                    column = blocks[k, source * n + j]
                    for i in range(n):
                        result[i] += column[target * n + i] * given[j]
    return np.dot(to_points, out)


@njit(**JIT)
def solve_step(operator, inverse, penalty, bound, weight, scale, b, q, dual, slip, tolerance):
    """Solve one Coulomb step by over-relaxed ADMM, in place.

    operator: (to_modes, to_points, members, blocks); inverse: blocks of (A + penalty)^-1; b: the
    imposed displacement (2, M, N); q: start and result, within the bound; dual: slip over penalty,
    kept from step to step; slip: receives b - A q.  Returns (iterations, residual).
    """
    to_modes, to_points, members, blocks = operator
    angles, n = q.shape[1], q.shape[2]
    flat_q, flat_slip = q.reshape(2 * angles, n), slip.reshape(2 * angles, n)
    flat_b, flat_dual = b.reshape(2 * angles, n), dual.reshape(2 * angles, n)
    flat_slip[:] = flat_b - apply_blocks(to_modes, to_points, members, blocks, flat_q)
    residual = coulomb_residual(q, slip, bound, weight, scale)
    iterations = 0
    while residual > tolerance and iterations < MAX_ITERATIONS:
        for _ in range(CHECK_EVERY):
            free = apply_blocks(
                to_modes, to_points, members, inverse, flat_b + penalty * (flat_q - flat_dual)
            )
            for j in range(angles):
                for i in range(n):
                    forward = RELAXATION * free[j, i] + (1 - RELAXATION) * q[0, j, i]
                    lateral = RELAXATION * free[angles + j, i] + (1 - RELAXATION) * q[1, j, i]
                    forward += dual[0, j, i]
                    lateral += dual[1, j, i]
                    f = shrink(forward, lateral, bound[i])
                    q[0, j, i] = f * forward
                    q[1, j, i] = f * lateral
                    dual[0, j, i] = forward - f * forward
                    dual[1, j, i] = lateral - f * lateral
        iterations += CHECK_EVERY
        flat_slip[:] = flat_b - apply_blocks(to_modes, to_points, members, blocks, flat_q)
        residual = coulomb_residual(q, slip, bound, weight, scale)
    return iterations, residual


@njit(**JIT)
def _rigid(motion, forward_position, lateral_position, out):
    """Rigid displacement of every point for motion = (forward, lateral, angle)."""
    for j in range(out.shape[1]):
        for i in range(out.shape[2]):
            out[0, j, i] = motion[0] + motion[2] * lateral_position[j, i]
            out[1, j, i] = motion[1] - motion[2] * forward_position[j, i]


@njit(**JIT)
def _forces(q, weight, forward_position, lateral_position, out):
    """Forward force, lateral force and torque of tractions q."""
    out[:] = 0.0
    for j in range(q.shape[1]):
        for i in range(q.shape[2]):
            forward, lateral = weight[i] * q[0, j, i], weight[i] * q[1, j, i]
            out[0] += forward
            out[1] += lateral
            out[2] += lateral_position[j, i] * forward - forward_position[j, i] * lateral


@njit(**JIT)
def _march(
    operator,
    inverse,
    penalty,
    bound,
    weight,
    scale,
    positions,
    start,
    stages,
    carry,
    state,
    tolerance,
    forces,
):
    """March along a path; returns (state, residual sum, iterations)."""
    to_modes, to_points, members, blocks = operator
    forward_position, lateral_position = positions
    angles, n = state.shape[1], state.shape[2]
    n_stages = stages.shape[1]
    q = state.copy()
    rigid = np.empty_like(q)
    slips = np.empty((n_stages, 2, angles, n))
    duals = np.zeros((n_stages, 2, angles, n))
    elastic = apply_blocks(to_modes, to_points, members, blocks, q.reshape(2 * angles, n))
    _rigid(start, forward_position, lateral_position, rigid)
    z = elastic.reshape(2, angles, n) - rigid
    _forces(q, weight, forward_position, lateral_position, forces[0])
    total, iterations = 0.0, 0
    b = np.empty_like(q)
    for k in range(stages.shape[0]):
        for s in range(n_stages):
            _rigid(stages[k, s], forward_position, lateral_position, rigid)
            b[:] = z + rigid
            for j in range(s):
                b -= carry[s, j] * slips[j]
            if k == 0 and s > 0:
                duals[s] = duals[s - 1]
            count, residual = solve_step(
                operator,
                inverse,
                penalty,
                bound,
                weight,
                scale,
                b,
                q,
                duals[s],
                slips[s],
                tolerance,
            )
            iterations += count
            total += residual
        z[:] = b - slips[n_stages - 1] - rigid
        _forces(q, weight, forward_position, lateral_position, forces[k + 1])
    return q, total, iterations


class PolarContact:
    """``cells`` rings x ``angles`` points on half the disc (see models.contact.Contact).

    rotates: mirror symmetry of rotating scenes, else point symmetry of translations; states:
    (2, angles, cells).  Raises ValueError where the half disc cannot be filled.
    """

    has_sensitivity = False
    has_memory = True

    def __init__(self, cells, angles, rotates, poisson=0.0, focus=None):
        if angles < 2:
            raise ValueError(f"angles = {angles}: allowed is a whole number of at least 2")
        self.rings = make_rings(cells, focus)
        self.angles, self.rotates = angles, rotates
        theta = (np.arange(angles) + 0.5) * np.pi / angles
        self.lateral_position = np.cos(theta)[:, None] * self.rings.radius
        self.forward_position = np.sin(theta)[:, None] * self.rings.radius
        self.bound = self.rings.bound
        self.weight = self.rings.area / angles
        self.operator, self.compliance = _operator(cells, angles, rotates, poisson, focus)
        self.penalty = PENALTY * self.compliance
        self.inverse = _inverse(cells, angles, rotates, poisson, focus)

    def displacement(self, state):
        """A q; shapes (2, angles, cells)."""
        flat = np.ascontiguousarray(state).reshape(2 * self.angles, -1)
        return apply_blocks(*self.operator, flat).reshape(state.shape)

    def mirrored(self, state):
        """theta -> pi - theta, lateral traction negated."""
        return state[:, ::-1, :] * np.array([1.0, -1.0])[:, None, None]

    def march(self, path, state, tolerance, sensitivity=False):
        """March along ``path``; see models.contact.Contact."""
        forces = np.zeros((path.steps + 1, 3))
        state, residual, iterations = _march(
            self.operator,
            self.inverse,
            self.penalty,
            self.bound,
            self.weight,
            self.compliance,
            (self.forward_position, self.lateral_position),
            path.start,
            path.stages,
            path.carry,
            np.ascontiguousarray(state),
            tolerance,
            forces,
        )
        # the half disc that is not resolved cancels what symmetry forbids
        forces[:, contact.LATERAL if self.rotates else contact.TORQUE] = 0.0
        solves = path.stages.shape[0] * path.stages.shape[1]
        return contact.March(state, forces, residual, iterations, solves)


def _coefficients(angles, rotates):
    """Real unknowns of the modes: (m, part), part 0 real, 1 imaginary, 2 the last sine (m = M)."""
    if rotates:
        return [(m, 0) for m in range(1 - angles, angles)] + [(angles, 2)]
    first = -(angles // 2) + (1 - angles % 2)
    return [(2 * k, part) for k in range(first, first + angles) for part in (0, 1)]


def _synthesis(angles, coefficients):
    """Points from coefficients, (2 M, 2 M): rows forward tractions, then lateral ones."""
    theta = (np.arange(angles) + 0.5) * np.pi / angles
    out = np.empty((2 * angles, 2 * angles))
    for k, (m, part) in enumerate(coefficients):
        # Q = forward - i lateral turns with the mode angle; its parts are the two rows
        wave = 1j * np.sin(m * theta) if part == 2 else np.exp(1j * m * theta) * (1, 1j)[part]
        out[:angles, k], out[angles:, k] = wave.real, -wave.imag
    return out


@lru_cache(maxsize=32)
def _operator(cells, angles, rotates, poisson, focus):
    """Mode transforms and influence blocks, and the self-influence of each ring (diagonal)."""
    coefficients = _coefficients(angles, rotates)
    index = {key: k for k, key in enumerate(coefficients)}
    kappa = poisson / (2.0 - poisson)
    rings = make_rings(cells, focus)
    n_modes = max(abs(m) for m, _ in coefficients) + 1
    near, far = ring_influence(rings.psi, n_modes, poisson > 0.0)
    ratio = rings.area[:, None] / rings.area[None, :]  # the transpose in the area-weighted product
    members, blocks = [], []
    for k, (m, part) in enumerate(coefficients):
        partner = index.get((2 - m, part)) if poisson > 0.0 and part < 2 else None
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
    size = max(len(block) for block in blocks)
    packed = np.zeros((len(blocks), size, size))
    for k, block in enumerate(blocks):
        packed[k, : len(block), : len(block)] = block.T
    to_points = _synthesis(angles, coefficients)
    to_modes = np.linalg.inv(to_points)
    operator = (to_modes, to_points, np.array(members), packed)
    return operator, np.ascontiguousarray(np.diag(near[0]))


@lru_cache(maxsize=32)
def _inverse(cells, angles, rotates, poisson, focus):
    """Blocks of (A + penalty)^-1, packed as in _operator."""
    (_, _, members, blocks), compliance = _operator(cells, angles, rotates, poisson, focus)
    out = np.zeros_like(blocks)
    for k, (_, second) in enumerate(members):
        n = cells if second < 0 else 2 * cells
        penalty = np.tile(PENALTY * compliance, n // cells)
        # the blocks are stored transposed, and so is their inverse
        out[k, :n, :n] = np.linalg.inv(blocks[k, :n, :n] + np.diag(penalty))
    return out
