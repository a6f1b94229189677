"""The contact of two elastic bodies in SI units.  The module also computes the dimensionless groups
that the solver needs.

All formulas accept arrays of inputs.  For tangential loads, two half-spaces are equivalent to one
half-space whose compliance is the sum of both compliances.  The normal and the tangential problem
are assumed to be uncoupled.
"""

from __future__ import annotations

import math
from functools import cached_property, reduce
from typing import Any

import numpy as np

from microslip.foundation.arguments import LARGEST
from microslip.scene.by_name import motion_named, pressure_named
from microslip.scene.hertz import SMALLEST_RATIO
from microslip.scene.motion import Motion
from microslip.scene.pressure import Pressure
from microslip.si.inputs import AT_REST, OSCILLATIONS, Inputs
from microslip.theory import hertz

LARGEST_RATIO = 0.5
"""Largest accepted ratio of the contact radius to the radius of the smaller body.  At this ratio,
the surface of a sphere is tilted by 30 degrees at the edge of the contact, and is 7 % deeper there
than the parabola of Hertz's theory."""
ROUND = 1e-6
"""Largest relative difference between two radii that count as equal."""
OUT_OF_RANGE = "outside the range of floating-point numbers; allowed are sizes of real bodies"
DRIVES = {"force": "force", "drive_stiffness": "stiffness", "mass": "mass", "damping": "damping"}
"""Arguments of microslip.solve, keyed by the inputs of `predict` that describe the drive."""
INPUT_OF = {"velocity": "speed"} | {group: name for name, group in DRIVES.items()}
"""Inputs of `predict`, keyed by the arguments of microslip.solve."""


