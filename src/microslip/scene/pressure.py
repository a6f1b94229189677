"""Pressures are distributions of the load over the contact. A pressure gives the friction bound at
each point.

Working units are dimensionless: mu F_z = 1, u_lim = 1 and a = 1.  The length a is the outer radius
of a round contact. For other contacts, a is half the longer side of the bounding rectangle.  The
displacement u_lim is the largest displacement of a point under full slip of the whole contact,
computed with the compliance averaged over directions,

    u_lim = max of 1/(pi G*) Integral mu p(z') / |z - z'| dA'.

For an axisymmetric indenter at the depth d, u_lim is mu d E*/G*.  For a sphere, this length is 3 mu
F_z/(4 G* a).  A round contact that moves in one direction from rest slides everywhere once the
displacement exceeds u_lim.  At nu = 0, contacts of any shape also slide everywhere beyond this
displacement.  At nu > 0, other contacts reach full slip at a displacement that differs from u_lim
by a few percent.  The difference depends on the direction.  The reduced shear modulus G* in working
units is 3/4 for a sphere.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from microslip.foundation import spec
from microslip.foundation.arguments import numbers
from microslip.foundation.errors import InputError
from microslip.scene.grid import (
    FINE,
    FINEST,
    READINGS,
    Axis,
    Grid,
    checked,
    cropped,
    distances,
    largest_displacement,
    of_loads,
    round_loads,
)

Units = tuple[float | None, float | None]
"""Unit of the coordinates, expressed in m, and unit of the pressure, expressed in Pa.  Both units
are None for dimensionless values."""
NO_UNITS: Units = None, None
COMPARED = 64
"""Two attributes are compared on this number of squares along each side, or on this number of
rings."""


@dataclass(frozen=True)
class Pressure(spec.Named):
    """A distribution of the load over the contact, in working units (see the module pressure).

    Each pressure is a subclass.  In a string such as "power:exponent=1", the parameters after the
    name are the fields of the subclass.  `str` returns this string.

    Attributes
    ----------
    summary : str
        One-line description.
    ranges : mapping of str to tuple
        Smallest and largest value of each parameter.
    G_star : float
        Reduced shear modulus 4G/(2 - nu).
    torque : float
        Torque about the centre at full slip, divided by mu F_z a.
    largest : float
        Largest pressure divided by F_z / a^2.  It equals the largest friction bound, and can be
        infinite.
    mirrored : bool
        Whether the pressure is unchanged if the sign of the lateral coordinate is reversed.
    inner : float
        Radius of the hole at the centre; 0 if there is no hole.
    hertzian : bool
        Whether the contact is an elliptic Hertz contact.  The stick zone of such a contact is an
        ellipse of the same shape (Vermeulen and Johnson), so that `loading` is the same as for a
        sphere.
    is_round : bool
        Whether the pressure depends on the radius alone.
    is_indenter : bool
        Whether the pressure belongs to an axisymmetric indenter.
    readings : tuple of Pressure
        Alternative pressures that agree with the values on a grid.  The differences in friction
        between these pressures are an estimate of the error due to the grid.
    """

    summary: ClassVar[Any] = ""
    ranges: ClassVar[Mapping[str, tuple]] = {}
    needs: ClassVar[tuple[str, ...]] = ("G_star", "torque", "largest", "cell_loads")
    G_star: ClassVar[Any] = None
    torque: ClassVar[Any] = None
    largest: ClassVar[Any] = None
    mirrored: ClassVar[bool] = True
    hertzian: ClassVar[bool] = False
    area: ClassVar[Any] = np.pi
    """Contact area divided by a^2."""
    inner = 0.0
    readings = ()
    half_widths: ClassVar[Any] = (1.0, 1.0)
    """Half the forward width and half the lateral width of the rectangle around the contact,
    divided by a."""
    cell_loads: ClassVar[Any] = None
    """cell_loads(n) returns the loads on n x n cells of the rectangle around the contact, as an
    array with the axes (forward, lateral).  The sum of the loads is 1."""

    # Attributes of pressures that depend on the radius alone
    ring_means: ClassVar[Any] = None
    """ring_means(psi) returns two arrays for the rings with the edges r = sin(psi): the mean
    friction bound, and the mean lever arm of a traction proportional to the bound.  psi is an array
    of shape (n + 1,); each result has the shape (n,)."""
    bound: ClassVar[Any] = None
    """bound(r) returns the friction bound mu p at an array of radii r of any shape.  For an
    indenter, bound(r, c) returns the bound at the contact radius c."""

    # Attributes of axisymmetric indenters, whose contact is a full circle that grows with the load
    depth: ClassVar[Any] = None
    """depth(c) returns the indentation depth for the contact radius c; depth(1) is 1."""
    radius: ClassVar[Any] = None
    """radius(depth) returns the contact radius at a depth (the inverse of `depth`), or 0 if there
    is no contact."""
    of_load: ClassVar[Any] = None
    """of_load(share) returns the depth at which the load, divided by the mean load, is `share`."""
    load: ClassVar[Any] = None
    """load(r, c) returns the load within the radius r in a contact of radius c; arrays
    broadcast."""

    loading: ClassVar[Any] = None
    """loading(u) returns the tangential force at nu = 0 after a displacement u in one direction
    from rest. The force is divided by mu F_z, and the nonnegative displacement by u_lim.  This
    loading curve is defined for axisymmetric indenters and elliptic Hertz contacts."""

    is_round: ClassVar[bool] = False
    is_indenter: ClassVar[bool] = False

    def __init_subclass__(cls, **arguments: Any) -> None:
        super().__init_subclass__(**arguments)
        cls.is_round, cls.is_indenter = cls.ring_means is not None, cls.depth is not None

    def __post_init__(self) -> None:
        spec.refuse_strange(self, "pressure")
        for name in self.needs:
            if getattr(type(self), name) is None:
                raise InputError("pressure", self.name, f"allowed is a class that defines {name}")
        for name, limits in self.ranges.items():
            spec.refuse_outside(self.name, "pressure", name, getattr(self, name), limits)
        if type(self).__module__.startswith("microslip."):  # compared by the tests
            return
        with np.errstate(all="ignore"):
            for names, one, other, largest in self._pairs():
                apart = np.max(np.abs(np.subtract(one, other)))
                if not apart <= largest * np.max(np.abs(other)):
                    problem = f"{names} contradict each other: they differ by {apart:.3g}"
                    raise InputError("pressure", self.name, problem)

    def _pairs(self) -> Iterator[tuple[str, Any, Any, float]]:
        """Yield pairs of values that must agree. For each pair, yield the names, the two values,
        and the largest allowed relative difference.

        For the pressures of the package, each difference is at most a quarter of the allowed
        difference.
        """
        if self.is_indenter:
            depth = np.linspace(0.0, 1.0, 9)
            yield "depth and its value of 1 at 1", self.depth(np.ones(1)), 1.0, 1e-3
            yield "radius and depth", self.depth(self.radius(depth)), depth, 0.01
            yield "of_load and load", self.total(self.of_load(depth)), depth, 0.01
            yield "loading and load", self.loading(1.0 - depth), 1.0 - self.total(depth), 0.01
        n, (forward, lateral) = COMPARED, self.half_widths
        edges, loads = np.linspace(-1.0, 1.0, n + 1), np.asarray(self.cell_loads(n))
        yield "cell_loads and its shape", loads.shape, (n, n), 0.0
        yield "cell_loads and a sum of 1", loads.sum(), 1.0, 1e-3
        image = loads[:, ::-1] if self.mirrored else loads
        yield (
            "mirrored and cell_loads",
            loads.sum(axis=0).cumsum(),
            image.sum(axis=0).cumsum(),
            0.01,
        )
        slip = largest_displacement(loads, forward, lateral)
        yield "G_star and cell_loads", self.G_star, slip, 0.1
        lever = np.sum(loads * distances(forward * edges, lateral * edges))
        yield "torque and cell_loads", self.torque, lever, 0.01
        cell = forward * lateral * (2.0 / n) ** 2
        peak, filled = loads.max() / cell, np.count_nonzero(loads) * cell
        yield "largest and cell_loads", min(self.largest, peak), peak, 0.02
        yield "area and cell_loads", min(self.area, filled), self.area, 0.02
        if self.is_round:
            psi = np.linspace(np.arcsin(self.inner), np.pi / 2, n + 1)
            means, lever = self.ring_means(psi)
            rings = np.pi * np.diff(np.sin(psi) ** 2) * means
            yield "ring_means and torque", rings @ lever, self.torque, 0.01
            if self.is_indenter:
                load = self.load(np.sin(psi[1:]), np.ones(n))
                yield "load and ring_means", load, rings.cumsum(), 0.01

    @staticmethod
    def from_array(
        forward: np.ndarray, lateral: np.ndarray, pressure: np.ndarray, *, grid: str = "cells"
    ) -> Measured:
        """Create a pressure from values on a regular grid.

        The unit of length, a, is half the longer side of the smallest rectangle that contains all
        nonzero pressures.  The error estimate of friction includes the effect of the unknown
        pressure between the points.

        Parameters
        ----------
        forward, lateral : array, shapes (n,) and (m,)
            Increasing coordinates, both in the same unit of length.
        pressure : array, shape (n, m)
            Pressure in any unit, 0 outside the contact.
        grid : str
            "cells" if each value is the mean over the cell around its point; "samples" if the
            values apply at the points and are to be interpolated bilinearly.

        Raises
        ------
        InputError
            If an argument is not an array of numbers, if coordinates are not evenly spaced, if a
            value is negative or not finite, or if all values are 0.
        """
        if not isinstance(grid, str) or grid not in READINGS:
            raise InputError("grid", grid, f"allowed is one of {', '.join(READINGS)}")
        arrays = {"forward": forward, "lateral": lateral, "pressure": pressure}
        x, y, values = map(numbers, arrays, arrays.values())
        if values.shape != (x.size, y.size):
            allowed = f"allowed is the shape of the coordinates, {(x.size, y.size)}"
            raise InputError("pressure", values.shape, allowed)
        digest = hashlib.sha256(b"".join(one.tobytes() for one in (x, y, values))).hexdigest()[:16]
        return Measured.on_grid(f"array:sha256={digest},grid={grid}", x, y, values, grid)

    @property
    def stiffness(self) -> float:
        """Tangential force for a uniform displacement u_lim without slip, divided by mu F_z.

        The value is 2 G* a.  For a contact that does not fill the circle of radius a, this value is
        an upper bound.
        """
        return 2.0 * self.G_star

    def total(self, depth: np.ndarray) -> np.ndarray:
        """Compute the load of an indenter at each depth of an array. The depths must not be
        negative."""
        radius = self.radius(depth)
        return self.load(radius, radius)

    def stick_radius(self, displacement: float) -> float | None:
        """Return the stick radius after a displacement in one direction from rest.

        The displacement is in units of u_lim and must not be negative.  The stick radius is the
        contact radius at the depth 1 - displacement (Ciavarella, Jaeger).  The result is 0.0 at
        full slip.  If the pressure does not belong to an axisymmetric indenter, the result is None.
        """
        return float(self.radius(max(1.0 - displacement, 0.0))) if self.is_indenter else None


@dataclass(frozen=True)
class RoundPressure(Pressure):
    """Base class of pressures that depend on the radius alone. Their attributes are computed from
    integrals over rings.

    A subclass defines two methods. `ring_loads` returns the integral of the friction bound over
    each ring, and `ring_moments` returns the integral of the bound times the radius.  The rings
    have the edges r = sin(psi), where psi is an array of shape (n + 1,).  Both functions return an
    array of shape (n,).
    """

    needs = (*Pressure.needs, "ring_loads", "ring_moments")
    ring_loads: ClassVar[Any] = None
    ring_moments: ClassVar[Any] = None

    def ring_means(self, psi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """For each ring between neighbouring edges r = sin(psi), compute the mean friction bound
        and the lever arm."""
        loads, moments, radii = self.ring_loads(psi), self.ring_moments(psi), np.sin(psi)
        # a ring without load needs a finite lever arm, too
        lever = np.where(loads > 0.0, moments / np.where(loads > 0.0, loads, 1.0), radii[1:])
        return loads / (np.pi * np.diff(radii**2)), lever

    def cell_loads(self, cells: int) -> np.ndarray:
        """Compute the load on each cell, as an array of shape (cells, cells)."""
        return round_loads(cells, self.ring_loads, self.inner)


@dataclass(frozen=True, eq=False)
class Measured(spec.NamedByText, Pressure):
    """A pressure given by values on a grid; see `Pressure.from_array`.

    The unit of length, a, is half the longer side of the smallest rectangle that contains all
    nonzero pressures.  The contact rotates about the centre of this rectangle.

    Attributes
    ----------
    text : str
        Name of the pressure, including a digest of the values.
    grid : grid.Grid
        The values divided by the largest value, on axes in units of the longer grid step.
    step, peak : float
        The longer grid step, in the unit of the coordinates, and the largest value, in the unit of
        the values.
    units : tuple
        Units of the coordinates and of the values; see Units.
    """

    text: str
    grid: Grid
    step: float = 1.0
    peak: float = 1.0
    units: Units = NO_UNITS
    readings: tuple[Measured, ...] = ()  # type: ignore[assignment]

    summary = "a pressure on a grid"
    mirrored = False

    @classmethod
    def on_grid(
        cls,
        name: str,
        forward: np.ndarray,
        lateral: np.ndarray,
        values: np.ndarray,
        reading: str = "cells",
        units: Units = NO_UNITS,
    ) -> Measured:
        """Create a pressure with the given name.

        The attribute `readings` contains two further pressures.  The first pressure interprets the
        same values by the other entry of `grid.READINGS`. The second pressure has the values at
        half the resolution.  Raises InputError in the same cases as `grid.checked`.
        """
        points, values, step = checked(forward, lateral, values)
        peak = float(values.max())
        (other,) = set(READINGS) - {reading}
        grid, second = (cropped(points, values / peak, kind) for kind in (reading, other))
        others = {f"read as {other}": second, "at half its resolution": grid.coarsened()}
        more = [cls(f"{name} ({label})", one, step, peak, units) for label, one in others.items()]
        return cls(name, grid, step, peak, units, tuple(more))

    @property
    def _sides(self) -> tuple[Axis, Axis]:
        return self.grid.forward, self.grid.lateral

    @property
    def _half(self) -> float:
        return max(side.half for side in self._sides)

    @property
    def half_widths(self) -> tuple[float, float]:
        forward, lateral = (side.half / self._half for side in self._sides)
        return forward, lateral

    def cell_loads(self, cells: int) -> np.ndarray:
        """Compute the load on each cell, as an array of shape (cells, cells)."""
        edges = np.arange(cells + 1) * 2.0 / cells - 1.0
        return of_loads(self.grid.loads(*(side.middle + side.half * edges for side in self._sides)))

    @cached_property
    def G_star(self) -> float:
        fine = min(max(FINE, *self.grid.values.shape), FINEST)
        return largest_displacement(self.cell_loads(fine), *self.half_widths)

    @cached_property
    def torque(self) -> float:
        """Mean distance from the centre, weighted by the pressure.  The result is exact if the
        values are means over cells."""
        edges = [side.edges(-(-FINE // side.steps)) for side in self._sides]
        loads = self.grid.loads(*edges)
        pairs = zip(edges, self._sides, strict=True)
        x, y = ((one - side.middle) / self._half for one, side in pairs)
        return float(np.sum(loads * distances(x, y)) / loads.sum())

    @property
    def area(self) -> float:
        """Area of the cells with nonzero pressure, divided by a^2."""
        cell = self.grid.forward.step * self.grid.lateral.step
        return np.count_nonzero(self.grid.values) * cell / self._half**2

    @property
    def _total(self) -> float:
        """Integral of the values over the rectangle."""
        return float(self.grid.loads(*(side.edges(1) for side in self._sides)).sum())

    @cached_property
    def largest(self) -> float:
        return float(self.grid.values.max()) * self._half**2 / self._total

    @property
    def size_m(self) -> float | None:
        """Half the longer side of the contact, in m. The value is None if the coordinates have no
        unit."""
        metre = self.units[0]
        return None if metre is None else self._half * self.step * metre

    @property
    def load_N(self) -> float | None:
        """Integral of the pressure over the contact, in N. The value is None if the coordinates or
        the pressures have no unit."""
        metre, pascal = self.units
        if metre is None or pascal is None:
            return None
        return self._total * self.peak * pascal * (self.step * metre) ** 2
