"""Scaled coordinates of a map of friction.

The axes of a map are velocity, amplitude and, optionally, Poisson's ratio.  A map of the static
limit has no velocity axis.  A map is divided into patches at the known kinks of the motion
(theory.exact).  Each patch is a box in scaled coordinates.  Below the velocity of the kink, the
scaled velocity is proportional to velocity^(1/3).  The square of this coordinate is proportional to
the difference between friction and the static limit.  At these velocities, the amplitude axis is
divided where friction has a kink, and nodes are clustered at the kinks.  Above the velocity of the
kink, the scaled velocity is logarithmic.  Where there are no kinks, the scaled amplitude is
log(1 + 2 A), where A is the amplitude.
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
"""Number of significant digits in the coordinates of a node."""
CLEAR = 2.0
"""Smallest allowed ratio between the velocity of a kink and an end of the velocity range.  A kink
that is closer to an end does not divide the map."""
SLOW_POWER = 1.0 / 3.0
"""Exponent of the velocity in the scaled coordinate below the kink."""
FAST = 2.0
"""Scaled velocity just above the kink.  Just below the kink, the scaled velocity is 1."""
FAST_PATCHES = 2
"""Number of patches along the velocity above the kink.  With fewer patches, the nodes may not
resolve a steep rise of friction."""
SPREAD = 2.0
"""Coefficient c in the scaled amplitude log(1 + c A).  This scaling is used where there are no
kinks."""
DEGREES = {"velocity": 4, "amplitude": 4, "poisson": 2}
"""Degrees of the polynomials in a cell.  The degree along Poisson's ratio is low, because friction
is nearly linear in Poisson's ratio."""

Box = tuple[tuple[float, ...], tuple[float, ...]]
"""Lower and upper ends of a box in scaled coordinates, for each direction."""


class Scale(NamedTuple):
    """A monotone function and its inverse.  The values of the function at the nodes are evenly
    spaced."""

    forward: Callable
    back: Callable

    def between(self, ends: Sequence) -> Scale:
        """Return a copy of this scale, mapped linearly so that the scaled value is 0 at the first
        end and 1 at the second end."""
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
"""Scales of relative positions.  A key is a pair of flags: whether nodes are clustered at the lower
end, and whether they are clustered at the upper end."""


class MapCoordinates(NamedTuple):
    """Range and patches of a map.  All values are dimensionless.

    Attributes
    ----------
    velocity : tuple of float
        Smallest and largest velocity, both above 0; () for a map of the static limit.
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
        """Degree, along each direction, of the polynomials in cells."""
        return tuple(DEGREES[name] for name in self.directions)

    @property
    def patches(self) -> list[Box]:
        """Boxes that cover the map in scaled coordinates, ordered from low to high velocity."""
        boxes = [((0.0, float(y)), (1.0, y + 1.0)) for y in range(len(self._rows))]
        if self._cut:
            ends = np.linspace(FAST, FAST + 1.0, FAST_PATCHES + 1).tolist()
            boxes += [((low, 0.0), (high, 1.0)) for low, high in pairwise(ends)]
        first = 0 if self.velocity else 1
        low, high = ((0.0,), (1.0,)) if self.poisson else ((), ())
        return [(begin[first:] + low, end[first:] + high) for begin, end in boxes]

    @classmethod
    def from_json(cls, text: str) -> MapCoordinates:
        """Read the coordinates from the JSON string that `to_json` returns."""
        velocity, (low, high), kinks, poisson = json.loads(text)
        return cls(tuple(velocity), (low, high), Kinks(*map(tuple, kinks)), tuple(poisson))

    def to_json(self) -> str:
        """Return the coordinates as a JSON string for the attribute of a dataset."""
        return canonical_json(self)

    def scaled(self, *places: np.ndarray) -> np.ndarray:
        """Return the scaled coordinates of n points, as an array of shape (n, directions).

        places: coordinates of the points, one array of shape (n,) for each direction, velocities
        first.
        """
        at = dict(zip(self.directions, map(np.asarray, places), strict=True))
        a = np.clip(at["amplitude"], *self.amplitude)
        at["amplitude"] = y = np.empty_like(a)
        for row, (ends, scale) in enumerate(self._rows):
            here = (a >= ends[0]) & (a <= ends[1])
            y[here] = row + scale.forward(a[here])
        if self.velocity:
            v = np.clip(at["velocity"], self.velocity[0], self.velocity[1])
            at["velocity"] = x = self._speeds(False, a).forward(v)
            if cut := self._cut:
                fast = v > cut(a)
                x[fast] = FAST + self._speeds(True, a[fast]).forward(v[fast])
                y[fast] = EVEN.between(self.amplitude).forward(a[fast])
        if self.poisson:
            at["poisson"] = LINEAR.between(self.poisson).forward(at["poisson"])
        return np.stack([at[name] for name in self.directions], axis=-1)

    def place(self, node: tuple[float, ...]) -> tuple[float, ...]:
        """Return the velocity, amplitude and Poisson's ratio at scaled coordinates, rounded to
        DIGITS digits."""
        at = dict(zip(self.directions, node, strict=True))
        x, y = at.get("velocity", 0.0), at["amplitude"]
        fast, rows = x >= FAST, self._rows
        row = 0 if fast else min(int(y), len(rows) - 1)
        scale = EVEN.between(self.amplitude) if fast else rows[row][1]
        at["amplitude"] = scale.back(y - row)
        if self.velocity:
            at["velocity"] = self._speeds(fast, at["amplitude"]).back(x - FAST * fast)
        if self.poisson:
            at["poisson"] = LINEAR.between(self.poisson).back(at["poisson"])
        return tuple(float(f"{at[name]:.{DIGITS}g}") for name in self.directions)

    @property
    def _rows(self) -> list[tuple[tuple[float, float], Scale]]:
        """Ends and scale of each range of amplitudes between two kinks.  These ranges apply to
        velocities below the velocity of the kink.  An amplitude at a kink belongs to the range
        above it."""
        low, high = self.amplitude
        borders = (low, *(a for a in self.kinks.amplitudes if low < a < high), high)
        return [(ends, self._row_scale(ends)) for ends in pairwise(borders)]

    @property
    def _cut(self) -> Callable | None:
        """Function that returns the velocity of the kink at an amplitude.  The velocity is clipped
        to the range from the smallest velocity times CLEAR to the largest velocity divided by
        CLEAR.  The value is None if no kink divides the map."""
        if not (self.velocity and self.kinks.velocity):
            return None
        low, high = CLEAR * self.velocity[0], self.velocity[1] / CLEAR
        at_ends = kink_velocity(self.kinks, np.array(self.amplitude))
        if not (low < high and at_ends.max() > low and at_ends.min() < high):
            return None
        return lambda amplitude: np.clip(kink_velocity(self.kinks, amplitude), low, high)

    def _speeds(self, fast: bool, amplitude: Any) -> Scale:
        """Return the scale of the velocity at an amplitude.  If `fast` is True, the scale applies
        above the velocity of the kink; otherwise, the scale applies below this velocity."""
        if not (cut := self._cut):
            return LOG.between(self.velocity)
        slowest, fastest = self.velocity
        if fast:
            return LOG.between((cut(amplitude), fastest))
        return SLOW.between((slowest, cut(amplitude)))

    def _row_scale(self, ends: tuple[float, float]) -> Scale:
        """Return the scale of the amplitudes between two borders.

        Nodes are clustered at kinks and, if the upper border is a kink, also at the amplitude 0.
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
