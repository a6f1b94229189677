"""Contacts, in SI units, that are not round or have a prescribed size and pressure."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from microslip.foundation.errors import InputError
from microslip.pressures.axisymmetric_indenter import Indenter
from microslip.pressures.by_name import pressure_named
from microslip.pressures.ellipse import SMALLEST_RATIO
from microslip.pressures.pressure import Pressure
from microslip.si.bodies import TwoBodies
from microslip.si.printed_lines import prefixed_text

ROUND = 1e-6
"""Largest relative difference between two radii that count as equal."""
AGREES = 0.01
"""Largest relative difference between two sizes or loads that count as equal.  It allows for
rounding to two or three digits."""
DISAGREES = (
    "the {what} is {value}, but {measured} in the pressure file: only the shape of the pressure in "
    "the file is used"
)


@dataclass(frozen=True)
class ShapedContact(TwoBodies):
    """Two bodies with a prescribed size and pressure of the contact.

    Attributes
    ----------
    pressure : str
        Name of the pressure for microslip.solve.
    size : float
        Outer radius of the contact, or half its longer side, m.
    """

    pressure: str = "hertz"
    size: float = 0.0

    def with_load(self, load: float) -> TwoBodies:
        """A copy with another load, N.  A prescribed size stays constant."""
        over = load / self.load
        if self.radii:  # the size of Hertz's ellipse depends on the load
            return replace(self, load=load, size=self.size * over ** (1.0 / 3.0))
        return replace(self, load=load, radius=self.radius / over)

    @property
    def contact_radius(self) -> float:
        """Outer radius of the contact, or half its longer side, m."""
        return self.size

    @cached_property
    def _record(self) -> Pressure:
        return pressure_named(self.pressure)

    @property
    def curvature_radius(self) -> float | None:
        """Geometric mean of both radii of relative curvature, m; None for other shapes than Hertz's
        (K. L. Johnson, Contact Mechanics, 4.2)."""
        if not self._record.hertzian:
            return None
        ratio = getattr(self._record, "ratio", 1.0)
        if 1.0 - ratio <= ROUND:
            return self.size**3 * self.E_star / (0.75 * self.load)
        from scipy.special import ellipe, ellipk

        m = 1.0 - ratio**2
        first, second = ellipk(m), ellipe(m)
        sizes = (first - second) * (second / ratio**2 - first)
        pressure = 1.5 * self.load / (math.pi * self.size**2 * ratio)
        return float(0.5 * self.E_star * self.size * m / (pressure * ratio * math.sqrt(sizes)))

    def load_at(self, radius: np.ndarray) -> np.ndarray | None:
        """Load, N, at which a round contact has this radius, m; None for other shapes."""
        if not isinstance(self._record, Indenter):
            return None
        with np.errstate(over="ignore"):
            return self.load * self._record.total(self._record.depth(radius / self.size))

    @property
    def u_lim(self) -> float:
        """Displacement at which the whole contact slides, m."""
        return self.mu * self.load * self._record.G_star / (self.G_star * self.size)

    @property
    def indentation(self) -> float:
        """Indentation u_lim G*/(mu E*) of an indenter, m; NaN for another pressure."""
        if not (self._record.is_indenter or self._record.hertzian):
            return math.nan
        return self.u_lim * self.G_star / (self.mu * self.E_star)

    @property
    def largest_pressure(self) -> float:
        """Largest pressure, Pa; infinite at the tip of a cone."""
        return self._record.largest * (self.load / self.size**2)

    @property
    def contradictions(self) -> list[str]:
        """Messages about a size or a load that differs from the value in a pressure file with
        units.

        Differences within the file's reading error are accepted; see AGREES.
        """
        texts, readings = [], (self._record, *self._record.readings)
        inputs = (("contact radius", self.size, "size_m", "m"), ("load", self.load, "load_N", "N"))
        for what, value, name, unit in inputs:
            sizes = [getattr(one, name, None) or value for one in readings]
            if not (1.0 - AGREES) * min(sizes) <= value <= (1.0 + AGREES) * max(sizes):
                pair = [prefixed_text(one, unit) for one in (value, sizes[0])]
                texts.append(DISAGREES.format(what=what, value=pair[0], measured=pair[1]))
        return texts


def ellipse_of_radii(forward: float, lateral: float) -> tuple[float, float]:
    """Semi-axes of Hertz's ellipse.

    Parameters
    ----------
    forward, lateral : float
        Radii of relative curvature along both axes, m.

    Returns
    -------
    tuple of float
        The ratio b/a, at most 1; the semi-axis a, divided by (3 F R / (4 E*))^(1/3).  R is the
        larger radius (K. L. Johnson, Contact Mechanics, 4.2).
    """
    from scipy.optimize import brentq
    from scipy.special import ellipe, ellipk

    long, short = max(forward, lateral), min(forward, lateral)
    if long - short <= ROUND * long:
        return 1.0, 1.0

    def curvatures(ratio: float) -> float:
        """Curvature along the long axis divided by the curvature along the short axis."""
        m = 1.0 - ratio**2
        return ratio**2 * (ellipk(m) - ellipe(m)) / (ellipe(m) - ratio**2 * ellipk(m))

    ratio = brentq(lambda k: curvatures(k) - short / long, 1e-8, 1.0 - 1e-9, xtol=1e-15)
    m = 1.0 - ratio**2
    # 1/(2 R) = p0/E* b/(a^2 m) (K - E) along the long axis, with p0 = 3 F/(2 pi a b)
    return float(ratio), float((4.0 / math.pi * (ellipk(m) - ellipe(m)) / m) ** (1.0 / 3.0))


def elliptic(contact: TwoBodies, radius_across: float) -> TwoBodies:
    """A contact with another radius of relative curvature across the forward direction, m.

    Raises InputError if the ellipse is too slender for the solver.
    """
    ratio, stretch = ellipse_of_radii(contact.radius, radius_across)
    if ratio < SMALLEST_RATIO:
        problem = f"the contact would be an ellipse of ratio {ratio:.2g}"
        allowed = f"{problem}; allowed is {SMALLEST_RATIO:g} or more"
        raise InputError("radius_across", radius_across, allowed)
    long = max(contact.radius, radius_across)
    size = stretch * (0.75 * contact.load * long / contact.E_star) ** (1.0 / 3.0)
    across = int(radius_across > contact.radius)
    name = "hertz" if ratio == 1.0 else f"ellipse:ratio={ratio!r},across={across}"
    shape = {"radii": (*contact.radii, radius_across), "pressure": name, "size": size}
    return ShapedContact(**vars(contact) | shape)


def of_size(contact: TwoBodies, size: float, pressure: str) -> TwoBodies:
    """A contact with a prescribed size, m, and pressure.

    The field `radius` is the radius of a sphere with the same contact radius under the same load.
    """
    radius = 4.0 * contact.E_star * size**3 / (3.0 * contact.load)
    shape = {"radius": radius, "radii": (), "pressure": pressure_named(pressure).name}
    return ShapedContact(**vars(contact) | shape, size=size)
