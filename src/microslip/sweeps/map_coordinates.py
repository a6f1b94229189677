"""Scaled coordinates of a map of friction.

The axes of a map are velocity and amplitude, and optionally Poisson's ratio; a map of the static
limit has no velocity.  A map is divided into patches at the known kinks of the motion
(theory.kinks).  Patches are boxes in scaled coordinates.  Below the velocity of the kink, the
scaled velocity is proportional to velocity^(1/3).  Friction approaches its static limit with twice
this exponent.  In this range, amplitudes are divided at their kinks, and nodes are clustered at the
kinks.  Above the velocity of the kink, the scaled velocity is logarithmic.  Where there are no
kinks, amplitudes are scaled by log(1 + 2 A).
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from microslip.foundation.canonical import canonical_json
from microslip.theory.kinks import Kinks, kink_velocity

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
AT_KINKS = 2.0
"""Exponent that clusters nodes at kinks of the amplitude."""
SPREAD = 2.0
"""Where there are no kinks, amplitudes are evenly spaced in log(1 + SPREAD A)."""
DEGREES = {"velocity": 4, "amplitude": 4, "poisson": 2}
"""Degrees of the polynomials in a cell; friction is nearly linear in Poisson's ratio."""

Box = tuple[tuple[float, ...], tuple[float, ...]]
"""Lower and upper ends of a box in scaled coordinates, by direction."""
Ends = Sequence | np.ndarray
"""Lower and upper end of a range."""


