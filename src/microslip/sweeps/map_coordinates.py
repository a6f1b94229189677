"""Coordinates in which a map is even: velocity in the logarithm, kinks at whole numbers.

A map over velocity and amplitude is cut into patches at the kinks that its motion is known to have
(theory.kinks).  In the scaled coordinates patches are unit squares, and places gather where
friction changes fast: at a kink of the amplitude, and where the oscillation sets in.
"""

from __future__ import annotations

import json
from typing import NamedTuple

import numpy as np

from microslip.foundation.canonical import canonical_json
from microslip.theory.kinks import Kinks, kink_velocity

DIGITS = 9
"""Significant digits of the velocity and the amplitude of a node."""
CLEAR = 2.0
"""A kink of the velocity is a border where it is this factor within the range."""
AT_KINKS, AT_ONSET = 2.0, 1.5
"""Powers with which places gather at kinks of the amplitude, and at the amplitude 0."""


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
    """

    velocity: tuple[float, float]
    amplitude: tuple[float, float]
    kinks: Kinks = Kinks()

    @property
    def patches(self) -> tuple[int, int]:
        """How many patches lie along the velocity and along the amplitude."""
        return 2 if self._is_cut else 1, len(self._borders) - 1

    @classmethod
    def from_json(cls, text: str) -> MapCoordinates:
        """What `to_json` made a text of."""
        given = json.loads(text)
        kinks = Kinks(*(tuple(given[name]) for name in ("kink_amplitudes", "kink_velocity")))
        return cls(tuple(given["velocity"]), tuple(given["amplitude"]), kinks)

    def to_json(self) -> str:
        """The coordinates as a text, for the attribute of a dataset."""
        ranges = {"velocity": self.velocity, "amplitude": self.amplitude}
        kinks = {"kink_amplitudes": self.kinks.amplitudes, "kink_velocity": self.kinks.velocity}
        return canonical_json(ranges | kinks)

    def scaled(self, velocity: np.ndarray, amplitude: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Scaled coordinates of places in the range, shape (n,) each."""
        v, a = np.log(velocity), np.asarray(amplitude, float)
        slow, fast = np.log(self.velocity)
        x = (v - slow) / (fast - slow)
        if self._is_cut:
            middle = np.log(self._cut_at(a))
            x = np.where(
                v <= middle, (v - slow) / (middle - slow), 1.0 + (v - middle) / (fast - middle)
            )
        y = np.empty_like(a)
        for k, (low, high) in enumerate(zip(self._borders, self._borders[1:], strict=False)):
            here = (a >= low) & (a <= high)
            share = (a[here] - low) / (high - low)
            y[here] = k + _even(share, self._steepness(low), self._steepness(high))
        return x, y

    def place(self, x: float, y: float) -> tuple[float, float]:
        """Velocity and amplitude at scaled coordinates, in DIGITS digits."""
        k = min(int(y), len(self._borders) - 2)
        low, high = self._borders[k : k + 2]
        share = _gathered(y - k, self._steepness(low), self._steepness(high))
        amplitude = low + (high - low) * share
        slow, fast = np.log(self.velocity)
        if not self._is_cut:
            v = slow + (fast - slow) * x
        else:
            middle = float(np.log(self._cut_at(np.array(amplitude))))
            v = slow + (middle - slow) * x if x <= 1.0 else middle + (fast - middle) * (x - 1.0)
        return _rounded(np.exp(v)), _rounded(amplitude)

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

    def _steepness(self, amplitude):
        """The power with which places gather at a border of the amplitude."""
        if amplitude in self.kinks.amplitudes:
            return AT_KINKS
        return AT_ONSET if amplitude == 0.0 else 1.0


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
