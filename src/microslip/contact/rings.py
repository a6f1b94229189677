"""Mesh of rings of a circular contact: edges, areas, friction bounds and lever arms.

The edges of the rings are r = sin(psi) with equidistant psi, unless the mesh is graded towards a
focus.  This choice refines the mesh at the edge of the contact, where smooth pressures decrease
like a square root.  Contacts with a hole are refined at the edge of the hole in the same way.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from microslip.foundation.errors import InputError
from microslip.scene.hertz import HERTZ
from microslip.scene.pressure import Pressure


class Focus(NamedTuple):
    """Radii towards which a mesh of rings is graded.

    Attributes
    ----------
    radii : tuple of float
        Increasing radii divided by the contact radius, from 0 to 1.
    strength : float
        Strength of the grading.  A ring at one of the radii is (1 - strength) times as wide as the
        mean ring.
    """

    radii: tuple[float, ...]
    strength: float = 0.6


@dataclass(frozen=True, eq=False)
class Rings:
    """A mesh of n rings that extends to psi = pi/2.

    Attributes
    ----------
    psi : np.ndarray, shape (n + 1,)
        Edges of the rings as angles psi, with r = sin(psi).
    area : np.ndarray, shape (n,)
        Areas of the rings divided by a^2.
    bound : np.ndarray, shape (n,)
        Mean friction bound of each ring; area @ bound is 1.
    radius : np.ndarray, shape (n,)
        Mean lever arm of a traction proportional to the friction bound.  With this lever arm, the
        torque at full slip is exact.
    focus, pressure
        See make_rings.
    """

    psi: np.ndarray
    area: np.ndarray
    bound: np.ndarray
    radius: np.ndarray
    focus: Focus | float | None
    pressure: Pressure


@lru_cache(maxsize=32)
def make_rings(count: int, focus: Focus | float | None = None, pressure: Pressure = HERTZ) -> Rings:
    """Create a mesh of rings that is graded towards a focus.

    Each radius of the focus becomes an edge between two rings.  The traction has a kink at the
    stick radius, and a ring that contains the kink would reduce the order of accuracy by one.
    Calls with equal arguments return the same object, which must not be modified.

    Parameters
    ----------
    count : int
        Number of rings.
    focus : Focus, float or None
        A Focus, a single radius, or None for a mesh without grading.
    pressure : pressure.Pressure
        Pressure that depends on the radius alone.

    Raises
    ------
    InputError
        If count < 2, if the radii of the focus are outside 0..1 or not increasing, or if one of
        several radii is 0, 1 or the radius of the hole.
    """
    if count < 2:
        raise InputError("cells", count, "allowed is a whole number of at least 2 rings")
    hole, psi = pressure.inner**2, np.linspace(0.0, np.pi / 2, count + 1)
    if focus is not None:
        radii, strength = focus if isinstance(focus, Focus) else Focus((focus,))
        if not (radii and list(radii) == sorted({*radii}) and radii[0] >= 0.0 and radii[-1] <= 1.0):
            raise InputError("focus", radii, "allowed are radii in 0..1, increasing")
        # the first ring begins at the edge of the hole, if there is one
        inside = np.sqrt(np.maximum(np.square(radii) - hole, 0.0) / (1.0 - hole))
        if len(radii) > 1 and not 0.0 < inside[0] <= inside[-1] < 1.0:
            allowed = f"several radii between {pressure.inner:g} and 1, ends not included"
            raise InputError("focus", radii, f"allowed are {allowed}")
        psi = _focused(count, np.arcsin(inside[: max(count // 2, 1)]), strength)
    if hole > 0.0:  # map the disc to the annulus outside the hole
        psi = np.arcsin(np.sqrt(hole + (1.0 - hole) * np.sin(psi) ** 2))
    area, (bound, radius) = np.pi * np.diff(np.sin(psi) ** 2), pressure.ring_means(psi)
    return Rings(psi, area, bound, radius, focus, pressure)


def _focused(count: int, places: np.ndarray, strength: float) -> np.ndarray:
    """Return the edges of the rings as angles psi.  The number of edges is count + 1.

    The edges are graded towards `places`.  At each of the `places`, there is an edge between two
    rings.  Between two successive places, the rings are widest in the middle.  Each piece between a
    place and a middle has at least a few rings.  The number of rings in a piece is approximately
    proportional to the angle of the piece.
    """
    edge = np.pi / 2
    if len(places) == 1 and places[0] in (0.0, edge):
        t = np.linspace(0.0, 1.0, count + 1)
        t = t if places[0] == 0.0 else 1.0 - t
        spread = (1 - strength) * t + strength * t * t
        return edge * spread if places[0] == 0.0 else edge * (1.0 - spread)
    ends = [0.0, places[0]]
    for place in places[1:]:
        ends += [0.5 * (ends[-1] + place), place]
    ends.append(edge)
    before, last = np.rint(count * np.array(ends) / edge).astype(int), len(ends) - 1
    least = max(count // (2 * last), 1)
    for k in range(1, last):
        before[k] = max(before[k], before[k - 1] + least)
    before[last] = count
    for k in range(last - 1, 0, -1):
        before[k] = min(before[k], before[k + 1] - least)
    psi = np.zeros(count + 1)
    for piece, (first, end) in enumerate(pairwise(before)):
        start, width = ends[piece], ends[piece + 1] - ends[piece]
        t = np.linspace(0.0, 1.0, end - first + 1)[1:]
        # every second piece ends at a place, and the other pieces begin at one
        t = 1.0 - t if piece % 2 == 0 else t
        share = (1 - strength) * t + strength * t * t
        psi[first + 1 : end + 1] = start + width * (1.0 - share if piece % 2 == 0 else share)
    psi[-1] = edge
    return psi
