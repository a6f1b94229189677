"""The limits from theory under another pressure than Hertz's, for datasets.

Rows as in limits.LIMITS: what holds for any pressure (Eqs 6 and 7), what is known of axisymmetric
indenters, and what an elliptic Hertz contact has in common with a circular one.
"""

from functools import partial

import numpy as np

from . import any_pressure, hertz, indenter_limits, masing, theory
from .pressures import pressure_named

_ZONE = "static friction of the whole stick zone (Eq 9)"
_EXACT = "static friction, exact limit of mu_macro for velocity to 0"
_EXACT_AT_0 = f"{_EXACT} at Poisson's ratio 0"
_ANY = {
    "mu_large_amplitude": (
        ("velocity", "amplitude"),
        theory.large_amplitude_transverse,
        "mu_macro at large amplitude, rigid slider (Eq 6)",
    ),
    "mu_static_slider": (
        ("amplitude",),
        theory.static_slider,
        "static friction of an elastic slider (Eq 7)",
    ),
}
"""Of a transverse oscillation, whatever the pressure."""


def formulas_under(scene, name):
    """What theory says about a scene under the pressure of this name, as a row of limits.LIMITS."""
    pressure = pressure_named(name)
    if scene == "continuous-bore" and pressure.is_round:
        return _steady(pressure)
    found = dict(_ANY) if scene == "transverse" else {}
    if pressure.is_indenter:
        return found | _of_indenter(scene, pressure)
    if name.partition(":")[0] == "ellipse":
        return found | _of_ellipse(scene)
    return found


def _of_indenter(scene, pressure):
    if scene == "bore":
        return _rows(
            lambda a: _load_inside(pressure, _left_by_torsion(pressure, a)),
            lambda a: indenter_limits.static_bore(pressure, float(hertz.bore_angle(a))),
            _EXACT,
        )
    if scene in ("transverse", "zigzag"):
        return _rows(
            lambda a: _load_inside(pressure, pressure.stick_radius(a)),
            partial(indenter_limits.static_transverse, pressure),
            _EXACT_AT_0,
        )
    if scene == "longitudinal":
        return _along(partial(indenter_limits.loading, pressure))
    return {}


def _of_ellipse(scene):
    """Its stick zone is an ellipse of the same shape, which carries the same share of the load."""
    if scene in ("transverse", "zigzag"):
        exact = theory.static_limit_transverse
        return _rows(theory.static_transverse, exact, _EXACT_AT_0)
    return _along(hertz.mindlin_force) if scene == "longitudinal" else {}


def _along(curve):
    return {
        "mu_closed_form": (
            ("velocity", "amplitude"),
            lambda velocity, amplitude: masing.longitudinal(velocity, amplitude, curve),
            "mu_macro in closed form at Poisson's ratio 0 (first loading with Masing's memory)",
        ),
        "mu_static": (("amplitude",), lambda a: 1.0 - curve(a), _EXACT_AT_0),
    }


def _rows(zone, exact, said):
    return {
        "mu_static_stick_zone": (("amplitude",), _each(zone), _ZONE),
        "mu_static": (("amplitude",), _each(exact), said),
    }


def _each(function):
    return np.vectorize(lambda value: float(function(float(value))), otypes=[float])


def _left_by_torsion(pressure, amplitude):
    return indenter_limits.torsion_stick_radius(pressure, float(hertz.bore_angle(amplitude)))


def _load_inside(pressure, radius):
    return indenter_limits.static_stick_zone(pressure, radius) if radius > 0.0 else 0.0


def _steady(pressure):
    def forward(velocity):
        return any_pressure.bore_of(pressure.bound, velocity)[0]

    def torque(velocity):
        return any_pressure.bore_of(pressure.bound, velocity)[1]

    return {
        "mu_forward_theory": (("velocity",), forward, "steady mu_macro (Eq 17)"),
        "mu_torque_theory": (("velocity",), torque, "steady mu_torque (Eq 18)"),
    }
