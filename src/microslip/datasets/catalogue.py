"""Closed forms for each motion, with their limits, ranges of validity and names.

The catalogue is used for datasets, figures, values outside the tabulated range, and the study of
the paper's claims. The forms apply to Hertz pressure; for other pressures see
datasets.pressure_limits. The solver uses exact.py instead, so editing a name here does not change
stored results.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from microslip.theory import drift, masing, paper
from microslip.theory.exact import STATIC_LIMITS

STATIC = "mu_static"
"""Name of the exact limit as the velocity tends to 0. All motions use this name."""


@dataclass(frozen=True)
class ClosedForm:
    """A formula for the friction or the torque of a motion.

    Attributes
    ----------
    name : str
        Name of the variable in a dataset.
    function : callable
        Function of the ``arguments``. Arguments and result are dimensionless arrays.
    arguments : tuple of str
        "velocity", "amplitude" or both.
    equation, label : str
        Equation in the paper ("" if the paper does not contain the form), and name in a legend.
    long_name, description : str
        Long name and description in a dataset. An empty description is omitted.
    exact : bool
        True if the form is exact in its limit, False if it is an estimate.
    any_poisson, any_pressure : bool
        any_poisson: True if the form applies to every Poisson's ratio; otherwise it applies to 0
        only. any_pressure: True if it applies to every pressure; otherwise it applies to Hertz
        pressure only.
    """

    name: str
    function: Callable
    arguments: tuple[str, ...]
    equation: str
    label: str
    long_name: str
    description: str = ""
    exact: bool = True
    any_poisson: bool = False
    any_pressure: bool = False


_BOTH, _VELOCITY, _AMPLITUDE = ("velocity", "amplitude"), ("velocity",), ("amplitude",)
_WHOLE = "static friction of the whole stick zone"
_EXACT = "static friction, exact limit of mu_macro for velocity to 0"


def _by_name(*forms: ClosedForm) -> dict[str, ClosedForm]:
    return {form.name: form for form in forms}


FORMS = {
    "transverse": _by_name(
        ClosedForm(
            *("mu_large_amplitude", paper.large_amplitude_transverse, _BOTH),
            *("Eq 6", "Eq 6", "rigid slider, large amplitude (Eq 6)"),
            "mu_macro at large amplitude, rigid slider (Eq 6)",
            any_poisson=True,
            any_pressure=True,
        ),
        ClosedForm(
            *("mu_static_slider", paper.static_slider, _AMPLITUDE),
            *("Eq 7", "Eq 7, slider", "elastic slider, velocity to 0 (Eq 7)"),
            "static friction of an elastic slider (Eq 7)",
            exact=False,
            any_pressure=True,
        ),
        ClosedForm(
            *("mu_static_stick_zone", paper.static_transverse, _AMPLITUDE),
            *("Eq 11", "Eq 11, stick zone", "whole stick zone, velocity to 0 (Eq 11)"),
            f"{_WHOLE} (Eq 11)",
            exact=False,
        ),
    ),
    "bore": _by_name(
        ClosedForm(
            *("mu_large_amplitude", paper.large_amplitude_bore, _VELOCITY),
            *("Eq 29", "Eq 29", "steady at every instant (Eq 29)"),
            "mu_macro at large amplitude, steady at every instant (Eq 29)",
            any_poisson=True,
        ),
        ClosedForm(
            *("mu_static_stick_zone", paper.static_bore, _AMPLITUDE),
            *("Eq 33", "Eq 33, corrected", "whole stick zone (Eq 33, squared)"),
            f"{_WHOLE} (Eq 33 with the square that Eq 10 requires)",
            exact=False,
            any_poisson=True,
        ),
        ClosedForm(
            *("mu_static_stick_zone_printed", paper.static_bore_printed, _AMPLITUDE),
            *("Eq 33 as printed", "Eq 33 as printed", "whole stick zone (Eq 33 as printed)"),
            f"{_WHOLE} (Eq 33 as printed)",
            exact=False,
            any_poisson=True,
        ),
    ),
    "longitudinal": _by_name(
        ClosedForm(
            *("mu_closed_form", masing.longitudinal, _BOTH),
            *("", "closed form", "mu_macro in closed form"),
            "mu_macro in closed form at Poisson's ratio 0 (Mindlin's curve with Masing's memory)",
        ),
    ),
    "continuous-bore": _by_name(
        ClosedForm(
            *("mu_forward_theory", paper.bore_forward, _VELOCITY),
            *("Eq 21", "force, Eq 21", "steady mu_macro (Eq 21)"),
            "steady mu_macro in closed form (Eq 21)",
            any_poisson=True,
        ),
        ClosedForm(
            *("mu_torque_theory", paper.bore_torque, _VELOCITY),
            *("Eq 22", "torque, Eq 22", "steady mu_torque (Eq 22)"),
            "steady mu_torque in closed form (Eq 22)",
            any_poisson=True,
        ),
    ),
}
"""Closed forms by motion and name, in the order in which datasets list them."""
for _motion, _limit in STATIC_LIMITS.items():
    _at_0 = "" if _limit.any_poisson else " at Poisson's ratio 0"
    FORMS.setdefault(_motion, {})[STATIC] = ClosedForm(
        *(STATIC, _limit.function, _AMPLITUDE),
        *("", "exact limit", "exact limit for velocity to 0", _EXACT + _at_0),
        any_poisson=_limit.any_poisson,
    )


DRIFT_FORMS = {
    motion: ClosedForm(
        *("velocity_large_amplitude", function, ("force", "amplitude")),
        *("", "rigid", "mean velocity under a force, rigid contact"),
        "mean velocity that a constant force gives a rigid contact without mass",
        any_poisson=True,
        any_pressure=motion == "transverse",
    )
    for motion, function in (("transverse", drift.transverse_drift), ("bore", drift.bore_drift))
}
"""Closed forms for the mean velocity under a constant force, by motion."""
