"""A flat punch with a rounded edge: f(r) = 0 up to the radius of its flat end, then a parabola."""

from __future__ import annotations

import numpy as np

from microslip.foundation import spec
from microslip.pressures.axisymmetric_indenter import indenter
from microslip.pressures.pressure import Pressure

DEFAULTS = {"flat": 0.8}
LARGEST_FLAT = 0.99
_HALVINGS = 100


def pressure(name: str, flat: float) -> Pressure:
    """The Pressure of a punch whose flat end reaches up to `flat` contact radii.

    Equivalent plane profile (Ciavarella 1999): D(c) ~ c (sqrt(c^2 - b^2) - b arccos(b/c)) for c
    above b.  Raises InputError for a flat end outside 0..0.99.
    """
    kind = "a share of the contact radius"
    spec.refuse_outside(name, "pressure", "flat", flat, (0.0, LARGEST_FLAT), kind=kind)

    def rises(c):
        c = np.maximum(np.asarray(c, float), flat)
        return c * (_root(c, flat) - flat * _angle(c, flat))

    scale = 1.0 / float(rises(1.0))

    def slope(c):
        c = np.maximum(c, flat)
        return scale * (2.0 * _root(c, flat) - flat * _angle(c, flat))

    def radius(depth):
        depth = np.asarray(depth, float)
        low, high = np.full(depth.shape, flat), np.ones(depth.shape)
        while np.any(scale * rises(high) < depth):
            high = 2.0 * high
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            below = scale * rises(middle) < depth
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        return np.where(depth > 0.0, high, 0.0)[()]

    return indenter(
        name,
        f"a punch with a rounded edge, flat up to {flat:g} of its contact radius",
        depth=lambda c: scale * rises(c),
        slope=slope,
        radius=radius,
        flat=flat,
    )


def _root(c, flat):
    return np.sqrt((c - flat) * (c + flat))


def _angle(c, flat):
    return np.arccos(np.minimum(flat / np.maximum(c, 1e-300), 1.0))
