"""Pressures.  A pressure is the distribution of the load over the contact, and gives the friction
bound at each point.

Working units are dimensionless: mu F_z = 1, u_lim = 1 and a = 1.  The length a is the outer radius
of a round contact; for other contacts, it is half the longer side of the bounding rectangle.  The
displacement u_lim is the largest displacement of a point under full slip of the whole contact,
computed with the compliance averaged over directions,

    u_lim = max of 1/(pi G*) Integral mu p(z') / |z - z'| dA'.

For an axisymmetric indenter at the depth d, u_lim is mu d E*/G*, which is 3 mu F_z/(4 G* a) for a
sphere.  A round contact that moves in one direction from rest slides everywhere once the
displacement exceeds u_lim, and so does any contact at nu = 0.  Other contacts at nu > 0 slide a few
percent earlier or later, depending on the direction.  In working units, the reduced shear modulus
is the number G*, which is 3/4 for a sphere.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from microslip.foundation import spec
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
"""Unit of the coordinates in m, and unit of the pressure in Pa; None for dimensionless values."""
NO_UNITS: Units = None, None


@dataclass(frozen=True)
class Pressure(spec.Named):
    """A distribution of the load over the contact, in working units (see the module pressure).

    Each pressure is a subclass.  Its fields are the numbers that may
    follow its name in a text such as "power:exponent=1"; `str` returns this text.

    Attributes
    ----------
    summary : str
        Description in one line.
    G_star : float
        Reduced shear modulus 4G/(2 - nu).
    torque : float
        Torque about the centre at full slip, divided by mu F_z a.
    largest : float
        Largest pressure divided by F_z / a^2.  It equals the largest friction bound, and can be
        infinite.
    mirrored : bool
        Whether the pressure is symmetric under lateral -> -lateral.
    inner : float
        Radius of the hole in the middle; 0 if there is no hole.
    hertzian : bool
        Whether the contact is an elliptic Hertz contact.  Its stick zones are ellipses of the same
        shape (Vermeulen and Johnson), so `loading` is the same as for a sphere.
    readings : tuple of Pressure
        Alternative pressures that agree with the values of a grid.  The differences in friction
        between these pressures give the error due to the grid.
    """

    summary: ClassVar[Any] = ""
    G_star: ClassVar[Any] = None
    torque: ClassVar[Any] = None
    largest: ClassVar[Any] = None
    mirrored: ClassVar[bool] = True
    hertzian: ClassVar[bool] = False
    area: ClassVar[Any] = np.pi
    """Contact area divided by a^2."""
    inner = 0.0
    half_widths: ClassVar[Any] = (1.0, 1.0)
    """Half of the forward and the lateral width of the rectangle around the contact, divided by
    a."""
    cell_loads: ClassVar[Any] = None
    """cell_loads(cells): load on each of cells x cells cells of the rectangle around the contact,
    (forward, lateral); the sum is 1."""

    # For pressures that depend on the radius alone:
    ring_means: ClassVar[Any] = None
    """ring_means(psi) -> (bound, lever): mean friction bound of the rings with the edges r =
    sin(psi), and mean lever arm of a traction with the shape of the bound.  psi has the shape (n +
    1,), and each result has the shape (n,)."""
    bound: ClassVar[Any] = None
    """bound(r): friction bound mu p at radii r, any shape; for an indenter also bound(r, c)."""

    # For axisymmetric indenters, whose contact is a full circle that grows with the load:
    depth: ClassVar[Any] = None
    """depth(c): indentation depth for the contact radius c; depth(1) = 1."""
    radius: ClassVar[Any] = None
    """radius(depth): inverse of `depth`; 0 if there is no contact."""
    of_load: ClassVar[Any] = None
    """of_load(share): depth at which the load is `share` times the mean load."""
    load: ClassVar[Any] = None
    """load(r, c): load within the radius r of a contact of radius c; arrays broadcast."""

    loading: ClassVar[Any] = None
    """loading(u): tangential force divided by mu F_z after a displacement u >= 0 (in u_lim) in one
    direction from rest, at nu = 0.  It is available for axisymmetric indenters and elliptic Hertz
    contacts."""

    def __post_init__(self) -> None:
        spec.refuse_strange(self, "pressure")

    @staticmethod
    def from_array(
        forward: np.ndarray, lateral: np.ndarray, pressure: np.ndarray, *, grid: str = "cells"
    ) -> Measured:
        """Create a pressure from values on a regular grid.

        The unit of length a is half the longer side of the smallest rectangle that contains all
        pressure.  The error estimate of friction includes the effect of the unknown pressure
        between points.

        Parameters
        ----------
        forward, lateral : array, shapes (n,) and (m,)
            Increasing coordinates, both in the same unit of length.
        pressure : array, shape (n, m)
            Pressure in any unit, 0 outside the contact.
        grid : str
            "cells" if values are means over the cells around the points; "samples" if they are
            values at the points, which are interpolated bilinearly.

        Raises
        ------
        InputError
            If an argument is not an array of numbers, if coordinates are not evenly spaced, if a
            value is negative or not finite, or if all values are 0.
        """
        if grid not in READINGS:
            raise InputError("grid", grid, f"allowed is one of {', '.join(READINGS)}")
        x, y, values = (
            _numbers(name, one)
            for name, one in (("forward", forward), ("lateral", lateral), ("pressure", pressure))
        )
        if values.shape != (x.size, y.size):
            allowed = f"allowed is the shape of the coordinates, {(x.size, y.size)}"
            raise InputError("pressure", values.shape, allowed)
        digest = hashlib.sha256(b"".join(one.tobytes() for one in (x, y, values))).hexdigest()[:16]
        return Measured.on_grid(f"array:sha256={digest},grid={grid}", x, y, values, grid)

    @property
    def readings(self) -> tuple[Pressure, ...]:
        return ()

    @property
    def is_round(self) -> bool:
        """Whether the pressure depends on the radius alone."""
        return self.ring_means is not None

    @property
    def is_indenter(self) -> bool:
        """Whether the pressure belongs to an axisymmetric indenter."""
        return self.depth is not None

    @property
    def stiffness(self) -> float:
        """Force for a uniform displacement u_lim without slip, divided by mu F_z.

        It is 2 G* a, which is an upper bound for a contact that does not fill the circle of
        radius a.
        """
        return 2.0 * self.G_star

    def total(self, depth: np.ndarray) -> np.ndarray:
        """Load of an indenter at depths >= 0.  The array of depths can have any shape."""
        radius = self.radius(depth)
        return self.load(radius, radius)

    def stick_radius(self, displacement: float) -> float | None:
        """Stick radius after a displacement >= 0 (in u_lim) in one direction from rest.

        The stick radius is the contact radius at the depth 1 - displacement (Ciavarella, Jaeger),
        and 0.0 at full slip.  The result is None except for axisymmetric indenters.
        """
        if self.depth is None:
            return None
        if displacement >= 1.0:
            return 0.0
        return float(self.radius(1.0 - displacement))


@dataclass(frozen=True)
class RoundPressure(Pressure):
    """Base class of pressures that depend on the radius alone.  They are computed from integrals
    over rings.

    A subclass defines `ring_loads` and `ring_moments`.  They integrate the friction bound, and the
    bound times the radius, over the rings with the edges r = sin(psi).  psi has the shape (n + 1,),
    and the result has the shape (n,).
    """

    def ring_loads(self, psi: np.ndarray) -> np.ndarray:
        raise NotImplementedError

    def ring_moments(self, psi: np.ndarray) -> np.ndarray:
        raise NotImplementedError

    def ring_means(self, psi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Mean friction bound and lever arm of the rings with the edges r = sin(psi)."""
        loads, moments, radii = self.ring_loads(psi), self.ring_moments(psi), np.sin(psi)
        # a ring without load needs a lever arm as well
        lever = np.where(loads > 0.0, moments / np.where(loads > 0.0, loads, 1.0), radii[1:])
        return loads / (np.pi * np.diff(radii**2)), lever

    def cell_loads(self, cells: int) -> np.ndarray:
        """Compute the load on each square, (cells, cells)."""
        return round_loads(cells, self.ring_loads, self.inner)


