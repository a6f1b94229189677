"""Scaled coordinates of a map of friction.

The axes of a map are velocity and amplitude, and optionally Poisson's ratio; a map of the static
limit has no velocity.  A map is divided into patches at the known kinks of the motion
(theory.exact).  Patches are boxes in scaled coordinates.  Below the velocity of the kink, the
scaled velocity is proportional to velocity^(1/3).  Friction approaches its static limit with twice
this exponent.  In this range, amplitudes are divided at their kinks, and nodes are clustered at the
kinks.  Above the velocity of the kink, the scaled velocity is logarithmic.  Where there are no
kinks, amplitudes are scaled by log(1 + 2 A).
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from microslip.foundation.canonical import canonical_json
from microslip.theory.exact import Kinks, kink_velocity

DIGITS = 9
"""Number of significant digits in a node's coordinates."""
CLEAR = 2.0
"""Smallest ratio between a kink's velocity and either end of the velocity range.  Closer kinks do
not divide the map."""
SLOW_POWER = 1.0 / 3.0
"""Power of the velocity in the scaled coordinate below the kink."""
FAST = 2.0
"""Scaled velocity just above the kink; just below the kink it is 1."""
FAST_PATCHES = 2
"""Number of patches along the velocity above the kink.  With fewer patches, the nodes may not
resolve a steep rise of friction."""
SPREAD = 2.0
"""Where there are no kinks, amplitudes are evenly spaced in log(1 + SPREAD A)."""
DEGREES = {"velocity": 4, "amplitude": 4, "poisson": 2}
"""Degrees of the polynomials in a cell; friction is nearly linear in Poisson's ratio."""

Box = tuple[tuple[float, ...], tuple[float, ...]]
"""Lower and upper ends of a box in scaled coordinates, by direction."""


class Scale(NamedTuple):
    """A monotone function and its inverse.  Nodes are evenly spaced in the function's values."""

    forward: Callable
    back: Callable

    def between(self, ends: Sequence) -> Scale:
        """Return the scale whose function is 0 and 1 at two ends."""
        low, high = map(self.forward, ends)
        return Scale(
            lambda value: np.clip((self.forward(value) - low) / (high - low), 0.0, 1.0),
            lambda share: self.back(low + (high - low) * share),
        )


LOG = Scale(np.log, np.exp)
SLOW = Scale(lambda v: v**SLOW_POWER, lambda x: x ** (1.0 / SLOW_POWER))
EVEN = Scale(lambda a: np.log1p(SPREAD * a), lambda x: np.expm1(x) / SPREAD)
LINEAR = Scale(lambda nu: nu, lambda x: x)
CLUSTERS = {
    (True, False): Scale(np.sqrt, np.square),
    (False, True): Scale(lambda s: 1.0 - np.sqrt(1.0 - s), lambda x: 1.0 - (1.0 - x) ** 2),
    (True, True): Scale(
        lambda s: 0.5 - np.sin(np.arcsin(1.0 - 2.0 * s) / 3.0), lambda x: x * x * (3.0 - 2.0 * x)
    ),
}
"""Scales of relative positions, by whether nodes are clustered at the lower and the upper end."""


class Band(NamedTuple):
    """A part of a map with one scale along each axis.

    Attributes
    ----------
    x, y : float
        Smallest scaled velocity and amplitude.  The band is 1 wide along each direction.
    velocity, amplitude : Scale
        Scale of the velocity, and scale of the amplitude between the ends of the band.
    speeds : callable
        Function of the amplitude that returns the smallest and the largest velocity.
    ends : tuple of float
        Smallest and largest amplitude.
    patches : int
        Number of patches along the velocity.
    """

    x: float
    y: float
    velocity: Scale
    amplitude: Scale
    speeds: Callable[[Any], tuple]
    ends: tuple[float, float]
    patches: int = 1


