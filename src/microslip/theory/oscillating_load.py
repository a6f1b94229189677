"""Closed-form friction of forward sliding under an oscillating normal load or indentation.

A contact that moves along a line exerts the same force as independent springs at |x| < c(d) (Popov,
Popov and Popov, Mater. Res. 4, 2017). Here d is the indentation divided by its mean, and c is the
contact radius. Let h(x) be the indentation at which the contact radius is x; for a sphere, h(x) =
x^2. A spring at x slides at the stretch d - h(x), in units of u_lim. The stretch of a spring that
came into contact at the time T is

    min over tau from T to t of  v (t - tau) + d(tau) - h(x),

because the stretch never exceeds the value at which the spring slides. Let phi(t) = d(t) - v t. At
any x, the stretch is below this value by phi(t) - min phi. The mean over the springs is an integral
over T. The result is exact for Poisson's ratio 0. Quantities are dimensionless, in the working
units of the indenter (see pressure.Pressure).

Under a sinusoidal indentation, a contact of constant stiffness, for example a flat end, acts as a
single spring. M. Popov (Front. Mech. Eng. 6:69, 2020) gives two empirical formulas for its
friction, Eqs 37 and 38. Both formulas depend on the ratio of velocity to amplitude. If this ratio
is above 1, the contact slides all the time.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from microslip.theory.hertz import IndenterPressure
from microslip.theory.masing import clustered_rule, last_true

_NODES = 64
"""Number of nodes of each Gauss rule."""
_SAMPLES = 2001
"""Number of points in half a period at which the sign of phi' is computed."""


def mean_load(amplitude: float, by_load: bool, pressure: IndenterPressure) -> float:
    """Compute the mean normal load, divided by the load without oscillation.

    Parameters
    ----------
    amplitude : float
        Nonnegative amplitude of the load or of the indentation, divided by the mean value.
    by_load : bool
        True if the load oscillates, False if the indentation oscillates.
    pressure : pressure.Pressure
        Pressure of an axisymmetric indenter.
    """
    motion = _Motion(0.0, amplitude, by_load, pressure)
    loss = np.pi - motion.touch
    if by_load:
        return float(loss + amplitude * np.sin(loss)) / np.pi
    # near the loss of contact, the load behaves like a power of 3/2, so the nodes are clustered
    # twice
    nodes, weights = clustered_rule(_NODES)
    t = np.pi - loss * nodes**2
    return float(loss * (2.0 * nodes * weights) @ pressure.total(motion.depth(t))) / np.pi


def friction(velocity: float, amplitude: float, by_load: bool, pressure: IndenterPressure) -> float:
    """Compute the mean forward friction, divided by mu times the mean normal load.

    Parameters
    ----------
    velocity : float
        Nonnegative velocity divided by omega u_lim, where omega is the angular frequency. The value
        0 gives the static limit.
    amplitude, by_load, pressure
        See mean_load.
    """
    if amplitude == 0.0:
        return 1.0
    mean = mean_load(amplitude, by_load, pressure)
    motion = _Motion(velocity, amplitude, by_load, pressure)
    if velocity == 0.0:
        return float(pressure.total(motion.depth(np.array(0.0)))) / mean
    nodes, weights = clustered_rule(_NODES)
    lacking, before = 0.0, 0.0
    rises = motion.rises()
    for i, (low, high) in enumerate(rises):
        later = rises[i + 1 :]
        start, end = (float(pressure.radius(motion.depth(np.array(t)))) for t in (low, high))
        # springs that are always in contact, or come into contact while phi decreases, have the
        # same phi - min phi as springs that come into contact at the next minimum of phi
        lacking += (start - before) * motion.lack(np.array([low]), high, later)[0]
        for one, other in pairwise([start, *motion.kinks(low, high, later), end]):
            width = other - one
            when = np.clip(motion.touched(one + width * nodes), low, high)
            lacking += width * float(weights @ motion.lack(when, high, later))
        before = end
    return 1.0 - pressure.stiffness * lacking / (2.0 * np.pi) / mean


