"""Closed forms for pressures other than Hertz's pressure under a sphere, as in datasets.catalogue.

Some closed forms are valid for any pressure (Eqs 6 and 7), others for axisymmetric indenters.  Some
closed forms of circular Hertz contacts are also valid for elliptic ones.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from microslip.datasets.catalogue import FORMS, STATIC, ClosedForm
from microslip.scene.by_name import pressure_named
from microslip.scene.pressure import Pressure
from microslip.theory import hertz, indenters, masing, paper

ZONE = replace(
    FORMS["transverse"]["mu_static_stick_zone"],
    equation="Eq 9",
    long_name="whole stick zone, velocity to 0 (Eq 9)",
    description="static friction of the whole stick zone (Eq 9)",
)


def formulas_under(motion: str, name: str) -> dict:
    """Return a dict of the closed forms by name.  motion, name: names of the motion and the
    pressure."""
    pressure, of_sphere = pressure_named(name), FORMS.get(motion, {})
    if motion == "continuous-bore" and pressure.is_round:
        return _steady(pressure, of_sphere)
    if motion == "longitudinal" and pressure.loading is not None:
        return _along(pressure.loading, of_sphere)
    forms = {key: form for key, form in of_sphere.items() if form.any_pressure}
    if STATIC not in of_sphere:
        return forms
    if pressure.is_indenter:
        zone, static = _of_indenter(motion, pressure)
    elif pressure.hertzian and motion != "bore":
        # An elliptic stick zone carries the same fraction of the load.
        zone, static = paper.static_transverse, of_sphere[STATIC].function
    else:
        return forms
    exact = {ZONE.name: (ZONE, zone), STATIC: (of_sphere[STATIC], static)}
    return forms | {key: replace(form, function=_each(f)) for key, (form, f) in exact.items()}


def _of_indenter(motion: str, pressure: Pressure) -> tuple[Callable, Callable]:
    """Return two functions of the amplitude: the fraction of the load inside the stick zone, and
    the exact static friction."""

    def turned(function: Callable) -> Callable:
        return lambda amplitude: function(pressure, float(hertz.bore_angle(amplitude)))

    if motion == "bore":
        radius = turned(indenters.torsion_stick_radius)
        static = turned(indenters.static_bore)
    else:
        radius, static = pressure.stick_radius, partial(indenters.static_transverse, pressure)

    def zone(amplitude: float) -> float:
        stick = radius(amplitude) or 0.0
        return float(pressure.load(stick, 1.0)) if stick > 0.0 else 0.0

    return zone, static


def _along(curve: Callable, of_sphere: dict[str, ClosedForm]) -> dict[str, ClosedForm]:
    whole = replace(
        of_sphere["mu_closed_form"],
        function=partial(masing.longitudinal, curve=curve),
        description="mu_macro in closed form at Poisson's ratio 0 (first loading with Masing's "
        "memory)",
    )
    return {
        whole.name: whole,
        STATIC: replace(of_sphere[STATIC], function=lambda a: 1.0 - curve(a)),
    }


def _each(function: Callable[[float], float]) -> Callable:
    return np.vectorize(lambda value: float(function(float(value))), otypes=[float])


def _steady(pressure: Pressure, of_sphere: dict[str, ClosedForm]) -> dict[str, ClosedForm]:
    """Return the closed forms of the steady bore, with Eqs 17 and 18 instead of Eqs 21 and 22."""
    equations = ("Eq 17", "mu_macro"), ("Eq 18", "mu_torque")
    return {
        name: replace(
            form,
            function=lambda velocity, part=part: indenters.bore_of(pressure.bound, velocity)[part],
            equation=equation,
            long_name=f"steady {what} ({equation})",
            description=f"steady {what} as an integral over the pressure ({equation})",
        )
        for part, ((name, form), (equation, what)) in enumerate(
            zip(of_sphere.items(), equations, strict=True)
        )
    }
