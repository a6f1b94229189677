"""Pressures: distribution of the load, and with it the friction bound of a point.

Working units, dimensionless: a = 1 (outer radius, or half the longer side of what bounds the
contact), mu F_z = 1 and u_lim = 1.  Here u_lim is the largest displacement that full slip of the
whole contact causes anywhere, by its mean compliance over the directions,

    u_lim = max of 1/(pi G*) Integral mu p(z') / |z - z'| dA',

which for every indenter pressed to a depth d is mu d E*/G*, the usual 3 mu F_z/(4 G* a) for a
sphere.  The contact of a round body slides everywhere from u_lim on, pushed in one direction from
rest, and so does any contact at nu = 0.  Others at nu > 0 do so some percent before or after, by
direction.
In these units the stiffness is the number G*, 3/4 for a sphere.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from microslip.foundation import spec
from microslip.foundation.errors import InputError
from microslip.pressures.cell_loads import round_loads
from microslip.pressures.grid import READINGS, Grid, read_grids


@dataclass(frozen=True)
class Pressure:
    """One distribution of the load over the contact; dimensionless, in the working units above.

    Each pressure is a subclass in a file of its own.  Its fields are the numbers that may follow
    its name, as in "power:exponent=1", which `str` writes back.

    Attributes
    ----------
    summary : str
        Description in a line.
    G_star : float
        Reduced shear modulus 4G/(2 - nu).
    torque : float
        Torque at full slip about the centre, in mu F_z a.
    largest : float
        Largest friction bound, or infinity; largest pressure over F_z / a^2.
    mirrored : bool
        Whether it is its own image under lateral -> -lateral.
    inner : float
        Radius of the hole in the middle.
    hertzian : bool
        Whether it is that of an elliptic Hertz contact, whose stick zones are ellipses of the same
        shape (Vermeulen and Johnson), so that it shares `loading` with the sphere.
    readings : tuple of Pressure
        Other pressures that the same numbers of a measured grid may stand for: the change of
        friction under them is what the grid leaves open.
    """

    mirrored: ClassVar[bool] = True
    hertzian: ClassVar[bool] = False

    # Of pressures that depend on the radius alone:
    ring_means: ClassVar[Any] = None
    """ring_means(psi) -> (bound, lever): mean friction bound of the rings between r = sin(psi), and
    mean lever arm of a traction shaped like it, shape (n,) each, from (n + 1,)."""
    bound: ClassVar[Any] = None
    """bound(r): friction bound mu p, of arrays; of an indenter bound(r, c), too."""

    # Of axisymmetric indenters, which touch a full circle that grows with the load:
    depth: ClassVar[Any] = None
    """depth(c): indentation that makes the contact radius c, 1 at 1."""
    radius: ClassVar[Any] = None
    """radius(depth): inverse of `depth`, 0 for no contact."""
    of_load: ClassVar[Any] = None
    """of_load(share): depth at which the load is that share of the mean one."""
    load: ClassVar[Any] = None
    """load(r, c): load within r; of arrays that broadcast."""

    loading: ClassVar[Any] = None
    """loading(u): tangential force over mu F_z after a displacement u_lim >= 0 in one direction
    from rest, nu = 0, of any shape; of axisymmetric indenters and elliptic Hertz contacts."""

    def __post_init__(self) -> None:
        spec.refuse_strange(self, "pressure")

    @staticmethod
    def from_array(
        forward: np.ndarray, lateral: np.ndarray, pressure: np.ndarray, *, grid: str = "cells"
    ) -> Measured:
        """The pressure of values on a regular grid.

        a is half the longer side of the rectangle that holds all pressure.  The grid leaves open
        how the pressure varies between the points; the effect on friction is part of the error.

        Parameters
        ----------
        forward, lateral : array, shapes (n,) and (m,)
            Coordinates, increasing, in one unit of length.
        pressure : array, shape (n, m)
            In any unit, 0 outside the contact.
        grid : str
            "cells": values are means over cells around the points; "samples": values at the points,
            with bilinear interpolation between them.

        Raises
        ------
        InputError
            For what is no array of numbers, coordinates that are not regular, values below 0 or not
            finite, a load that is 0.
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
    def summary(self) -> str:
        return ""

    @property
    def inner(self) -> float:
        return 0.0

    @property
    def readings(self) -> tuple[Pressure, ...]:
        return ()

    @property
    def name(self) -> str:
        """Name with the numbers that differ from their defaults."""
        return spec.text_of(self)

    def __str__(self) -> str:
        return self.name

    @property
    def G_star(self) -> float:
        raise NotImplementedError

    @property
    def torque(self) -> float:
        raise NotImplementedError

    @property
    def largest(self) -> float:
        raise NotImplementedError

    def cell_loads(self, cells: int) -> np.ndarray:
        """Load on each of cells x cells squares over [-1, 1]^2, forward axis first, sum 1."""
        raise NotImplementedError

    @property
    def is_round(self) -> bool:
        """Whether it depends on the radius alone."""
        return self.ring_means is not None

    @property
    def is_indenter(self) -> bool:
        """Whether it is that of an axisymmetric indenter."""
        return self.depth is not None

    @property
    def stiffness(self) -> float:
        """Force over mu F_z per uniform displacement u_lim without slip, 2 G* a; of a contact that
        does not fill the circle of radius a an upper bound."""
        return 2.0 * self.G_star

    def total(self, depth: np.ndarray) -> np.ndarray:
        """Load of an indenter at a depth >= 0, any shape."""
        radius = self.radius(depth)
        return self.load(radius, radius)

    def stick_radius(self, displacement: float) -> float | None:
        """Stick radius after a displacement (u_lim) in one direction from rest: that of the contact
        whose indentation is less by this share (Ciavarella, Jaeger); None if it is not known, and
        0.0 where all slides.  displacement >= 0: a float."""
        if self.depth is None:
            return None
        if displacement >= 1.0:
            return 0.0
        return float(self.radius(1.0 - displacement))


