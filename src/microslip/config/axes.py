"""Coordinates of sweep axes.

The module imports nothing slow, since every parse of the workflow imports it.
"""

import math
from itertools import pairwise
from typing import Any

from microslip.config.records import Refusal
from microslip.foundation.canonical import number

DRIVES = ("mass", "damping", "stiffness", "force")
"""Parameters of a drive, in the order of dataset dimensions."""
MOST_POINTS = 1_000_000
"""Largest number of points in a sweep.  With more points, each start of the workflow would take a
minute."""
MOST_MAP_POINTS = 10_000
"""Largest number of points in a study's map.  Every model computes all points."""


def refuse_crowd(points: int, most: int, key: str = "") -> None:
    """Raise Refusal if there are more points than `most`."""
    if points > most:
        raise Refusal(f"{points} points are not allowed; allowed: at most {most}", key)


def coordinates(axis: Any) -> tuple[float, ...]:
    """Coordinates of an axis, in ascending order.

    axis: a number, a list of numbers, or {"linear" or "log": {"start", "stop", "count"}}.  Raises
    Refusal if coordinates are equal or a range is empty.
    """
    if isinstance(axis, dict):
        ((spacing, range_),) = axis.items()
        values = _spaced(spacing, **range_)
    else:
        values = [float(number(value)) for value in (axis if isinstance(axis, list) else [axis])]
    values.sort()
    for low, high in pairwise(values):
        if high - low <= 1e-9 * high:
            raise Refusal(f"{high:.12g} occurs twice; allowed: different values")
    return tuple(values)


def _spaced(spacing: str, start: float, stop: float, count: int) -> list[float]:
    if spacing == "log" and start == 0:
        raise Refusal("0 is not allowed; allowed: a number > 0", "log.start")
    if stop <= start:
        message = f"{number(stop)} is not allowed; allowed: a number above {number(start)}"
        raise Refusal(message, f"{spacing}.stop")
    if spacing == "log" and math.isinf(stop / start):
        message = f"{number(start)} is not allowed; allowed: a number nearer {number(stop)}"
        raise Refusal(message, f"{spacing}.start")
    if spacing == "linear":
        values = (start + (stop - start) * i / (count - 1) for i in range(count))
    else:
        values = (start * math.exp(math.log(stop / start) * i / (count - 1)) for i in range(count))
    # Coordinates with six digits are readable and do not depend on the machine.
    return [float(f"{value:.6g}") for value in values]
