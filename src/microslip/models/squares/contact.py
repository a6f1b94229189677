"""Square cells with FFT convolution: any nu, any outline; the general reference, and the paper's
own method.

A step is solved by a projected gradient method with Barzilai-Borwein steps, without line search:
the comparison of energies that a line search needs drowns in rounding long before the tractions
do.  Where the residual does not fall for a while, steps short enough to let the energy fall for
certain take over until it does.
"""

from __future__ import annotations

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.models import contact
from microslip.models.coulomb import extended, shrink
from microslip.models.interrupts import BETWEEN_LOOKS, interrupted, unbroken
from microslip.models.point_fields import rigid_displacement, sum_forces
from microslip.models.squares.convolution import convolve, square_convolution, workspace
from microslip.pressures.registry import HERTZ

MAX_ITERATIONS = 5000
PATIENCE = 60
"""Iterations granted to the Barzilai-Borwein steps for halving the residual."""
SHORT_STEP_BELOW = 0.3
"""Ratio of the two Barzilai-Borwein steps below which the shorter one is taken."""
MAX_REMEMBERED = 4_000_000
"""Numbers that a march keeps as first guesses for the next one; longer marches keep none."""


class CartesianContact:
    """``cells`` x ``cells`` squares over the circumscribed square of the contact.

    States: (2, cells, cells), axis 1 along the forward axis, axis 2 along the lateral one.  Cells
    that the edge cuts carry the load of their part inside.
    """

    has_sensitivity = False
    sticks = True
    angles = 1

    def __init__(self, cells, poisson=0.0, pressure=HERTZ):
        if cells < 2:
            raise ValueError(f"cells = {cells}: allowed is a whole number of at least 2")
        self.size = 2.0 / cells
        centres = (np.arange(cells) + 0.5) * self.size - 1.0
        self.forward_position, self.lateral_position = np.meshgrid(centres, centres, indexing="ij")
        self.weight = np.full((cells, cells), self.size**2)
        self.bound = pressure.cell_loads(cells) / self.size**2
        self.stiffness = pressure.stiffness
        self.operator, self.scale, self.largest = square_convolution(
            cells, poisson, pressure.G_star
        )
        self.compliance = np.full((cells, cells), self.scale)

    def displacement(self, state):
        """A q; shapes (2, cells, cells)."""
        out = np.empty(state.shape)
        convolve(self.operator, workspace(self.operator), np.ascontiguousarray(state), out)
        return out

    def mirrored(self, state):
        """Lateral axis reversed, lateral traction negated."""
        return state[:, :, ::-1] * contact.MIRROR

    def march(self, path, state, tolerance, sensitivity=False, previous=None):
        """March along ``path``; see models.contact.Contact."""
        steps, n_stages, _ = path.stages.shape
        guided = previous is not None and previous.stages is not None
        remembers = steps * n_stages * state.size <= MAX_REMEMBERED
        tractions = np.zeros((steps if remembers else 1, n_stages, *state.shape))
        forces = np.empty((steps + 1, 3))
        state, residual, iterations = unbroken(
            _march,
            self.operator,
            workspace(self.operator),
            (self.scale, self.largest),
            self.bound,
            self.weight[0],
            (self.forward_position, self.lateral_position),
            (path.positions, path.stages, path.carry, path.end),
            np.ascontiguousarray(state),
            self.displacement(state),
            tolerance,
            previous.stages if guided else tractions,
            guided,
            tractions,
            forces,
        )
        stages = tractions if remembers else None
        return contact.March(state, forces, residual, iterations, steps * n_stages, stages=stages)


@kernel
def _march(
    operator,
    scratch,
    scales,
    bound,
    weight,
    positions,
    path,
    state,
    elastic,
    tolerance,
    guide,
    guided,
    tractions,
    forces,
):
    """March along a path; returns (state, residual sum, iterations, whether it was interrupted).

    scales: see ``solve_step``; weight: area of a cell, (n,); positions: (forward, lateral), (n, n)
    each; path: (positions, stages, carry, end), see path.Path; elastic: displacement under
    ``state``; guide: tractions of every stage of a march near by, (steps, stages, 2, n, n), read if
    ``guided``; tractions: the same of this march, or only of its last step if it has no room for
    more; forces: filled, (steps + 1, 3).
    """
    way, stages, carry, end = path
    n_stages = stages.shape[1]
    q, held = state.copy(), state.copy()
    rigid, z, b = np.empty_like(q), np.empty_like(q), np.empty_like(q)
    slips = np.empty((n_stages, *q.shape))
    last_guide = q.copy()
    before = np.empty((2, n_stages, *q.shape))
    step = 1.0 / scales[0]
    rigid_displacement(way[0], positions, rigid)
    z[:] = elastic - rigid
    sum_forces(q, weight, positions, forces[0])
    total, iterations, spent = 0.0, 0, 0.0
    for k in range(stages.shape[0]):
        for s in range(n_stages):
            rigid_displacement(stages[k, s], positions, rigid)
            b[:] = z + rigid
            for j in range(s):
                b -= carry[s, j] * slips[j]
            if guided:  # what the other march added in this stage is added here, too
                _extrapolate(q, guide[k, s], last_guide, bound, q)
                last_guide[:] = guide[k, s]
            elif k > 1:
                _extrapolate(before[0, s], before[0, s], before[1, s], bound, q)
            count, residual, step = solve_step(
                operator, scratch, scales, bound, weight[0], b, q, slips[s], step, tolerance
            )
            spent += count * 100.0 * q.size
            if count < 0 or (spent > BETWEEN_LOOKS and interrupted()):
                return held, total, iterations, True
            if spent > BETWEEN_LOOKS:
                spent = 0.0
            iterations += count
            total += residual
            before[1, s] = before[0, s]
            before[0, s] = q
            tractions[min(k, len(tractions) - 1), s] = q
        b -= slips[n_stages - 1] + rigid
        for c in range(2):
            for i in range(q.shape[1]):
                for j in range(q.shape[2]):
                    z[c, i, j] = extended(z[c, i, j], b[c, i, j], end)
                    held[c, i, j] = extended(held[c, i, j], q[c, i, j], end)
        sum_forces(held, weight, positions, forces[k + 1])
    return held, total, iterations, False


