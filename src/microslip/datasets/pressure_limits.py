"""The limits from theory under another pressure than Hertz's, for datasets.

Rows as in limits.LIMITS: what holds for any pressure (Eqs 6 and 7), what is known of axisymmetric
indenters, and what an elliptic Hertz contact has in common with a circular one.
"""

from functools import partial

import numpy as np

from microslip.pressures.registry import pressure_named
from microslip.theory import axisymmetric, hertz, indenters, masing, paper

_ZONE = (
    "whole stick zone, velocity to 0 (Eq 9)",
    "static friction of the whole stick zone (Eq 9)",
)
ANY_PRESSURE = ("mu_large_amplitude", "mu_static_slider")
"""Limits of a transverse oscillation that hold whatever the pressure (Eqs 6 and 7)."""


def formulas_under(scene, name, of_sphere):
    """What theory says about a scene under the pressure of this name, as a row of limits.LIMITS;
    of_sphere: that row, for Hertz's pressure."""
    pressure = pressure_named(name)
    if scene == "continuous-bore" and pressure.is_round:
        return _steady(pressure)
    found = {key: of_sphere[key] for key in ANY_PRESSURE if scene == "transverse"}
    if scene == "longitudinal" and pressure.loading is not None:
        return _along(pressure.loading, of_sphere)
    if "mu_static" not in of_sphere:
        return found
    dims, exact, *said = of_sphere["mu_static"]
    if pressure.is_indenter:
        zone, exact = _of_indenter(scene, pressure)
    elif pressure.hertzian and scene != "bore":
        zone = paper.static_transverse  # an ellipse of the same shape carries as much
    else:
        return found
    found["mu_static_stick_zone"] = (dims, _each(zone), *_ZONE)
    return found | {"mu_static": (dims, _each(exact), *said)}


def _of_indenter(scene, pressure):
    """Static friction of the whole stick zone, and the exact one, as functions of the amplitude."""
    if scene == "bore":
        return (
            lambda a: _load_inside(pressure, _left_by_torsion(pressure, a)),
            lambda a: indenters.static_bore(pressure, float(hertz.bore_angle(a))),
        )
    return (
        lambda a: _load_inside(pressure, pressure.stick_radius(a)),
        partial(indenters.static_transverse, pressure),
    )


def _along(curve, of_sphere):
    dims, _, *said = of_sphere["mu_static"]
    return {
        "mu_closed_form": (
            ("velocity", "amplitude"),
            lambda velocity, amplitude: masing.longitudinal(velocity, amplitude, curve),
            "mu_macro in closed form",
            "mu_macro in closed form at Poisson's ratio 0 (first loading with Masing's memory)",
        ),
        "mu_static": (dims, lambda a: 1.0 - curve(a), *said),
    }


def _each(function):
    return np.vectorize(lambda value: float(function(float(value))), otypes=[float])


def _left_by_torsion(pressure, amplitude):
    return indenters.torsion_stick_radius(pressure, float(hertz.bore_angle(amplitude)))


def _load_inside(pressure, radius):
    return indenters.static_stick_zone(pressure, radius) if radius > 0.0 else 0.0


def _steady(pressure):
    def forward(velocity):
        return axisymmetric.bore_of(pressure.bound, velocity)[0]

    def torque(velocity):
        return axisymmetric.bore_of(pressure.bound, velocity)[1]

    return {
        "mu_forward_theory": (
            ("velocity",),
            forward,
            "steady mu_macro (Eq 17)",
            "steady mu_macro as an integral over the pressure (Eq 17)",
        ),
        "mu_torque_theory": (
            ("velocity",),
            torque,
            "steady mu_torque (Eq 18)",
            "steady mu_torque as an integral over the pressure (Eq 18)",
        ),
    }
