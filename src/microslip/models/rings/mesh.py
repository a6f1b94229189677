"""Rings of a circular contact: edges that follow the motion, areas, bounds and lever arms.

Radii are r = sin(psi), psi equidistant but for what a motion asks for: so the edge of the contact
is refined, where pressures of smooth bodies fall like a square root, and the edge of a hole alike.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from microslip.foundation.errors import InputError
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Pressure


class Focus(NamedTuple):
    """Radii that rings gather at.

    Attributes
    ----------
    radii : tuple of float
        Over the contact radius, 0 to 1, increasing.
    strength : float
        The width of the rings there is 1 - strength of the mean.
    """

    radii: tuple[float, ...]
    strength: float = 0.6


@dataclass(frozen=True, eq=False)
class Rings:
    """n rings up to psi = pi/2.

    Attributes
    ----------
    psi : np.ndarray, shape (n + 1,)
        Edges, r = sin(psi).
    area : np.ndarray, shape (n,)
        Ring areas (units a^2).
    bound : np.ndarray, shape (n,)
        Mean friction bound, area-weighted sum 1.
    radius : np.ndarray, shape (n,)
        Mean lever arm of a traction shaped like the bound, so that full slip has the exact torque.
    """

    psi: np.ndarray
    area: np.ndarray
    bound: np.ndarray
    radius: np.ndarray


def make_rings(count: int, focus: Focus | float | None = None, pressure: Pressure = HERTZ) -> Rings:
    """Rings that are refined around a focus.

    An edge lies on each radius of it exactly: the traction has a kink at the stick radius, and a
    ring that straddles it costs an order of accuracy.

    Parameters
    ----------
    count : int
        Unknown radii.
    focus : Focus, float or None
        A Focus or just a radius; None: nowhere.
    pressure : pressure.Pressure
        One that depends on the radius alone.

    Raises
    ------
    InputError
        For count < 2, or a focus outside 0..1 or without order; for several radii of which one lies
        on the edge of the contact or of its hole, or in the middle, where an edge is in any case.
    """
    if count < 2:
        raise InputError("cells", count, "allowed is a whole number of at least 2 rings")
    if focus is None:
        return _of_edges(np.linspace(0.0, np.pi / 2, count + 1), pressure)
    radii, strength = _as_focus(focus)
    # rings begin at the edge of a hole, if there is one
    hole = pressure.inner**2
    inside = np.sqrt(np.maximum(np.square(radii) - hole, 0.0) / (1.0 - hole))
    if len(radii) > 1 and not 0.0 < inside[0] <= inside[-1] < 1.0:
        allowed = f"allowed are several radii between {pressure.inner:g} and 1, ends not included"
        raise InputError("focus", radii, allowed)
    places = np.arcsin(np.unique(inside)[: max(count // 2, 1)])
    return _of_edges(_focused(count, places, strength), pressure)


def _of_edges(psi: np.ndarray, pressure: Pressure) -> Rings:
    """The Rings between edges that are those of a contact without a hole, at first."""
    if pressure.inner > 0.0:
        hole = pressure.inner**2
        psi = np.arcsin(np.sqrt(hole + (1.0 - hole) * np.sin(psi) ** 2))
    return Rings(psi, np.pi * np.diff(np.sin(psi) ** 2), *pressure.ring_means(psi))


def _as_focus(focus: Focus | float) -> Focus:
    focus = focus if isinstance(focus, Focus) else Focus((focus,))
    radii = focus.radii
    ordered = radii and all(one < other for one, other in zip(radii, radii[1:], strict=False))
    within = radii and radii[0] >= 0.0 and radii[-1] <= 1.0 and 0.0 <= focus.strength < 1.0
    if not (ordered and within):
        allowed = "allowed are radii in 0..1, increasing, and a strength in 0..1"
        raise InputError("focus", focus, allowed)
    return focus


def _focused(count: int, places: np.ndarray, strength: float) -> np.ndarray:
    """Edges in psi with one on each of the places and widths that grow away from it on both sides.

    Halfway between two places the one gives way to the other.
    """
    edge = np.pi / 2

    def spread(t: np.ndarray) -> np.ndarray:
        return (1 - strength) * t + strength * t * t

    if len(places) == 1 and places[0] in (0.0, edge):
        t = np.linspace(0.0, 1.0, count + 1)
        return edge * spread(t) if places[0] == 0.0 else edge * (1.0 - spread(1.0 - t))
    ends = [0.0, places[0]]
    for place in places[1:]:
        ends += [0.5 * (ends[-1] + place), place]
    ends.append(edge)
    psi, counts = [0.0], np.diff(_shared_out(count, ends))
    for piece, rings in enumerate(counts):
        start, width = ends[piece], ends[piece + 1] - ends[piece]
        t = np.linspace(0.0, 1.0, rings + 1)
        # a piece ends at a place, the next one begins there
        share = 1.0 - spread(1.0 - t) if piece % 2 == 0 else spread(t)
        psi += list((start + width * share)[1:])
    psi[-1] = edge
    return np.array(psi)


def _shared_out(count: int, ends: Sequence[float]) -> list[int]:
    """How many of the rings lie before each of the ends: as their widths would have it, but some on
    both sides of each place."""
    least = max(count // (2 * len(ends) - 2), 1)
    before = [int(round(count * end / ends[-1])) for end in ends]
    for k in range(1, len(ends)):
        before[k] = max(before[k], before[k - 1] + least)
    before[-1] = count
    for k in range(len(ends) - 2, 0, -1):
        before[k] = min(before[k], before[k + 1] - least)
    return before