@dataclass(frozen=True)
class RoundPressure(Pressure):
    """Base class of pressures that depend on the radius alone, from integrals over rings.

    A subclass gives `ring_loads` and `ring_moments`: integrals of the friction bound, and of the
    bound times the radius, over the rings between r = sin(psi); shape (n,) from (n + 1,).
    """

    def ring_loads(self, psi: np.ndarray) -> np.ndarray:
        raise NotImplementedError

    def ring_moments(self, psi: np.ndarray) -> np.ndarray:
        raise NotImplementedError

    def ring_means(self, psi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Mean friction bound and lever arm of the rings between r = sin(psi)."""
        loads, moments, radii = self.ring_loads(psi), self.ring_moments(psi), np.sin(psi)
        # a ring without load needs a lever arm as well
        lever = np.where(loads > 0.0, moments / np.where(loads > 0.0, loads, 1.0), radii[1:])
        return loads / (np.pi * np.diff(radii**2)), lever

    def cell_loads(self, cells: int) -> np.ndarray:
        """Load on each square, (cells, cells)."""
        return round_loads(cells, self.ring_loads, self.inner)


def _numbers(name: str, values: Any) -> np.ndarray:
    """The argument of this name as an array of floats."""
    try:
        return np.ascontiguousarray(values, float)
    except (TypeError, ValueError):
        raise InputError(name, values, "allowed is an array of numbers") from None


@dataclass(frozen=True, eq=False)
class Measured(Pressure):
    """A pressure known on a grid alone, see `Pressure.from_array`.

    Attributes
    ----------
    text : str
        Its name, with a digest of the values.
    grid : grid.Grid
        The values.
    """

    text: str
    grid: Grid
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
    ) -> Measured:
        """The pressure of a name; the other arguments are those of `grid.read_grids`."""
        grids = read_grids(forward, lateral, values, reading)
        grid = grids.pop("")
        return cls(name, grid, tuple(cls(f"{name} ({kind})", one) for kind, one in grids.items()))

    @property
    def name(self) -> str:
        """Name with a digest of the values."""
        return self.text

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Measured) and self.text == other.text

    def __hash__(self) -> int:
        return hash(self.text)

    @cached_property
    def G_star(self) -> float:
        return self.grid.reduced_modulus()

    @cached_property
    def torque(self) -> float:
        return self.grid.mean_distance()

    @cached_property
    def largest(self) -> float:
        return self.grid.largest()

    def cell_loads(self, cells: int) -> np.ndarray:
        """Load on each square, (cells, cells)."""
        return self.grid.cell_loads(cells)