class _Motion:
    """Indentation during a period. The indentation increases from its minimum at t = 0 to its
    maximum at pi, and then decreases again."""

    def __init__(
        self, velocity: float, amplitude: float, by_load: bool, pressure: IndenterPressure
    ):
        self.velocity, self.amplitude, self.by_load = velocity, amplitude, by_load
        self.pressure = pressure
        self.touch = float(np.arccos(1.0 / amplitude)) if amplitude > 1.0 else 0.0

    def depth(self, t: np.ndarray) -> np.ndarray:
        height = np.maximum(1.0 - self.amplitude * np.cos(t), 0.0)
        return self.pressure.of_load(height) if self.by_load else height

    def phi(self, t: np.ndarray) -> np.ndarray:
        return self.depth(t) - self.velocity * t

    def touched(self, radius: np.ndarray) -> np.ndarray:
        """Return the time at which the growing contact has a given radius."""
        load = self.pressure.load(radius, radius)
        height = load if self.by_load else self.pressure.depth(radius)
        return np.arccos(np.clip((1.0 - height) / self.amplitude, -1.0, 1.0))

    def _climbs(self, t: np.ndarray) -> np.ndarray:
        """Return an array with the sign of phi'. Unlike phi', the array is finite where contact
        begins."""
        height = np.maximum(1.0 - self.amplitude * np.cos(t), 0.0)
        if self.by_load:  # the rate of load is proportional to the present stiffness
            radius = self.pressure.radius(self.pressure.of_load(height))
            return self.amplitude * np.sin(t) - self.velocity * self.pressure.stiffness * radius
        return self.amplitude * np.sin(t) - self.velocity

    def rises(self) -> list[tuple[float, float]]:
        """Return the time intervals (low, high) in which the contact grows and phi rises."""
        t = self.touch + (np.pi - self.touch) * np.sin(np.linspace(0.0, np.pi / 2, _SAMPLES)) ** 2
        up = self._climbs(t) > 0.0
        up[-1] = False
        turns = np.flatnonzero(up[1:] != up[:-1])
        at = last_true(lambda s: (self._climbs(s) > 0.0) == up[turns], t[turns], t[turns + 1])
        if up[0]:
            at = np.concatenate([t[:1], at])
        return list(zip(at[::2].tolist(), at[1::2].tolist(), strict=True))

    def kinks(
        self, low: float, high: float, later: Sequence[tuple[float, float]]
    ) -> Iterator[float]:
        """Yield the contact radii at which phi equals a later minimum of phi.

        The intervals `later` begin at these minima.
        """
        for other, _ in later:
            if self.phi(np.array(low)) < self.phi(np.array(other)) < self.phi(np.array(high)):
                at = self.reached(self.phi(np.array([other])), np.array([low]), np.array([high]))
                yield float(self.pressure.radius(self.depth(at))[0])

    def reached(self, level: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """Return the time between low and high at which the rising phi reaches a level."""
        return last_true(lambda t: self.phi(t) < level, low, high)

    def lack(
        self, start: np.ndarray, high: float, later: Sequence[tuple[float, float]]
    ) -> np.ndarray:
        """For each time in `start`, integrate the difference between phi and its running
        minimum. Both the integral and the running minimum begin at this time.

        The function phi increases from the time `start` to the time `high`, and also in each of the
        intervals `later`. The result has the shape (n,).
        """
        level = self.phi(start)
        last = later[-1][1] if later else high
        low, end = np.full_like(start, last), np.full_like(start, 2.0 * np.pi)
        lowest = np.zeros_like(start)
        for other, top in reversed(later):
            falls_short = self.phi(np.array(other)) < level
            beyond = self.lack(np.array([other]), top, [o for o in later if o[0] > other])[0]
            lowest = np.where(falls_short, beyond, lowest)
            low, end = np.where(falls_short, high, low), np.where(falls_short, other, end)
        end = last_true(lambda t: self.phi(t) >= level, low, end)
        nodes, weights = clustered_rule(_NODES)
        t = start[:, None] + (end - start)[:, None] * nodes
        return lowest + (end - start) * ((self.phi(t) - level[:, None]) @ weights)


def sum_of_powers(amplitude: ArrayLike, velocity: ArrayLike) -> np.ndarray:
    """Compute the friction divided by mu times the mean load (Eq 37).

    Parameters
    ----------
    amplitude : array_like
        Amplitude of the indentation divided by the mean indentation, from 0 to 1.
    velocity : array_like
        Velocity divided by omega u_lim, where omega is the angular frequency.
    """
    left = _remainder(amplitude, velocity)
    return 1.0 - np.asarray(amplitude) * (0.75 * left**2 + 0.25 * left**4)


def single_power(amplitude: ArrayLike, velocity: ArrayLike) -> np.ndarray:
    """Compute the friction divided by mu times the mean load (Eq 38).

    The function has the same arguments as sum_of_powers.
    """
    return 1.0 - np.asarray(amplitude) * _remainder(amplitude, velocity) ** 2.4


def _remainder(amplitude: ArrayLike, velocity: ArrayLike) -> np.ndarray:
    return np.maximum(1.0 - np.asarray(velocity) / np.asarray(amplitude), 0.0)