class MapCoordinates(NamedTuple):
    """Range and patches of a map.  All values are dimensionless.

    Attributes
    ----------
    velocity : tuple of float
        Smallest and largest velocity, above 0; () for a map of the static limit.
    amplitude : tuple of float
        Smallest and largest amplitude, at least 0.
    kinks : theory.kinks.Kinks
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
        flat: list[Box] = [((float(i),), (i + 1.0,)) for i in range(len(self._borders) - 1)]
        if self.velocity:
            flat = [((0.0, *low), (1.0, *high)) for low, high in flat]
        if self._is_cut:
            ends = [FAST + i / FAST_PATCHES for i in range(FAST_PATCHES + 1)]
            flat += [((x, 0.0), (right, 1.0)) for x, right in zip(ends, ends[1:], strict=False)]
        deep = len(self.directions) - len(flat[0][0])
        return [(begin + (0.0,) * deep, end + (1.0,) * deep) for begin, end in flat]

    @classmethod
    def from_json(cls, text: str) -> MapCoordinates:
        """Read the coordinates from the JSON text of `to_json`."""
        values = json.loads(text)
        kinks = Kinks(*(tuple(values[name]) for name in ("kink_amplitudes", "kink_velocity")))
        low, high = values["amplitude"]
        return cls(tuple(values["velocity"]), (low, high), kinks, tuple(values["poisson"]))

    def to_json(self) -> str:
        """Return the coordinates as JSON text for the attribute of a dataset."""
        ranges = {name: getattr(self, name) for name in DEGREES}
        kinks = {"kink_amplitudes": self.kinks.amplitudes, "kink_velocity": self.kinks.velocity}
        return canonical_json(ranges | kinks)

    def scaled(self, *places: np.ndarray) -> np.ndarray:
        """Scaled coordinates, shape (n, directions), of points in the range.

        places: coordinates of the points, one array of shape (n,) for each direction, velocities
        first.
        """
        values = [np.asarray(part, float) for part in places]
        deep = [_share(values.pop(), self.poisson)] if self.poisson else []
        if not self.velocity:
            return np.stack([self._rows(*values), *deep], axis=-1)
        v, a = values
        x, y = _share(np.log(v), np.log(self.velocity)), self._rows(a)
        if self._is_cut:
            middle, (slow, fast) = self._cut_at(a), self.velocity
            is_slow = v <= middle
            below = _share(v**SLOW_POWER, (slow**SLOW_POWER, middle**SLOW_POWER))
            above = FAST + _share(np.log(v), (np.log(middle), np.log(fast)))
            x = np.where(is_slow, below, above)
            y = np.where(is_slow, y, _spread_share(a, self.amplitude))
        return np.stack([x, y, *deep], axis=-1)

    def place(self, node: tuple[float, ...]) -> tuple[float, ...]:
        """Return the values of velocity, amplitude and Poisson's ratio at scaled coordinates,
        rounded to DIGITS digits."""
        *flat_node, nu = node if self.poisson else (*node, 0.0)
        deep = [_between(nu, self.poisson)] if self.poisson else []
        flat = self._place(*flat_node) if self.velocity else (self._amplitude_at(*flat_node),)
        return tuple(round_digits(value) for value in (*flat, *deep))

    def _place(self, x: float, y: float) -> tuple[float, float]:
        """Return the velocity and amplitude at scaled coordinates."""
        slow, fast = self.velocity
        if self._is_cut and x >= FAST:
            amplitude = _at_spread_share(y, self.amplitude)
            ends = np.log(self._cut_at(amplitude)), np.log(fast)
            velocity = np.exp(_between(x - FAST, ends))
        elif self._is_cut:
            amplitude = self._amplitude_at(y)
            ends = slow**SLOW_POWER, self._cut_at(amplitude) ** SLOW_POWER
            velocity = _between(x, ends) ** (1.0 / SLOW_POWER)
        else:
            amplitude = self._amplitude_at(y)
            velocity = np.exp(_between(x, np.log(self.velocity)))
        return velocity, amplitude

    @property
    def _borders(self) -> tuple[float, ...]:
        low, high = self.amplitude
        return (low, *(a for a in self.kinks.amplitudes if low < a < high), high)

    @property
    def _is_cut(self) -> bool:
        if not (self.velocity and self.kinks.velocity):
            return False
        slow, fast = self.velocity
        if fast <= CLEAR**2 * slow:
            return False
        at_ends = kink_velocity(self.kinks, np.array(self.amplitude))
        return bool(at_ends.max() > CLEAR * slow and at_ends.min() < fast / CLEAR)

    def _cut_at(self, amplitude: np.ndarray | float) -> np.ndarray:
        slow, fast = self.velocity
        return np.clip(kink_velocity(self.kinks, amplitude), CLEAR * slow, fast / CLEAR)

    def _rows(self, amplitude: np.ndarray) -> np.ndarray:
        """Scaled amplitudes in a map that is divided at kinks."""
        y = np.empty_like(amplitude)
        for row, (low, high) in enumerate(zip(self._borders, self._borders[1:], strict=False)):
            here = (amplitude >= low) & (amplitude <= high)
            y[here] = row + self._even(amplitude[here], (low, high))
        return y

    def _amplitude_at(self, y: float) -> float:
        """Convert a scaled amplitude to an amplitude, the inverse of _rows."""
        row = min(int(y), len(self._borders) - 2)
        ends, share = self._borders[row : row + 2], y - row
        below, above = self._gathers_at(ends)
        if below and above:
            return _between(share * share * (3.0 - 2.0 * share), ends)
        if not (below or above):
            return _at_spread_share(share, ends)
        return _between(share**AT_KINKS if below else 1.0 - (1.0 - share) ** AT_KINKS, ends)

    def _even(self, amplitude: np.ndarray, ends: Ends) -> np.ndarray:
        """Scaled amplitudes between 0 and 1 in one patch."""
        below, above = self._gathers_at(ends)
        share, power = _share(amplitude, ends), 1.0 / AT_KINKS
        if below and above:
            return 0.5 - np.sin(np.arcsin(1.0 - 2.0 * share) / 3.0)
        if not (below or above):
            return _spread_share(amplitude, ends)
        return share**power if below else 1.0 - (1.0 - share) ** power

    def _gathers_at(self, ends: Ends) -> tuple[bool, bool]:
        """Return two flags: whether nodes are clustered at the lower and at the upper end of a
        patch.

        Nodes are clustered at kinks and, in a patch below a kink, at the amplitude 0.
        """
        below, above = (end in self.kinks.amplitudes for end in ends)
        return below or (above and ends[0] == 0.0), above


def _share(value: np.ndarray, ends: Ends) -> np.ndarray:
    """Relative position of values between two ends, clipped to the range 0 to 1."""
    return np.clip((value - ends[0]) / (ends[1] - ends[0]), 0.0, 1.0)


def _between(share: float, ends: Ends) -> float:
    return ends[0] + (ends[1] - ends[0]) * share


def _spread_share(amplitude: np.ndarray, ends: Ends) -> np.ndarray:
    """Relative position of amplitudes between two ends on the scale log(1 + SPREAD A), 0 to 1."""
    low, high = (np.log1p(SPREAD * end) for end in ends)
    return _share(np.log1p(SPREAD * amplitude), (low, high))


def _at_spread_share(share: float, ends: Ends) -> float:
    """Amplitude at a relative position, the inverse of _spread_share."""
    low, high = (np.log1p(SPREAD * end) for end in ends)
    return np.expm1(_between(share, (low, high))) / SPREAD


def round_digits(value: float) -> float:
    """Round a number to DIGITS significant digits."""
    return float(f"{value:.{DIGITS}g}")