@kernel
def solve_step(operator, scratch, scales, bound, weight, b, q, slip, step, tolerance):
    """Solve one Coulomb step in place.

    scales: self-influence, and a bound on the eigenvalues of the operator; weight: area of a cell;
    b: imposed displacement (2, n, n); q: start and result, within the bound; slip: receives
    b - A q; step: first length to try.  Returns (iterations, residual, last length); -1 iterations:
    interrupted.
    """
    new, moved = q.copy(), np.empty_like(q)
    between = int(BETWEEN_LOOKS / (100.0 * q.size)) + 1
    room = np.empty((3, q.shape[2]))
    best, best_at = np.inf, 0
    for iteration in range(MAX_ITERATIONS):
        convolve(operator, scratch, new, moved)
        dd, ds, ss = _replace(q, slip, new, b, moved, bound, room)
        if iteration == 0:
            pass  # nothing is known yet but the length that served the last step well
        elif iteration - best_at > PATIENCE or not ds > 0.0:
            step = 1.0 / scales[1]
        elif ds * ds < SHORT_STEP_BELOW * dd * ss:
            step = ds / ss
        else:
            step = dd / ds
        residual = weight * _projected_step(q, slip, bound, scales[0], step, new, room[0])
        if residual <= tolerance:
            return iteration, residual, step
        if residual < 0.5 * best:
            best, best_at = residual, iteration
        if iteration % between == between - 1 and interrupted():
            return -1, residual, step
    return MAX_ITERATIONS, residual, step


@kernel
def _projected_step(q, slip, bound, scale, step, new, room):
    """new = P(q + step slip); returns the residual over the weight, as friction.coulomb_residual.

    Sums go column by column into ``room``, (n,), which the compiler turns into vector instructions.
    """
    room[:] = 0.0
    for i in range(q.shape[1]):
        for j in range(q.shape[2]):
            forward, lateral = q[0, i, j] + step * slip[0, i, j], q[1, i, j] + step * slip[1, i, j]
            f = shrink(forward, lateral, bound[i, j])
            new[0, i, j], new[1, i, j] = f * forward, f * lateral
            forward, lateral = (
                q[0, i, j] + slip[0, i, j] / scale,
                q[1, i, j] + slip[1, i, j] / scale,
            )
            f = shrink(forward, lateral, bound[i, j])
            forward, lateral = f * forward - q[0, i, j], f * lateral - q[1, i, j]
            room[j] += np.sqrt(forward * forward + lateral * lateral)
    return room.sum()


@kernel
def _replace(q, slip, new, b, moved, bound, room):
    """q = new, slip = b - A new; returns <dq, dq>, -<dq, ds> and <ds, ds> of the change."""
    room[:] = 0.0
    for c in range(2):
        for i in range(q.shape[1]):
            for j in range(q.shape[2]):
                dq = new[c, i, j] - q[c, i, j]
                now = b[c, i, j] - moved[c, i, j]
                ds = slip[c, i, j] - now if bound[i, j] > 0.0 else 0.0
                room[0, j] += dq * dq
                room[1, j] += dq * ds
                room[2, j] += ds * ds
                q[c, i, j], slip[c, i, j] = new[c, i, j], now
    return room[0].sum(), room[1].sum(), room[2].sum()


@kernel
def _extrapolate(start, later, earlier, bound, out):
    """out = P(start + later - earlier)."""
    for i in range(bound.shape[0]):
        for j in range(bound.shape[1]):
            forward = start[0, i, j] + later[0, i, j] - earlier[0, i, j]
            lateral = start[1, i, j] + later[1, i, j] - earlier[1, i, j]
            f = shrink(forward, lateral, bound[i, j])
            out[0, i, j], out[1, i, j] = f * forward, f * lateral
