"""Closed forms for pressures other than Hertz's pressure under a sphere, as in datasets.catalogue.

Some closed forms are valid for any pressure (Eqs 6 and 7), others for axisymmetric indenters.  Some
closed forms of circular Hertz contacts are also valid for elliptic ones.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from microslip.datasets.catalogue import FORMS, STATIC, ClosedForm
from microslip.pressures.by_name import pressure_named
from microslip.pressures.pressure import Pressure
from microslip.theory import axisymmetric, hertz, indenters, masing, paper

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
    exact = of_sphere[STATIC]
    if pressure.is_indenter:
        zone, static = _of_indenter(motion, pressure)
        exact = replace(exact, function=_each(static))
    elif pressure.hertzian and motion != "bore":
        # An elliptic stick zone carries the same fraction of the load.
        zone = paper.static_transverse
        exact = replace(exact, function=_each(exact.function))
    else:
        return forms
    whole = replace(ZONE, function=_each(zone))
    return forms | {whole.name: whole, STATIC: exact}


def _of_indenter(motion: str, pressure: Pressure) -> tuple[Callable, Callable]:
    """Return two functions of the amplitude: the fraction of the load inside the stick zone, and
    the exact static friction."""
    if motion == "bore":

        def stick_radius(amplitude: float) -> float:
            return indenters.torsion_stick_radius(pressure, float(hertz.bore_angle(amplitude)))

        return (
            lambda a: _load_inside(pressure, stick_radius(a)),
            lambda a: indenters.static_bore(pressure, float(hertz.bore_angle(a))),
        )
    return (
        lambda a: _load_inside(pressure, pressure.stick_radius(a) or 0.0),
        partial(indenters.static_transverse, pressure),
    )


def _along(curve: Callable, of_sphere: dict[str, ClosedForm]) -> dict[str, ClosedForm]:
    whole = replace(
        of_sphere["mu_closed_form"],
        function=lambda velocity, amplitude: masing.longitudinal(velocity, amplitude, curve),
        description="mu_macro in closed form at Poisson's ratio 0 (first loading with Masing's "
        "memory)",
    )
    static = replace(of_sphere[STATIC], function=lambda a: 1.0 - curve(a))
    return {whole.name: whole, STATIC: static}


def _each(function: Callable[[float], float]) -> Callable:
    return np.vectorize(lambda value: float(function(float(value))), otypes=[float])


def _load_inside(pressure: Pressure, radius: float) -> float:
    return float(pressure.load(radius, 1.0)) if radius > 0.0 else 0.0


def _steady(pressure: Pressure, of_sphere: dict[str, ClosedForm]) -> dict[str, ClosedForm]:
    """Return the closed forms of the steady bore, with Eqs 17 and 18 instead of Eqs 21 and 22."""
    forms = {}
    for part, (name, form) in enumerate(of_sphere.items()):
        equation, what = (("Eq 17", "mu_macro"), ("Eq 18", "mu_torque"))[part]
        forms[name] = replace(
            form,
            function=lambda velocity, part=part: axisymmetric.bore_of(pressure.bound, velocity)[
                part
            ],
            equation=equation,
            long_name=f"steady {what} ({equation})",
            description=f"steady {what} as an integral over the pressure ({equation})",
        )
    return forms