class MapCoordinates(NamedTuple):
    """Range and patches of a map.  All values are dimensionless.

    Attributes
    ----------
    velocity : tuple of float
        Smallest and largest velocity, above 0; () for a map of the static limit.
    amplitude : tuple of float
        Smallest and largest amplitude, at least 0.
    kinks : theory.exact.Kinks
        Kinks of the motion.
    poisson : tuple of float
        Smallest and largest Poisson's ratio; () if Poisson's ratio is not a direction of the map.
    """

    velocity: tuple[float, ...]
    amplitude: tuple[float, float]
    kinks: Kinks = Kinks()
    poisson: tuple[float, ...] = ()

    @property
    def directions(self) -> tuple[str, ...]:
        """Names of the map's axes, in the order of scaled coordinates."""
        return tuple(name for name in DEGREES if getattr(self, name))

    @property
    def degrees(self) -> tuple[int, ...]:
        """Degrees of the polynomials in a cell, by direction."""
        return tuple(DEGREES[name] for name in self.directions)

    @property
    def patches(self) -> list[Box]:
        """Boxes in scaled coordinates that cover the map, slow velocities first."""
        boxes = []
        for band in self._bands:
            for ends_of_x in pairwise(np.linspace(band.x, band.x + 1.0, band.patches + 1).tolist()):
                ends = {"velocity": ends_of_x, "amplitude": (band.y, band.y + 1.0)}
                ends["poisson"] = (0.0, 1.0)
                begin, end = zip(*(ends[name] for name in self.directions), strict=True)
                boxes.append((begin, end))
        return sorted(boxes)

    @classmethod
    def from_json(cls, text: str) -> MapCoordinates:
        """Read the coordinates from the JSON text of `to_json`."""
        velocity, (low, high), kinks, poisson = json.loads(text)
        return cls(tuple(velocity), (low, high), Kinks(*map(tuple, kinks)), tuple(poisson))

    def to_json(self) -> str:
        """Return the coordinates as JSON text for the attribute of a dataset."""
        return canonical_json(self)

    def scaled(self, *places: np.ndarray) -> np.ndarray:
        """Scaled coordinates, shape (n, directions), of points in the range.

        places: coordinates of the points, one array of shape (n,) for each direction, velocities
        first.
        """
        at = dict(zip(self.directions, map(np.asarray, places), strict=True))
        a = np.clip(at["amplitude"], *self.amplitude)
        slowest, fastest = self.velocity or (0.0, 0.0)
        v = np.clip(at["velocity"], slowest, fastest) if self.velocity else np.zeros_like(a)
        x, y = np.empty_like(a), np.empty_like(a)
        for band in self._bands:
            low, high = (np.broadcast_to(end, a.shape) for end in band.speeds(a))
            here = (a >= band.ends[0]) & (a <= band.ends[1]) & (v >= low) & (v <= high)
            y[here] = band.y + band.amplitude.forward(a[here])
            if self.velocity:
                speeds = band.velocity.between((low[here], high[here]))
                x[here] = band.x + speeds.forward(v[here])
        scaled = {"velocity": x, "amplitude": y}
        if self.poisson:
            scaled["poisson"] = LINEAR.between(self.poisson).forward(at["poisson"])
        return np.stack([scaled[name] for name in self.directions], axis=-1)

    def place(self, node: tuple[float, ...]) -> tuple[float, ...]:
        """Return the values of velocity, amplitude and Poisson's ratio at scaled coordinates,
        rounded to DIGITS digits."""
        at = dict(zip(self.directions, node, strict=True))
        x, y = at.get("velocity", 0.0), at["amplitude"]
        bands = [band for band in self._bands if (band.x == FAST) == (x >= FAST)]
        band = bands[min(int(y), len(bands) - 1)]
        at["amplitude"] = band.amplitude.back(y - band.y)
        if self.velocity:
            speeds = band.velocity.between(band.speeds(at["amplitude"]))
            at["velocity"] = speeds.back(x - band.x)
        if self.poisson:
            at["poisson"] = LINEAR.between(self.poisson).back(at["poisson"])
        return tuple(float(f"{at[name]:.{DIGITS}g}") for name in self.directions)

    @property
    def _bands(self) -> list[Band]:
        """Bands of the map: first the band above the velocity of the kink, if a kink exists, then a
        band for each range of amplitudes.  A point at the border of two bands belongs to the later
        one."""
        low, high = self.amplitude
        borders = (low, *(a for a in self.kinks.amplitudes if low < a < high), high)
        slowest, fastest = self.velocity or (0.0, 0.0)
        fast: list[Band] = []
        scale = LOG
        if self._is_cut:
            even = EVEN.between(self.amplitude)
            above = FAST, 0.0, LOG, even, lambda a: (self._cut_at(a), fastest), self.amplitude
            fast, scale = [Band(*above, FAST_PATCHES)], SLOW

        def speeds(amplitude: Any) -> tuple:
            return slowest, self._cut_at(amplitude) if self._is_cut else fastest

        return fast + [
            Band(0.0, float(y), scale, self._row_scale(ends), speeds, ends)
            for y, ends in enumerate(pairwise(borders))
        ]

    @property
    def _is_cut(self) -> bool:
        if not (self.velocity and self.kinks.velocity):
            return False
        slow, fast = self.velocity
        at_ends = kink_velocity(self.kinks, np.array(self.amplitude))
        inside = bool(at_ends.max() > CLEAR * slow and at_ends.min() < fast / CLEAR)
        return inside and fast > CLEAR**2 * slow

    def _cut_at(self, amplitude: np.ndarray | float) -> np.ndarray:
        slow, fast = self.velocity
        return np.clip(kink_velocity(self.kinks, amplitude), CLEAR * slow, fast / CLEAR)

    def _row_scale(self, ends: tuple[float, float]) -> Scale:
        """Scale of the amplitudes between two borders.

        Nodes are clustered at kinks and, in a row below a kink, at the amplitude 0.
        """
        low, high = ends
        below, above = (end in self.kinks.amplitudes for end in ends)
        if not (below or above):
            return EVEN.between(ends)
        cluster = CLUSTERS[below or low == 0.0, above]
        return Scale(
            lambda a: cluster.forward((a - low) / (high - low)),
            lambda x: low + (high - low) * cluster.back(x),
        )