class Contact:
    """A contact in SI units: its inputs, and the quantities derived from them.

    Attributes
    ----------
    inputs : Inputs
        The inputs.
    mu, load : float or array
        Coefficient of friction; normal load without oscillation, in N.
    E_star, G, G_star : float or array
        Contact modulus E*, shear modulus G for torsion, and tangential contact modulus G*, in Pa.
        With sums over both bodies, 1/E* = sum (1 - nu^2)/E, 1/G = sum 1/G_i, and
        1/G* = sum (2 - nu)/(4 G).
    poisson : float or array
        Poisson's ratio of the equivalent half-space, sum(nu/G) / sum(1/G).
    radii : tuple
        Radii of the bodies, in m; empty if the contact radius is an input.
    radius : float or array
        Radius R of relative curvature, 1/R = 1/R1 + 1/R2, in m.
    mean_radius : float or array
        Geometric mean of the two radii of relative curvature of a Hertz contact, in m.
    ratio : float or array
        Ratio of the shorter axis to the longer axis of a Hertz contact; 1 for other contacts.
    contact_radius : float or array
        Contact radius, or half the longer side of the contact, in m.
    u_lim : float or array
        Displacement at which the whole contact slides, in m.  It is mu F_z G_s/(G* a), with
        G_s = 3/4 for a sphere (see the text below Eq 2).
    indentation : float or array
        Indentation of an indenter, u_lim G*/(mu E*), in m; NaN for a pressure that is not that of
        an indenter.
    largest_pressure : float or array
        Largest pressure, in Pa; infinite for a cone.
    area : float or array
        Area of the contact, in m^2.
    """

    def __init__(self, inputs: Inputs):
        self.inputs, self.kind = inputs, inputs.kind
        self.bodies = [body for body, _ in inputs.bodies]
        self.mu, self.load, self.steady = inputs.mu, inputs.load, inputs.kind.steady
        self.E_star = 1.0 / sum((1.0 - one.poisson**2) / one.young for one in self.bodies)
        compliances = [2.0 * (1.0 + one.poisson) / one.young for one in self.bodies]
        self.G = 1.0 / sum(compliances)
        shares = [one / sum(compliances) for one in compliances]
        self.poisson = sum(b.poisson * x for b, x in zip(self.bodies, shares, strict=True))
        self.G_star = 4.0 * self.G / (2.0 - self.poisson)
        self.radii: tuple = ()
        self.ratio: Any = 1.0
        sphere, indents, over, cube = 0.75 * self.load / self.E_star, True, 1.0, 1.0
        if inputs.contact_radius is not None:
            a, shape = inputs.contact_radius, self.shape
            self.radius, indents = a**3 / sphere, shape.is_indenter or shape.hertzian
            stiffness, largest, area = shape.G_star, shape.largest, shape.area
            if shape.hertzian and not shape.is_round:
                over, cube, _ = hertz_ellipse(shape.ratio)  # type: ignore[attr-defined]
            longer = self.radius / cube
        else:
            self.radii = tuple(r for r in (inputs.radius, inputs.counter_radius) if r is not None)
            self.radius = longer = 1.0 / sum(1.0 / one for one in self.radii)
            stiffness = hertz.G_STAR
            if inputs.radius_across is not None:
                self.radii += (inputs.radius_across,)
                longer = np.maximum(self.radius, inputs.radius_across)
                self.ratio = ratio_of_axes(np.minimum(self.radius, inputs.radius_across) / longer)
                over, cube, stiffness = hertz_ellipse(self.ratio)
            with np.errstate(invalid="ignore"):  # NaN if the hollow is smaller than the sphere
                a = np.power(sphere * longer * cube, 1.0 / 3.0)
            a = a if np.ndim(a) else float(a)
            largest, area = 1.5 / (math.pi * self.ratio), math.pi * self.ratio
        self.contact_radius, self.mean_radius = a, longer * over**0.5
        self.u_lim = self.mu * self.load * stiffness / (self.G_star * a)
        depth = self.u_lim * self.G_star / (self.mu * self.E_star)
        self.indentation = depth if indents else math.nan
        self.largest_pressure = largest * (self.load / a**2)
        self.area = area * a**2

    @property
    def pressure(self) -> str:
        """Name of the pressure distribution, as an argument of microslip.solve."""
        if not self.radii:
            return pressure_named(self.inputs.pressure or "hertz").name
        if np.all(self.ratio == 1.0):
            return "hertz"
        across = int(self.inputs.radius_across > self.radius)
        return f"ellipse:ratio={float(self.ratio)!r},across={across}"

    @cached_property
    def shape(self) -> Pressure:
        """The pressure distribution."""
        return pressure_named(self.pressure)

    @property
    def smallest_radius(self) -> Any:
        """Smallest absolute value of the radii of the bodies, in m."""
        return min(map(abs, self.radii), default=self.radius)

    @property
    def mismatch(self) -> Any:
        """Dundurs' dimensionless constant beta, which is 0 for equal bodies.

        For each body, let p = (1 - 2 nu) / G and q = (1 - nu) / G.
        Then beta is (p1 - p2) / (2 (q1 + q2)).  Beta is a measure of the tangential displacement
        caused by pressure.
        """
        first, second = ((1.0 - 2.0 * one.poisson) / one.shear_modulus for one in self.bodies)
        both = sum((1.0 - one.poisson) / one.shear_modulus for one in self.bodies)
        return 0.5 * (first - second) / both

    # Motion and drive

    @property
    def omega(self) -> Any:
        """Angular frequency of the oscillation, or angular speed of a steady spin, in rad/s."""
        inputs = self.inputs
        return inputs.rotation if self.steady else 2.0 * math.pi * inputs.frequency

    @cached_property
    def amplitudes(self) -> dict[str, Any]:
        """Dimensionless amplitudes for microslip.solve, keyed by direction (Eqs 2, 4, 27)."""
        inputs = self.inputs
        if self.kind.stroke is not None:
            sizes = self.kind.stroke.sizes(self)
            return {name: inputs.amplitude * size for name, size in sizes.items()}
        angle = self.u_lim / (self.contact_radius * hertz.bore_amplitude(1.0, self.poisson))
        units = {"lateral": self.u_lim, "forward": self.u_lim, "angle": angle, "load": self.load}
        if self.kind.unit == "rad":
            units["lateral"] = angle
        given = {direction: getattr(inputs, name) for name, direction in OSCILLATIONS.items()}
        return {n: size / units[n] for n, size in given.items() if size is not None}

    @cached_property
    def amplitude(self) -> Any:
        """Amplitude for microslip.solve: the largest value of `amplitudes`, or None for a steady
        motion."""
        sizes = self.amplitudes.values()
        return reduce(np.maximum, sizes) if sizes else None

    @cached_property
    def motion(self) -> str | Motion:
        """The motion for microslip.solve.  If the motion has several amplitudes, all of them are
        divided by the largest one."""
        if not self.kind.several:
            return self.kind.name
        largest = float(self.amplitude)
        if self.kind.stroke is not None:
            return self.kind.stroke.sampled(self, largest / (self.inputs.amplitude or 1.0) or 1.0)
        shares = {name: float(one) / (largest or 1.0) for name, one in self.amplitudes.items()}
        shares["phase"] = math.degrees(self.inputs.phase or 0.0)
        return f"{self.kind.name}:{','.join(f'{name}={one!r}' for name, one in shares.items())}"

    @property
    def speed_unit(self) -> Any:
        """Forward speed, in m/s, at which the dimensionless velocity is 1."""
        if self.steady:
            return self.omega * self.contact_radius
        if not self.kind.several and motion_named(self.kind.name).edge_velocity:
            return self.omega * self.inputs.amplitude * self.contact_radius
        return self.omega * self.u_lim

    @property
    def velocity(self) -> float:
        """Dimensionless velocity for microslip.solve (Eqs 2, 4, 13, 28)."""
        speed, unit = self.inputs.speed, self.speed_unit
        if speed == 0.0 or self.kind.unit == "rad" and unit == 0.0:
            return 0.0
        return float(speed / unit) if unit > 0.0 else math.inf

    @property
    def _record(self) -> Motion:
        return motion_named(self.motion)

    @cached_property
    def mean_load(self) -> float:
        """Mean normal load divided by the load without oscillation.  This ratio is above 1 if the
        bodies separate in each period."""
        if self.kind.stroke is None and self.amplitudes.get("load", 0.0) <= 1.0:
            return 1.0
        return float(self._record.mean_load(float(self.amplitude), self.shape))

    @property
    def separated(self) -> float:
        """Fraction of a period during which the bodies are separated, between 0 and 1."""
        if self.kind.stroke is not None:
            return self._record.share_without_load(float(self.amplitude))  # type: ignore[attr-defined]
        swing = float(self.amplitudes.get("load", 0.0))
        return math.acos(1.0 / swing) / math.pi if swing > 1.0 else 0.0

    def drive(self, mean_load: Any = 1.0) -> dict[str, Any]:
        """Return the dimensionless force, stiffness, mass and damping for microslip.solve.

        The unit of the force is mu times the mean load.  The unit of the stiffness is mu F_z /
        u_lim, where F_z is the load without oscillation.  The unit of the mass is the unit of the
        stiffness divided by omega^2.  The unit of the damping is the unit of the stiffness divided
        by omega.  The argument `mean_load` is the mean load divided by F_z.
        """
        stiffness = self.mu * self.load / self.u_lim
        units = {"force": self.mu * self.load * mean_load, "drive_stiffness": stiffness}
        units |= {"mass": stiffness / self.omega / self.omega, "damping": stiffness / self.omega}
        sizes = {name: getattr(self.inputs, name) for name in units}
        return {DRIVES[n]: one / units[n] for n, one in sizes.items() if one is not None}

    @property
    def coordinates(self) -> dict[str, Any]:
        """Dimensionless groups on which the result of the solver depends, keyed by name.  The
        static limit depends only on the groups that precede the velocity in this dictionary."""
        inputs, stroke = self.inputs, self.kind.stroke
        groups = {"poisson": self.poisson, "ratio": self.ratio, "phase": inputs.phase}
        if stroke is None:
            groups |= self.amplitudes
        else:
            groups["factor"] = inputs.amplitude / self.u_lim
            if not stroke.columns.keys() <= {"forward", "lateral"}:
                groups |= {"load": self.load, "contact_radius": self.contact_radius}
        if inputs.speed is not None:
            unit = self.contact_radius if self.steady or self.kind.unit == "rad" else self.u_lim
            groups["velocity"] = inputs.speed / (self.omega * unit)
        groups |= self.drive()
        return {name: one for name, one in groups.items() if one is not None}

    def check(self) -> None:
        """Raise InputError if the contact is outside the range of Hertz's theory or of the
        solver."""

        def refuse(name: str, is_wrong: Any, allowed: str) -> None:
            if is_wrong:
                raise self.inputs.error(name, allowed)

        inputs, a, smallest = self.inputs, self.contact_radius, self.smallest_radius
        finite = all(0.0 < one < math.inf for one in (a, self.u_lim, self.load / a**2))
        if self.radii:
            second = "radius_across" if inputs.radius_across is not None else "counter_radius"
            own = "counter_radius" if inputs.counter_radius is not None else "radius"
            refuse(own, inputs.counter_radius == 0.0, "allowed is a radius other than 0")
            allowed = "allowed is a hollow with a larger radius than the sphere"
            refuse(own, 1.0 / self.radius <= 0.0, allowed)
            refuse(own, not 0.0 < self.radius < math.inf, OUT_OF_RANGE)
            allowed = f"the contact would be an ellipse of ratio {self.ratio:.2g}; allowed is "
            refuse(second, self.ratio < SMALLEST_RATIO, f"{allowed}{SMALLEST_RATIO:g} or more")
            allowed = "by Hertz's theory, which is for contacts much smaller than either body, the "
            allowed += f"contact radius would be {a:.3g} m, {a / smallest:.2g} of this radius; "
            allowed += f"allowed is less than {LARGEST_RATIO:g}"
            name = "radius" if smallest == abs(self.radii[0]) else second
            refuse(name, a >= LARGEST_RATIO * smallest, allowed)
            allowed = f"with these bodies and radii, {OUT_OF_RANGE}"
            refuse("load", not (finite and 0.0 < self.indentation < math.inf), allowed)
        else:
            refuse("contact_radius", not (finite and self.largest_pressure > 0.0), OUT_OF_RANGE)
        if inputs.search is not None or self.kind is AT_REST:
            return
        most, amplitudes = LARGEST["amplitude"], {} if self.kind.stroke else self.amplitudes
        still = self.kind.several and amplitudes and not any(amplitudes.values())
        allowed = "allowed is a value above 0 if no other amplitude is above 0"
        refuse(next(iter(self.kind.needed), ""), still, allowed)
        allowed = f"allowed is at most {most:g} times the load"
        refuse("load_amplitude", amplitudes.get("load", 0.0) > most, allowed)
        if not self.steady:
            unit = f"the {self.u_lim:.3g} m at which the whole contact slides"
            if self.kind.unit == "rad":
                unit = "the angle at which the stick radius is half the contact radius"
            allowed = f"{self.amplitude:.3g} times {unit}; allowed is at most {most:g} times"
            refuse("amplitude", not self.amplitude <= most, allowed)
        groups = self.drive() | ({} if inputs.speed is None else {"speed": self.velocity})
        for name, group in groups.items():
            allowed = f"divided by that of the contact it is {OUT_OF_RANGE}"
            refuse(INPUT_OF.get(name, name), not math.isfinite(group), allowed)
        allowed = "allowed is a speed above 0 for a longitudinal motion with a spring"
        springs = self.kind.name == "longitudinal" and inputs.drive_stiffness
        refuse("speed", springs and inputs.speed == 0.0, allowed)
        allowed = "allowed is one radius, a circular contact, if the load oscillates"
        refuse("radius_across", self.ratio != 1.0 and self._record.loads, allowed)


