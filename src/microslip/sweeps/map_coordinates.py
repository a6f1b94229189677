"""Coordinates in which a map is even: kinks at borders of patches, velocities by their powers.

A map over velocity and amplitude, and perhaps Poisson's ratio, is cut into patches at the kinks
that its motion is known to have (theory.kinks).  In the scaled coordinates patches are unit boxes.
Where velocities are slower than the kink they are even in the power 1/3, half of that with which
friction comes close to its static limit; amplitudes are cut at their kinks and gather there, and
where the oscillation sets in.  Where they are faster, velocities are even in the logarithm, and
amplitudes, whose kinks are gone, in that of 1 + 2 A.
"""

from __future__ import annotations

import json
from typing import NamedTuple

import numpy as np

from microslip.foundation.canonical import canonical_json
from microslip.theory.kinks import Kinks, kink_velocity

DIGITS = 9
"""Significant digits of the quantities at a node."""
CLEAR = 2.0
"""A kink of the velocity is a border where it is this factor within the range."""
SLOW_POWER = 1.0 / 3.0
"""Of the velocity, below its kink."""
FAST = 2.0
"""Scaled velocity where what is faster than the kink begins: 1 is where what is slower ends."""
FAST_PATCHES = 2
"""Into which that is cut along the velocity: friction may rise too steeply for fewer nodes."""
AT_KINKS, AT_ONSET = 2.0, 1.5
"""Powers with which places gather at kinks of the amplitude, and at the amplitude 0."""
SPREAD = 2.0
"""Above the kink of the velocity, amplitudes are even in log(1 + SPREAD A)."""
DEGREES = {"velocity": 4, "amplitude": 4, "poisson": 2}
"""Of the polynomials in a cell; friction is nearly straight over Poisson's ratio."""

Box = tuple[tuple[float, ...], tuple[float, ...]]
"""Lower and upper ends of a box in scaled coordinates, by direction."""


