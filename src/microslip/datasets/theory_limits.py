"""The limits from theory that stand beside the computed points in a dataset.

Each is a variable on the axes of the sweep, to compare with point by point, and a curve on an axis
fine enough to draw. A formula added here appears in the dataset of its scene.
"""

import numpy as np

from microslip.config.extended import solver_names
from microslip.theory import masing, paper

CURVE_POINTS = 241

_ZONE = "whole stick zone, velocity to 0"
_WHOLE_ZONE = "static friction of the whole stick zone"
_LIMIT = "exact limit for velocity to 0"
_EXACT = "static friction, exact limit of mu_macro for velocity to 0"
_EXACT_AT_0 = f"{_EXACT} at Poisson's ratio 0"

# scene, under Hertz's pressure -> name -> (dims, function of their coordinates, long_name, and a
# description where there is more to say)
LIMITS = {
    "transverse": {
        "mu_large_amplitude": (
            ("velocity", "amplitude"),
            paper.large_amplitude_transverse,
            "rigid slider, large amplitude (Eq 6)",
            "mu_macro at large amplitude, rigid slider (Eq 6)",
        ),
        "mu_static_slider": (
            ("amplitude",),
            paper.static_slider,
            "elastic slider, velocity to 0 (Eq 7)",
            "static friction of an elastic slider (Eq 7)",
        ),
        "mu_static_stick_zone": (
            ("amplitude",),
            paper.static_transverse,
            f"{_ZONE} (Eq 11)",
            f"{_WHOLE_ZONE} (Eq 11)",
        ),
        "mu_static": (("amplitude",), paper.static_limit_transverse, _LIMIT, _EXACT_AT_0),
    },
    "bore": {
        "mu_large_amplitude": (
            ("velocity",),
            paper.large_amplitude_bore,
            "steady at every instant (Eq 29)",
            "mu_macro at large amplitude, steady at every instant (Eq 29)",
        ),
        "mu_static_stick_zone": (
            ("amplitude",),
            paper.static_bore,
            "whole stick zone (Eq 33, squared)",
            f"{_WHOLE_ZONE} (Eq 33 with the square that Eq 10 demands)",
        ),
        "mu_static_stick_zone_printed": (
            ("amplitude",),
            paper.static_bore_printed,
            "whole stick zone (Eq 33 as printed)",
            f"{_WHOLE_ZONE} (Eq 33 as printed)",
        ),
        "mu_static": (("amplitude",), paper.static_limit_bore, _LIMIT, _EXACT),
    },
    "longitudinal": {
        "mu_closed_form": (
            ("velocity", "amplitude"),
            masing.longitudinal,
            "mu_macro in closed form",
            "mu_macro in closed form at Poisson's ratio 0 (Mindlin's curve with Masing's memory)",
        ),
        "mu_static": (("amplitude",), paper.static_limit_longitudinal, _LIMIT, _EXACT_AT_0),
    },
    "zigzag": {
        "mu_static": (("amplitude",), paper.static_limit_transverse, _LIMIT, _EXACT_AT_0),
    },
    "continuous-bore": {
        "mu_forward_theory": (
            ("velocity",),
            paper.bore_forward,
            "steady mu_macro (Eq 21)",
            "steady mu_macro in closed form (Eq 21)",
        ),
        "mu_torque_theory": (
            ("velocity",),
            paper.bore_torque,
            "steady mu_torque (Eq 22)",
            "steady mu_torque in closed form (Eq 22)",
        ),
    },
}


def formulas(scene, pressure="hertz"):
    """What theory says about a scene under a pressure, by the solver's names; as a row of LIMITS,
    {} if it says nothing."""
    if pressure == "hertz":
        return LIMITS.get(scene, {})
    from microslip.datasets.pressure_limits import (
        formulas_under,  # what it needs takes a while to load
    )

    return formulas_under(scene, pressure, LIMITS.get(scene, {}))


def variables(sweep):
    """Variables on the axes of a settings.Sweep: name -> (dims, values, attributes)."""
    found = {}
    for name, (dims, function, *said) in formulas(*solver_names(sweep)).items():
        axes = [np.array(getattr(sweep, dim)) for dim in dims]
        # meshgrid puts the first coordinate last, as the datasets do
        found[name] = _variable(dims[::-1], function(*np.meshgrid(*axes)), *said)
    return found


def curves(sweep):
    """The same on axes fine enough to draw, by `velocity_curves` and `amplitude_curves`.

    Beside every limit stands `<name>_curve`, on the fine axis `amplitude_curve` or
    `velocity_curve`; of a limit that depends on both it is the one at the largest amplitude.
    """
    found = {}
    for name, (dims, function, long_name, *rest) in formulas(*solver_names(sweep)).items():
        axes = [np.array(getattr(sweep, dim)) for dim in dims]
        along, fine = f"{dims[0]}_curve", _fine(dims[0], axes[0])
        values = function(fine, *(axis[-1] for axis in axes[1:]))
        at = f", at amplitude {axes[1][-1]:g}" if len(axes) > 1 else ""
        group = found.setdefault(f"{along}s", {})
        group[along] = _variable((along,), fine, f"fine {dims[0]} axis of the limits")
        group[f"{name}_curve"] = _variable(
            (along,), values, long_name, f"{[long_name, *rest][-1]}{at}"
        )
    return found


def _fine(dim, axis):
    """A fine axis over the range of an axis; velocities in equal ratios, from the first above 0."""
    positive = axis[axis > 0.0]
    if dim == "velocity" and len(positive):
        # the same digits on every machine, whatever its logarithm rounds to
        return np.array([float(f"{v:.12g}") for v in _ratios(positive[0], axis[-1])])
    return np.linspace(axis[0], axis[-1], CURVE_POINTS)


def _ratios(first, last):
    return np.geomspace(first, last, CURVE_POINTS)


def _variable(dims, values, long_name, description=None):
    said = {"long_name": long_name, "units": "1"}
    return (
        dims,
        np.array(values, float),
        said | ({"description": description} if description else {}),
    )
