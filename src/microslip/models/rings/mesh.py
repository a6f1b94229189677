"""Rings of a circular contact: edges that follow the motion, areas, bounds and lever arms.

Radii are r = sin(psi), psi equidistant but for what a motion asks for: so the edge of the contact
is refined, where pressures of smooth bodies fall like a square root, and the edge of a hole alike.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from microslip.pressures.by_name import HERTZ
from microslip.pressures.pressure import Pressure


class Focus(NamedTuple):
    """A radius that rings gather at.

    Attributes
    ----------
    radius : float
        Over the contact radius, 0 to 1.
    strength : float
        The width of the rings there is 1 - strength of the mean.
    """

    radius: float
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

    An edge lies on the focus exactly: the traction has a kink at the stick radius, and a ring that
    straddles it costs an order of accuracy.

    Parameters
    ----------
    count : int
        Unknown radii.
    focus : Focus, float or None
        A Focus or just its radius; None: nowhere.
    pressure : pressure.Pressure
        One that depends on the radius alone.

    Raises
    ------
    ValueError
        For count < 2 or a focus outside 0..1.
    """
    if count < 2:
        raise ValueError(f"cells = {count}: allowed is a whole number of at least 2 rings")
    if focus is None:
        psi = np.linspace(0.0, np.pi / 2, count + 1)
    else:
        psi = _focused(count, _as_focus(focus))
    if pressure.inner > 0.0:
        hole = pressure.inner**2
        psi = np.arcsin(np.sqrt(hole + (1.0 - hole) * np.sin(psi) ** 2))
    return Rings(psi, np.pi * np.diff(np.sin(psi) ** 2), *pressure.ring_means(psi))


def _as_focus(focus):
    focus = focus if isinstance(focus, Focus) else Focus(focus)
    if not (0.0 <= focus.radius <= 1.0 and 0.0 <= focus.strength < 1.0):
        raise ValueError(f"focus = {focus}: allowed is a radius in 0..1 and a strength in 0..1")
    return focus


def _focused(count, focus):
    """Edges in psi with one on the focus and widths that grow away from it on both sides."""
    radius, strength = focus
    centre, edge = np.arcsin(radius), np.pi / 2
    inside = int(round(count * centre / edge))
    inside = min(max(inside, count // 4, 1), count - max(count // 4, 1))

    def spread(t):
        return (1 - strength) * t + strength * t * t

    if radius in (0.0, 1.0):
        t = np.linspace(0.0, 1.0, count + 1)
        return edge * spread(t) if radius == 0.0 else edge * (1.0 - spread(1.0 - t))
    inner = centre * (1.0 - spread(1.0 - np.linspace(0.0, 1.0, inside + 1)))
    outer = centre + (edge - centre) * spread(np.linspace(0.0, 1.0, count - inside + 1))
    psi = np.concatenate([inner, outer[1:]])
    psi[0], psi[-1] = 0.0, edge
    return psi
