"""How much friction falls in a real contact, and how far to trust that."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, replace

from ..point import LARGEST, Result, solve
from .contact import TwoBodies
from .doubts import doubts, unchecked
from .groups import SCENES, UNIT_OF_AMPLITUDE, RealMotion, groups
from .materials import RIGID, Material, material_named
from .quantities import si_value

LARGEST_AMPLITUDE = 1e4
"""Dimensionless amplitude beyond which no smaller friction is looked for."""


@dataclass(frozen=True)
class Prediction:
    """Friction of a vibrated contact in SI units.

    velocity, amplitude: dimensionless groups; mu_macro, mu_macro_error: mean forward force over
    mu F_z; mu_apparent: coefficient of friction that is felt, mu mu_macro; friction_force_N and
    friction_force_still_N: with and without vibration; force_reduction: 1 - mu_macro; mu_static:
    mu_macro in the limit of vanishing speed, None for steady motions; speed_m_s, amplitude_si (m or
    rad), frequency_Hz, rotation_rad_s: the motion; warnings: where an assumption breaks;
    not_checked: what was not looked at, and why; converged, reason: as microslip.solve says.
    """

    scene: str
    contact_radius_m: float
    indentation_m: float
    u_lim_m: float
    largest_pressure_Pa: float
    poisson: float
    speed_m_s: float
    amplitude_si: float | None
    frequency_Hz: float | None
    rotation_rad_s: float | None
    velocity: float
    amplitude: float | None
    mu_macro: float
    mu_macro_error: float
    mu_apparent: float
    mu_apparent_error: float
    friction_force_N: float
    friction_force_still_N: float
    force_reduction: float
    mu_static: float | None
    mu_static_error: float | None
    mu_static_apparent: float | None
    model: str
    converged: bool
    reason: str
    warnings: tuple
    not_checked: tuple

    def to_dict(self):
        """Fields as a plain dict."""
        return asdict(self) | {
            "warnings": list(self.warnings),
            "not_checked": list(self.not_checked),
        }


def predict(
    scene,
    *,
    radius,
    load,
    mu,
    speed,
    young=None,
    nu=None,
    material=None,
    counterbody="rigid",
    counter_radius=None,
    amplitude=None,
    frequency=None,
    rotation=None,
    reduction=None,
    hardness=None,
    density=None,
    counter_hardness=None,
    counter_density=None,
    tolerance=1e-3,
):
    """Friction of a sphere on a flat (or on a second sphere) under vibration.

    Quantities are texts with units ("5 mm"), pint quantities, or numbers in SI units.
    scene: "transverse", "longitudinal", "zigzag", "bore" or "continuous-bore"; young, nu: of the
    body, or material: a name in materials.MATERIALS; counterbody: "rigid", such a name, or "E, nu"
    as in "70 GPa, 0.22"; radius: of the sphere; counter_radius: of the counterbody, negative if
    hollow, None if flat; load, mu: normal force and coefficient of friction; speed: of sliding;
    amplitude: half stroke of the oscillation, a length or an angle; frequency: its frequency, not
    angular; rotation: angular speed of a continuous bore; reduction: instead of the amplitude, the
    share of friction to be taken away, in 0..1: the amplitude that does it is looked for; hardness,
    density, counter_hardness, counter_density: of the body and the counterbody, for the warnings
    alone; tolerance: on mu_macro.
    Returns a Prediction.  Raises ValueError, naming the argument, for what is missing or out of
    range, and where no amplitude takes that much friction away.
    """
    contact = _contact(
        _body(young, nu, material, hardness, density),
        _counterbody(counterbody, counter_hardness, counter_density),
        *(radius, counter_radius, load, mu),
    )
    motion = _motion(scene, speed, amplitude, frequency, rotation, reduction)
    if reduction is not None:
        motion = _motion_for(contact, motion, reduction, tolerance)
    velocity, size = groups(motion, contact)
    fast = min(velocity, LARGEST["velocity"])  # beyond, the vibration does nothing
    answer = solve(scene, fast, size, poisson=contact.poisson, tolerance=tolerance)
    limit = None
    if size is not None:
        limit = solve(scene, 0.0, size, poisson=contact.poisson, tolerance=tolerance)
    return _prediction(contact, motion, velocity, answer, limit)


def _prediction(contact, motion, velocity, answer: Result, limit: Result | None):
    still = contact.mu * contact.load
    return Prediction(
        scene=motion.scene,
        contact_radius_m=contact.contact_radius,
        indentation_m=contact.indentation,
        u_lim_m=contact.u_lim,
        largest_pressure_Pa=contact.largest_pressure,
        poisson=contact.poisson,
        speed_m_s=motion.speed,
        amplitude_si=motion.amplitude,
        frequency_Hz=motion.frequency,
        rotation_rad_s=motion.rotation,
        velocity=velocity,
        amplitude=answer.amplitude,
        mu_macro=answer.mu_macro,
        mu_macro_error=answer.mu_macro_error,
        mu_apparent=contact.mu * answer.mu_macro,
        mu_apparent_error=contact.mu * answer.mu_macro_error,
        friction_force_N=still * answer.mu_macro,
        friction_force_still_N=still,
        force_reduction=1.0 - answer.mu_macro,
        mu_static=None if limit is None else limit.mu_macro,
        mu_static_error=None if limit is None else limit.mu_macro_error,
        mu_static_apparent=None if limit is None else contact.mu * limit.mu_macro,
        model=answer.model,
        converged=answer.converged and (limit is None or limit.converged),
        reason=answer.reason or ("" if limit is None else limit.reason),
        warnings=tuple(doubts(contact, motion)),
        not_checked=tuple(unchecked(contact)),
    )


# Input


def _body(young, nu, material, hardness, density):
    if material is not None:
        if young is not None or nu is not None:
            raise ValueError(f"material = {material!r}: allowed without young and nu")
        body = material_named(material)
    elif young is None or nu is None:
        missing = "young" if young is None else "nu"
        raise ValueError(f"{missing} = None: needed, or a material by name")
    else:
        body = _elastic("young", young, "nu", nu)
    return _completed(body, "", hardness, density)


def _completed(body, side, hardness, density):
    """The body with what is given of hardness and density; side: of the names of the arguments."""
    for name, given, unit in (("hardness", hardness, "Pa"), ("density", density, "kg/m^3")):
        if given is not None and body.rigid:
            raise ValueError(
                f"{side}{name} = {given!r}: allowed for an elastic body, not a rigid one"
            )
        if given is not None:
            body = replace(body, **{name: si_value(f"{side}{name}", given, unit)})
    return body


def _elastic(young_name, young, nu_name, nu):
    return Material(
        si_value(young_name, young, "Pa"), si_value(nu_name, nu, "", low_open=False, high=0.5)
    )


def _counterbody(given, hardness, density):
    return _completed(_body_opposite(given), "counter_", hardness, density)


def _body_opposite(given):
    if isinstance(given, Material):
        return given
    if not isinstance(given, str):
        raise ValueError(f"counterbody = {given!r}: allowed is a text such as '70 GPa, 0.22'")
    if given == "rigid":
        return RIGID
    young, comma, nu = given.partition(",")
    if not comma:
        try:
            return material_named(given)
        except ValueError as error:
            named = str(error).replace("material =", "counterbody =")
            raise ValueError(f"{named}, or E and nu as in '70 GPa, 0.22'") from None
    return _elastic("counterbody", young, "counterbody", nu)


def _contact(body, other, radius, counter_radius, load, mu):
    curvature = 1.0 / si_value("radius", radius, "m")
    if counter_radius is not None:
        other_radius = si_value("counter_radius", counter_radius, "m", low=-math.inf)
        curvature = curvature + 1.0 / other_radius if other_radius else 0.0
    if not curvature > 0.0:
        raise ValueError(
            f"counter_radius = {counter_radius}: allowed is a hollow wider than the sphere"
        )
    return TwoBodies(body, other, 1.0 / curvature, si_value("load", load, "N"), _friction(mu))


def _friction(mu):
    return si_value("mu", mu, "", high=10.0)


def _motion(scene, speed, amplitude, frequency, rotation, reduction):
    if scene not in SCENES:
        raise ValueError(f"scene = {scene!r}: allowed is one of {', '.join(SCENES)}")
    given = {"amplitude": amplitude, "frequency": frequency, "rotation": rotation}
    needed = ("rotation",) if scene == "continuous-bore" else ("amplitude", "frequency")
    for name, value in given.items():
        if name not in needed and value is not None:
            raise ValueError(f"{name} = {value!r}: {scene} has none")
    if reduction is not None and scene == "continuous-bore":
        raise ValueError(f"reduction = {reduction!r}: {scene} has no amplitude to look for")
    if reduction is not None and amplitude is not None:
        raise ValueError(f"reduction = {reduction!r}: allowed without an amplitude")
    for name in needed:
        if given[name] is None and not (name == "amplitude" and reduction is not None):
            raise ValueError(f"{name} = None: {scene} needs it")
    speed = si_value("speed", speed, "m/s", low_open=False)
    if scene == "continuous-bore":
        return RealMotion(scene, speed, rotation=si_value("rotation", rotation, "rad/s"))
    if reduction is None:
        amplitude = si_value("amplitude", amplitude, UNIT_OF_AMPLITUDE[scene], low_open=False)
    return RealMotion(scene, speed, amplitude, si_value("frequency", frequency, "Hz"))


# The other way round


def _motion_for(contact, motion, reduction, tolerance):
    """The motion with the least amplitude that takes a share of friction away."""
    from scipy.optimize import brentq

    wanted = si_value("reduction", reduction, "", high=1.0)

    def missing(log_amplitude):
        velocity, size = groups(replace(motion, amplitude=math.exp(log_amplitude)), contact)
        settings = {"poisson": contact.poisson, "tolerance": tolerance}
        return solve(motion.scene, velocity, size, **settings).mu_macro - (1.0 - wanted)

    unit = contact.u_lim / (contact.contact_radius if motion.scene == "bore" else 1.0)
    low, high = math.log(1e-6 * unit), math.log(unit)
    if missing(low) < 0.0:
        return replace(motion, amplitude=math.exp(low))
    while missing(high) > 0.0:
        high += math.log(2.0)
        if high > math.log(LARGEST_AMPLITUDE * unit):
            raise ValueError(
                f"reduction = {_as_percent(wanted)}: no amplitude up to "
                f"{LARGEST_AMPLITUDE:g} times the one that lets the contact slide takes that much "
                "friction away"
            )
    return replace(motion, amplitude=math.exp(brentq(missing, low, high, xtol=0.1 * tolerance)))


def _as_percent(share):
    return f"{100.0 * share:g} %"
