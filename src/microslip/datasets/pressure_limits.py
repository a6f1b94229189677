"""Closed forms for pressures that differ from the Hertz pressure of a sphere.

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
from microslip.theory import hertz, indenters, masing

ZONE = replace(
    FORMS["transverse"]["mu_static_stick_zone"],
    equation="Eq 9",
    long_name="whole stick zone, velocity to 0 (Eq 9)",
    description="static friction of the whole stick zone (Eq 9)",
)


STEADY = (("mu_forward_theory", "Eq 17", "mu_macro"), ("mu_torque_theory", "Eq 18", "mu_torque"))
"""Name, equation and quantity of each closed form of the steady bore.  The equations replace Eqs 21
and 22."""


def formulas_under(motion: str, name: str) -> dict[str, ClosedForm]:
    """Return the closed forms for a motion and a pressure, as a dict keyed by the name of the form.
    `name` is the name of the pressure."""
    pressure, of_sphere = pressure_named(name), FORMS.get(motion, {})
    forms = {key: form for key, form in of_sphere.items() if form.any_pressure}
    if motion == "continuous-bore" and pressure.is_round:
        for part, (key, equation, what) in enumerate(STEADY):
            forms[key] = replace(
                of_sphere[key],
                function=lambda v, part=part: indenters.bore_of(pressure.bound, v)[part],
                equation=equation,
                long_name=f"steady {what} ({equation})",
                description=f"steady {what} as an integral over the pressure ({equation})",
            )
    elif motion == "longitudinal" and (curve := pressure.loading) is not None:
        text = "mu_macro in closed form at Poisson's ratio 0 (first loading with Masing's memory)"
        whole = replace(of_sphere["mu_closed_form"], description=text)
        forms[whole.name] = replace(whole, function=partial(masing.longitudinal, curve=curve))
        forms[STATIC] = replace(of_sphere[STATIC], function=lambda a: 1.0 - curve(a))
    elif STATIC in of_sphere:
        exact = ZONE, of_sphere[STATIC]
        functions: tuple[Callable, ...] = ()
        if pressure.is_indenter:
            functions = _of_indenter(motion, pressure)
        elif pressure.hertzian and motion != "bore":
            # An elliptic stick zone carries the same fraction of the load as a circular one.
            functions = ZONE.function, of_sphere[STATIC].function
        for form, function in zip(exact, functions, strict=False):
            forms[form.name] = replace(form, function=np.vectorize(function, otypes=[float]))
    return forms


def _of_indenter(motion: str, pressure: Pressure) -> tuple[Callable, Callable]:
    """Return two functions of the amplitude: the fraction of the load inside the stick zone, and
    the exact static friction."""
    place: Callable = hertz.bore_angle if motion == "bore" else float
    radius: Callable = pressure.stick_radius
    static: Callable = partial(indenters.static_transverse, pressure)
    if motion == "bore":
        radius = partial(indenters.torsion_stick_radius, pressure)
        static = partial(indenters.static_bore, pressure)

    def zone(amplitude: float) -> float:
        stick = radius(float(place(amplitude))) or 0.0
        return float(pressure.load(stick, 1.0)) if stick > 0.0 else 0.0

    return zone, lambda amplitude: static(float(place(amplitude)))