class MapCoordinates(NamedTuple):
    """The range of a map, and where it is cut; all dimensionless.

    Attributes
    ----------
    velocity : tuple of float
        Smallest and largest, above 0.
    amplitude : tuple of float
        Smallest and largest, >= 0.
    kinks : theory.kinks.Kinks
        Of the motion.
    poisson : tuple of float
        Smallest and largest Poisson's ratio; () where it is no direction of the map.
    """

    velocity: tuple[float, float]
    amplitude: tuple[float, float]
    kinks: Kinks = Kinks()
    poisson: tuple[float, ...] = ()

    @property
    def directions(self) -> tuple[str, ...]:
        """Names of the quantities that the map is over, in the order of scaled coordinates."""
        return ("velocity", "amplitude", "poisson")[: 3 if self.poisson else 2]

    @property
    def degrees(self) -> tuple[int, ...]:
        """Of the polynomials in a cell, by direction."""
        return tuple(DEGREES[name] for name in self.directions)

    @property
    def patches(self) -> list[Box]:
        """Boxes in scaled coordinates that cover the map, those of slow velocities first."""
        flat = [((0.0, float(row)), (1.0, row + 1.0)) for row in range(len(self._borders) - 1)]
        if self._is_cut:
            ends = [FAST + i / FAST_PATCHES for i in range(FAST_PATCHES + 1)]
            flat += [((x, 0.0), (right, 1.0)) for x, right in zip(ends, ends[1:], strict=False)]
        deep = len(self.directions) - 2
        return [(begin + (0.0,) * deep, end + (1.0,) * deep) for begin, end in flat]

    @classmethod
    def from_json(cls, text: str) -> MapCoordinates:
        """What `to_json` made a text of."""
        given = json.loads(text)
        kinks = Kinks(*(tuple(given[name]) for name in ("kink_amplitudes", "kink_velocity")))
        ranges = (tuple(given[name]) for name in ("velocity", "amplitude"))
        return cls(*ranges, kinks, tuple(given["poisson"]))

    def to_json(self) -> str:
        """The coordinates as a text, for the attribute of a dataset."""
        ranges = {name: getattr(self, name) for name in DEGREES}
        kinks = {"kink_amplitudes": self.kinks.amplitudes, "kink_velocity": self.kinks.velocity}
        return canonical_json(ranges | kinks)

    def scaled(self, *places: np.ndarray) -> np.ndarray:
        """Scaled coordinates, shape (n, directions), of places in the range.

        places: by direction, velocities first, shape (n,) each.
        """
        v, a, *rest = (np.asarray(part, float) for part in places)
        x, y = _share(np.log(v), np.log(self.velocity)), self._rows(a)
        if self._is_cut:
            middle, (slow, fast) = self._cut_at(a), self.velocity
            is_slow = v <= middle
            below = _share(v**SLOW_POWER, (slow**SLOW_POWER, middle**SLOW_POWER))
            above = FAST + _share(np.log(v), (np.log(middle), np.log(fast)))
            x = np.where(is_slow, below, above)
            y = np.where(is_slow, y, _share(_spread(a), _spread(np.array(self.amplitude))))
        return np.stack([x, y, *(_share(nu, self.poisson) for nu in rest)], axis=-1)

    def place(self, node: tuple[float, ...]) -> tuple[float, ...]:
        """Velocity, amplitude and what else is a direction at scaled coordinates, in DIGITS."""
        x, y, *rest = node
        slow, fast = self.velocity
        if self._is_cut and x >= FAST:
            amplitude = _gathered_small(_between(y, _spread(np.array(self.amplitude))))
            velocity = np.exp(_between(x - FAST, np.log([self._cut_at(amplitude), fast])))
        elif self._is_cut:
            amplitude = self._amplitude_at(y)
            ends = slow**SLOW_POWER, self._cut_at(amplitude) ** SLOW_POWER
            velocity = _between(x, ends) ** (1.0 / SLOW_POWER)
        else:
            amplitude = self._amplitude_at(y)
            velocity = np.exp(_between(x, np.log(self.velocity)))
        found = velocity, amplitude, *(_between(z, self.poisson) for z in rest)
        return tuple(_rounded(value) for value in found)

    @property
    def _borders(self):
        low, high = self.amplitude
        return (low, *(a for a in self.kinks.amplitudes if low < a < high), high)

    @property
    def _is_cut(self):
        slow, fast = self.velocity
        if not self.kinks.velocity or fast <= CLEAR**2 * slow:
            return False
        at_ends = kink_velocity(self.kinks, np.array(self.amplitude))
        return bool(at_ends.max() > CLEAR * slow and at_ends.min() < fast / CLEAR)

    def _cut_at(self, amplitude):
        slow, fast = self.velocity
        return np.clip(kink_velocity(self.kinks, amplitude), CLEAR * slow, fast / CLEAR)

    def _rows(self, amplitude):
        """Scaled amplitudes where the map is cut at kinks."""
        y = np.empty_like(amplitude)
        for row, (low, high) in enumerate(zip(self._borders, self._borders[1:], strict=False)):
            here = (amplitude >= low) & (amplitude <= high)
            share = _share(amplitude[here], (low, high))
            y[here] = row + _even(share, self._steepness(low), self._steepness(high))
        return y

    def _amplitude_at(self, y):
        """The inverse of _rows."""
        row = min(int(y), len(self._borders) - 2)
        low, high = self._borders[row : row + 2]
        return _between(
            _gathered(y - row, self._steepness(low), self._steepness(high)), (low, high)
        )

    def _steepness(self, amplitude):
        """The power with which places gather at a border of the amplitude."""
        if amplitude in self.kinks.amplitudes:
            return AT_KINKS
        return AT_ONSET if amplitude == 0.0 else 1.0


def _share(value, ends):
    """Where a value lies between two ends, 0 to 1 whatever rounding does."""
    return np.clip((value - ends[0]) / (ends[1] - ends[0]), 0.0, 1.0)


def _between(share, ends):
    return ends[0] + (ends[1] - ends[0]) * share


def _spread(amplitude):
    return np.log1p(SPREAD * amplitude)


def _gathered_small(spread):
    """The inverse of _spread."""
    return np.expm1(spread) / SPREAD


def _gathered(s, low, high):
    """From an even coordinate, 0 to 1, to the share of a patch: places gather at its steep ends."""
    if low > 1.0 and high > 1.0:
        return s * s * (3.0 - 2.0 * s)
    return s**low if high == 1.0 else 1.0 - (1.0 - s) ** high


def _even(share, low, high):
    """The inverse of _gathered."""
    share = np.clip(share, 0.0, 1.0)
    if low > 1.0 and high > 1.0:
        return 0.5 - np.sin(np.arcsin(1.0 - 2.0 * share) / 3.0)
    return share ** (1.0 / low) if high == 1.0 else 1.0 - (1.0 - share) ** (1.0 / high)


def _rounded(value):
    return float(f"{value:.{DIGITS}g}")
