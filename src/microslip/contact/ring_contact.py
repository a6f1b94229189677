"""Contacts with points on rings.  The time integration of these contacts is compiled (march.py)."""

from __future__ import annotations

import signal
from collections.abc import Callable
from copy import copy
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np

from microslip.contact.contact import MIRROR, Body, Contact, March
from microslip.contact.influence import ring_influence
from microslip.contact.march import march, strain_energy
from microslip.contact.operators import LANES, multiply
from microslip.contact.path import Path
from microslip.contact.rings import Focus, Rings, make_rings
from microslip.contact.splitting import BALANCED_RINGS, PENALTIES
from microslip.scene.hertz import HERTZ
from microslip.scene.pressure import Pressure


def load_on_rings(pressure: Pressure, edges: np.ndarray, depth: np.ndarray) -> np.ndarray:
    """For each of k depths, return the load inside each of the n + 1 radii `edges`.

    A depth is the indentation divided by the indentation in the reference state.  In this state,
    the contact radius is a and the load is F_z.  The result has the shape (k, n + 1).
    """
    return pressure.load(edges, pressure.radius(depth)[:, None])


def interpolate(x: np.ndarray, nodes: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Interpolate values linearly from the nodes to the points x.  The nodes are along the last
    axis.

    Beyond the outermost nodes, the values are constant.
    """
    before = np.searchsorted(nodes[1:-1], x)
    start, end = nodes[before], nodes[before + 1]
    share = np.minimum(np.maximum((x - start) / (end - start), 0.0), 1.0)
    return values[..., before] * (1.0 - share) + values[..., before + 1] * share


class Growth(NamedTuple):
    """Scaling of rings or springs from the reference contact to a contact of a different size.

    Attributes
    ----------
    pressure : pressure.Pressure
        Pressure of an axisymmetric indenter.
    edges : np.ndarray, shape (n + 1,)
        Edges of the rings or springs in the reference contact, from 0 to 1.
    load_within : callable
        load_within(pressure, edges, depth) returns the load within each edge, of shape (k, n + 1).
    influence_power, weight_power : int
        Powers of the contact radius to which influence and weights are proportional.
    """

    pressure: Pressure
    edges: np.ndarray
    load_within: Callable
    influence_power: int
    weight_power: int


class RingContact(Contact):
    """Contact that is discretised into rings, and into angles on each ring; see contact.Contact.

    States have the shape (2, rows, cells).

    Parameters
    ----------
    influence : np.ndarray, shape (cells, cells)
        Matrix that maps mean ring tractions to mean ring displacements, for tractions that do not
        depend on the angle.  It becomes symmetric if its rows are multiplied by `area`.
    bound, area : np.ndarray, shape (cells,)
        Friction bound and area of each ring.
    positions : np.ndarray, shape (2, rows, cells)
        Forward and lateral coordinates of the points, divided by a.
    stiffness : float
        See contact.Contact.
    waves : tuple of np.ndarray
        The arrays to_waves, to_points and matrices of the operator A; see operators.multiply.  The
        third array has the shape (matrices, columns, columns); in contrast to operators.multiply,
        the matrices are not transposed, and their columns are not padded.
    growth : Growth or None
        Scaling of springs with the indentation depth; None if the normal load is constant.
    rings : Rings or None
        Mesh of the rings, which determines their growth; None for springs.
    """

    sticks = True
    radius = 1.0
    edges: np.ndarray | None = None
    resultants = np.ones(3)
    mirror_rows: np.ndarray | None = None
    growth: Any = None
    prolongs = True
    """Whether tractions from a coarser mesh are a useful initial guess."""
    theta: np.ndarray | None = None
    rotates = False
    _joins: Any = None
    _last: tuple[Any, Any] = (None, None)

    def __init__(
        self,
        influence: np.ndarray,
        bound: np.ndarray,
        area: np.ndarray,
        positions: np.ndarray,
        *,
        stiffness: float,
        waves: tuple[np.ndarray, np.ndarray, np.ndarray],
        growth: Growth | None = None,
        rings: Rings | None = None,
    ):
        self.influence, self.bound, self.growth = influence, bound, growth
        self.rings = rings
        self.area, self._waves, self.stiffness = area, waves, float(stiffness)
        self.forward_position, self.lateral_position = positions
        self.angles = len(self.forward_position)
        self.shape = positions.shape
        self.weight, self.compliance = area / self.angles, np.diag(influence)
        if rings is not None:
            self.growth = Growth(rings.pressure, np.sin(rings.psi), load_on_rings, 1, 2)
        if self.growth is not None:
            self.edges = self.growth.edges

    @cached_property
    def system(self) -> tuple[tuple, tuple, np.ndarray]:
        """The arguments `operators` and `points` of march.march, and the friction bounds.

        The operators are A and the resolvents of A.
        """
        to_waves, to_points, matrices = self._waves
        cells, columns = len(self.bound), matrices.shape[-1]
        parts, width = columns // cells, -(-cells // LANES) * LANES
        penalty = self.compliance * np.sqrt(cells / BALANCED_RINGS)
        shifts = PENALTIES[:, None, None, None] * np.diag(np.tile(penalty, parts))
        each = np.concatenate([matrices[None], np.linalg.inv(matrices + shifts)])
        each = each.reshape(*each.shape[:2], parts, cells, parts, cells)
        out = np.zeros((*each.shape[:2], parts, width, parts, width))
        out[..., :cells, :, :cells] = each.transpose(0, 1, 4, 5, 2, 3)
        operators = to_waves, to_points, out.reshape(*each.shape[:2], parts * width, -1)
        fields = np.zeros((5, self.shape[1], width))
        fields[4] = 1.0  # the penalty of the additional points
        values = self.weight, self.bound, self.forward_position, self.lateral_position, penalty
        for field, one in zip(fields, values, strict=True):
            field[:, :cells] = one
        weight, bound, *positions, penalty = fields.reshape(5, -1)
        area, count = float(weight.sum()), float(np.count_nonzero(weight))
        return operators, (weight, penalty, area, count, np.array(positions)), bound[None]

    def pack(self, values: np.ndarray) -> np.ndarray:
        """Convert values of shape (..., rows, cells) to fields of shape (..., points) for compiled
        code.

        The number of points in each row of a field is a multiple of LANES.  The additional points
        are set to 0.
        """
        *shape, rows, cells = values.shape
        points = len(self.system[1][0])
        out = np.zeros((*shape, rows, points // rows))
        out[..., :cells] = values
        return out.reshape(*shape, points)

    def displacement(self, state: np.ndarray) -> np.ndarray:
        """Return the elastic displacement A q of each point under tractions q."""
        operators = self.system[0]
        field, (sectors, waves, rows) = self.pack(state), operators[0].shape
        image = np.empty_like(field)
        scratch = np.empty((2, sectors * waves, 2 * field.shape[1] // (sectors * rows)))
        multiply(operators, 0, field, image, scratch)
        return image.reshape(2, self.shape[1], -1)[..., : self.shape[2]]

    def prolong(self, state: np.ndarray) -> np.ndarray | None:
        """Interpolate tractions from a coarser mesh to the points of this contact.

        The interpolated quantity is the traction as a fraction of the friction bound.  Returns None
        for springs, for changing loads, and if `prolongs` is False.
        """
        fine, theta = self.rings, self.theta
        if fine is None or self._joins is not None or not self.prolongs:
            return None
        coarse = make_rings(state.shape[2], fine.focus, fine.pressure)
        fields = interpolate(fine.radius, coarse.radius, state / coarse.bound) * self.bound
        if theta is None:
            return fields
        # extend the angles beyond the lateral axis, across which forward tractions are even;
        # lateral tractions are odd for a rotation and even for a translation
        beyond, count = fields[:, [0, -1]] * (MIRROR if self.rotates else 1.0), state.shape[1]
        fields = np.concatenate([beyond[:, :1], fields, beyond[:, 1:]], axis=1)
        angles = (np.arange(-1, count + 1) + 0.5) / count
        return interpolate(theta / np.pi, angles, fields.swapaxes(1, 2)).swapaxes(1, 2)

    def mirrored(self, state: np.ndarray) -> np.ndarray:
        """Return the mirror image of a state, in which the lateral direction is reversed and the
        lateral tractions are negated."""
        return (state if self.mirror_rows is None else state[:, self.mirror_rows]) * MIRROR

    def march(
        self,
        path: Path,
        state: np.ndarray,
        tolerance: float,
        previous: March | None = None,
        *,
        body: Body | None = None,
        start: np.ndarray | None = None,
    ) -> March:
        """Integrate the contact along a path; see contact.Contact.

        body: driven body on the contact; None if the contact follows the path.  start: values of x
        and x' of the body at the start of the path, as an array of shape (2,); None for zeros.
        """
        state = np.ascontiguousarray(state, dtype=float)
        drive = NO_DRIVE if body is None else body.along(path, start)
        motion, (operators, points, bounds) = path.motion, self.system
        if path.depth is not None:  # the bounds along the most recent path are cached
            if self._last[0] is not path.depth:
                every = self.bounds_along(path)[:, None]
                every = np.broadcast_to(every, (len(every), *self.shape[1:]))
                self._last = path.depth, self.pack(every)
            bounds = self._last[1]
        guess = None if previous is None else previous.fields
        if guess is None or guess.shape != (len(motion), *self.shape):
            guess = np.empty((0, *self.shape))
        loading, begin = (motion, bounds, path.carry, float(path.end)), (state, guess)
        while True:
            end, history, forces, moves, residual, iterations = march(
                operators, points, loading, drive, begin, float(tolerance)
            )
            if iterations >= 0:
                break
            signal.raise_signal(signal.SIGINT)
        forces *= self.resultants
        return March(end, forces, residual, iterations, len(history) - 1, history, moves)

    def energy(self, change: np.ndarray) -> float:
        """Return <q, A q>, which is twice the elastic energy of the tractions q."""
        operators, points, _ = self.system
        return strain_energy(operators, points[0], np.ascontiguousarray(change))

    def at_indentation(self, deepest: float, start: float) -> RingContact:
        """Return a contact whose rings fill the largest contact area in a period.

        Parameters
        ----------
        deepest : float
            Largest depth in the period (see load_on_rings), above 0.
        start : float
            Depth at the start of the period, for which `bound` is computed.
        """
        growth, out = self.growth, copy(self)
        for name in ("system", "_last"):
            vars(out).pop(name, None)
        out.radius = radius = float(growth.pressure.radius(deepest))
        softer = radius**growth.influence_power
        out.growth = growth._replace(edges=growth.edges * radius)
        out.influence, out.area = self.influence * softer, self.area * radius**growth.weight_power
        out._waves = (*self._waves[:2], self._waves[2] * softer)
        out.forward_position = self.forward_position * radius
        out.lateral_position = self.lateral_position * radius
        out.weight, out.compliance = out.area / self.angles, np.diag(out.influence)
        out.stiffness = self.stiffness * radius
        radii = out._effective_radii()
        out._joins = 0.5 * (radii[1:-1] + radii[2:])
        out.bound = out.bounds(np.array([start]))[0]
        return out

    def _effective_radii(self) -> np.ndarray:
        """Effective radii, as an array of shape (cells + 1,).

        Entry k is the radius of a contact that has, without slip, the same stiffness as the first k
        rings.  The radius in entry k is slightly smaller than the outer radius of the first k
        rings.  A ring joins the contact when the contact radius reaches the mean of two effective
        radii. One of these radii is computed without this ring, and the other one with this ring.
        The stiffness of a growing contact is then correct on average.  Suppose that the ring joined
        as soon as the contact reached the ring's inner edge.  The ring would then stick too early,
        and the error would be of first order.
        """
        weighted = self.area[:, None] * self.influence
        part = np.linalg.solve(np.linalg.cholesky(0.5 * (weighted + weighted.T)), self.area)
        # w^T B^-1 w of the first k rings, where B is the weighted influence
        return np.concatenate([[0.0], np.cumsum(part**2) * self.radius / self.stiffness])

    def bounds(self, depths: np.ndarray, edge: np.ndarray | None = None) -> np.ndarray:
        """Return the mean friction bound of each ring at each depth, as an array of shape
        (len(depths), cells).

        edge: for each depth, the radius inside which rings are in contact; None for the contact
        radii.  The load outside these rings is added to the outermost ring in contact.
        """
        growth = self.growth
        load_within = growth.load_within(growth.pressure, growth.edges, depths)
        edge = growth.pressure.radius(depths) if edge is None else edge
        outside, most = edge[:, None] <= self._joins, load_within[:, -1:]
        load_within[:, 1:-1] = np.where(outside, most, load_within[:, 1:-1])
        return np.maximum(np.diff(load_within, axis=1), 0.0) / self.area

    def bounds_along(self, path: Path) -> np.ndarray:
        """Return the friction bounds at the start and at every stage of a path.

        The result has the shape (1 + steps * stages, cells).

        Rings join or leave the contact only at the last stage of a step. The integrator would carry
        over a jump at an earlier stage to the later stages.  A ring that joins at the last stage is
        strained only during a part of the step, namely the fraction `1 / (1 + carried)`.  On
        average, the ring should be strained during half of the step.  To make up for the
        difference, the contact radius is evaluated at an earlier time.
        """
        assert path.depth is not None  # otherwise the bounds are constant
        stages = len(path.carry)
        ends = self.growth.pressure.radius(path.depth[::stages])
        shift = 0.5 - 1.0 / (1.0 + path.carry[-1].sum())
        radii = ends.copy()
        radii[:-1] += shift * np.diff(ends)  # except at the end, where the next march begins
        edge = np.repeat(radii[:-1, None], stages, axis=1)
        edge[:, -1] = radii[1:]
        return self.bounds(path.depth, np.append(radii[:1], edge))


class RadialContact(RingContact):
    """Contact of rings without angular points.  States have the shape (2, 1, cells).

    The model is exact for translations at nu = 0, because the tractions then depend on the radius
    alone.  `resolved` creates the contact of an elastic half-space.

    Parameters
    ----------
    influence, bound, weight, growth, rings
        See RingContact; `weight` is the area of the rings.
    stiffness : float or None
        Stiffness of the whole contact; None to compute it from the matrix.
    """

    resultants = np.array([1.0, 1.0, 0.0])

    def __init__(
        self,
        influence: np.ndarray,
        bound: np.ndarray,
        weight: np.ndarray,
        stiffness: float | None = None,
        growth: Growth | None = None,
        rings: Rings | None = None,
    ):
        weighted = weight[:, None] * influence
        weighted = 0.5 * (weighted + weighted.T)
        if stiffness is None:  # computed as the force for a unit displacement of all rings
            stiffness = float(weight @ np.linalg.solve(weighted, weight))
        one, positions = np.ones((2, 1, 1)), np.zeros((2, 1, len(bound)))
        waves = one, one, (weighted / weight[:, None])[None]
        super().__init__(
            influence,
            bound,
            weight,
            positions,
            stiffness=stiffness,
            waves=waves,
            growth=growth,
            rings=rings,
        )

    @staticmethod
    @lru_cache(maxsize=32)
    def resolved(
        cells: int, focus: Focus | float | None = None, pressure: Pressure = HERTZ
    ) -> RadialContact:
        """Return the contact of an elastic half-space, with rings graded towards `focus`.  The
        number of rings is `cells`.

        Calls with equal arguments return the same object, which must not be modified.
        """
        rings = make_rings(cells, focus, pressure)
        near, _ = ring_influence(tuple(rings.psi), 1, False, pressure.G_star)
        return RadialContact(near[0], rings.bound, rings.area, pressure.stiffness, rings=rings)


NO_DRIVE = np.zeros(6), np.zeros(0)
"""Arguments `drive` and `lengths` of march.march for a contact without a driven body."""