def contact_of(inputs: Inputs) -> Contact:
    """Return the contact for scalar inputs.  Raises InputError if the contact is not allowed."""
    with np.errstate(all="ignore"):  # values that are not finite are refused
        try:
            contact = Contact(inputs)
            contact.check()
        except ArithmeticError:  # NumPy's floats become infinite instead
            numbers = {name: np.float64(one.si) for name, one in inputs.quantities.items()}
            contact = Contact(inputs.at(**numbers))
            contact.check()
    return contact


def hertz_ellipse(ratio: Any) -> tuple[Any, Any, Any]:
    """Compute Hertz's elliptic contact from the ratio b/a of its semi-axes.

    Returns
    -------
    tuple of array
        Three values: the smaller relative curvature of the bodies divided by the larger one; a^3
        divided by 3 F R / (4 E*), where R is the larger radius of relative curvature (K. L.
        Johnson, Contact Mechanics, 4.2); and G* in working units (see scene.hertz.Ellipse).
    """
    from scipy.special import ellipe, ellipk  # late, since invalid input is refused without SciPy

    m = np.where(ratio == 1.0, 0.5, 1.0 - ratio**2)
    first, second = ellipk(m), ellipe(m)
    # 1/(2 R) = p0/E* b/(a^2 m) (K - E) along the long axis, with p0 = 3 F/(2 pi a b)
    over = ratio**2 * (first - second) / (second - ratio**2 * first)
    values = (over, 4.0 / math.pi * (first - second) / m, 1.5 / math.pi * first)
    circle = (1.0, 1.0, hertz.G_STAR)
    pairs = zip(circle, values, strict=True)
    over, cube, stiffness = (np.where(ratio == 1.0, *pair) for pair in pairs)
    return over, cube, stiffness


def ratio_of_axes(over: Any) -> Any:
    """Compute the ratio b/a of the semi-axes of Hertz's elliptic contact.

    over: smaller relative curvature divided by the larger one, float or array.
    """
    low, high = np.full_like(over, math.log(1e-8)), np.zeros_like(over)
    with np.errstate(invalid="ignore"):
        for _ in range(60):  # bisection of log(b/a); the curvatures' ratio increases with b/a
            middle = 0.5 * (low + high)
            below = hertz_ellipse(np.exp(middle))[0] < over
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        ratio = np.where(over >= 1.0 - ROUND, 1.0, np.exp(0.5 * (low + high)))
    return ratio if np.ndim(ratio) else float(ratio)