def _numbers(name: str, values: Any) -> np.ndarray:
    """Convert an argument to an array of floats.  Raises an InputError that names the argument."""
    try:
        return np.ascontiguousarray(values, float)
    except (TypeError, ValueError):
        raise InputError(name, values, "allowed is an array of numbers") from None


@dataclass(frozen=True, eq=False)
class Measured(spec.NamedByText, Pressure):
    """A pressure given by values on a grid, see `Pressure.from_array`.

    The unit of length a is half the longer side of the smallest rectangle that contains all
    pressure.  Rotations are about the centre of this rectangle.

    Attributes
    ----------
    text : str
        Name of the pressure, with a digest of the values.
    grid : grid.Grid
        The values, divided by the largest one.  The unit of the axes is the longer step.
    step, peak : float
        The longer step and the largest value, in the units of the coordinates and the values.
    units : tuple
        Units of the coordinates and of the values, see Units.
    """

    text: str
    grid: Grid
    step: float = 1.0
    peak: float = 1.0
    units: Units = NO_UNITS
    readings: tuple[Measured, ...] = ()

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
        """Create a pressure with this name.  The readings are the pressures of the same values with
        the other meaning in `grid.READINGS`, and with half the resolution.

        Raises InputError as `grid.checked` does.
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
        """Compute the load on each square, (cells, cells)."""
        edges = np.arange(cells + 1) * 2.0 / cells - 1.0
        return of_loads(self.grid.loads(*(side.middle + side.half * edges for side in self._sides)))

    @cached_property
    def G_star(self) -> float:
        fine = min(max(FINE, *self.grid.values.shape), FINEST)
        return largest_displacement(self.cell_loads(fine), *self.half_widths)

    @cached_property
    def torque(self) -> float:
        """Mean distance from the centre, weighted with the pressure.  It is exact for cells."""
        edges = [side.edges(-(-FINE // side.steps)) for side in self._sides]
        loads = self.grid.loads(*edges)
        pairs = zip(edges, self._sides, strict=True)
        x, y = ((one - side.middle) / self._half for one, side in pairs)
        return float(
            np.sum(loads * distances(x, y) / (np.diff(x)[:, None] * np.diff(y))) / loads.sum()
        )

    @property
    def area(self) -> float:
        """Area of the cells under pressure, divided by a^2."""
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
        """Half the longer side of the contact, in m; None if the coordinates have no unit."""
        metre = self.units[0]
        return None if metre is None else self._half * self.step * metre

    @property
    def load_N(self) -> float | None:
        """Integral of the pressure over the contact, in N; None without units."""
        metre, pascal = self.units
        if metre is None or pascal is None:
            return None
        return self._total * self.peak * pascal * (self.step * metre) ** 2
