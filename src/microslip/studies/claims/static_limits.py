"""The static limit of the two oscillating motions, and the paper's formulas for it.

The paper's formulas count the whole friction bound inside the stick zone, although the oscillation
uses a part of it (see microslip.solver.static_limit). The paper's own runs do not show the
difference, because their velocity is too large and their resolution is too coarse.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import j0

from microslip.config.settings import STATIC_AMPLITUDES, Claims
from microslip.datasets.catalogue import FORMS, STATIC
from microslip.datasets.variables import variable
from microslip.studies.claims import claims
from microslip.studies.claims.runs import Run, Runs, friction
from microslip.studies.tables import value_of
from microslip.theory import hertz
from microslip.theory import paper as theory

FORMULAS = {
    "transverse": {
        "slider": ("mu_static_slider", "static friction of an elastic slider (Eq 7)"),
        "zone": ("mu_static_stick_zone", "load inside the stick zone (Eq 11)"),
    },
    "bore": {
        "zone": ("mu_static_stick_zone", "load inside the stick zone (Eq 33 with its square)"),
        "zone_printed": ("mu_static_stick_zone_printed", "Eq 33 as printed"),
    },
}
"""The paper's formulas for each motion: name -> (name in datasets.catalogue, long_name)."""
CURVE_POINTS = 501
SHARE_AMPLITUDES = {"transverse": (0.1, 0.25, 0.5, 0.75), "bore": (0.25, 0.5, 1.0, 2.0)}
RADII = 201


def limit(
    study: Claims, runs: Runs, motion: str, amplitude: float
) -> tuple[float, float, tuple[Run, Run]]:
    """Return the static limit at an amplitude: closed form, error, and runs used for the error.

    The error is an independent check of the closed form. It is the distance between the closed form
    and the limit on rings, plus the error estimates of the two values.
    """
    closed = runs(claims.point(study, motion, 0.0, amplitude))
    rings = runs(claims.resolved_limit(study, motion, amplitude))
    value, rounding = friction(closed)
    resolved, error = friction(rings)
    return value, rounding + error + abs(resolved - value), (closed, rings)


def asymptote(amplitude: ArrayLike) -> np.ndarray:
    """Return the static limit of the oscillating bore for large amplitudes (small stick zones).

    The radius of the stick zone is c = (4/e) exp(-D(1/2) amplitude), and the rotation uses the
    fraction (2/pi) arcsin(r/c) of the friction bound. The integral of the remaining bound is
    3/4 (1 - J0(pi)) c^2, where J0 is a Bessel function. Eq 33 tends to 3/2 c^2. The result is
    dimensionless and positive. amplitude: array of any shape.
    """
    radius = 4.0 / np.e * np.exp(-hertz.D_half() * np.asarray(amplitude, float))
    return 0.75 * (1.0 - j0(np.pi)) * radius**2


def used_share(motion: str, radius: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
    """Return the fraction of the friction bound that the oscillation uses at its turning points.

    The fraction is 1 outside the stick radius. The arguments broadcast.
    """
    if motion == "bore":
        return np.asarray(hertz.lubkin_share(radius, theory.bore_stick_radius(amplitude)))
    bound = hertz.friction_bound(radius)
    traction = hertz.mindlin_traction(radius, amplitude)
    return np.where(bound > 0, traction / np.where(bound > 0, bound, 1.0), 1.0)


def left_share(motion: str, radius: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
    """Return the fraction of the friction bound that remains for the forward direction.

    It is averaged over the angle.
    """
    used = used_share(motion, radius, amplitude)
    if motion == "bore":
        return 2.0 / np.pi * np.arccos(used)
    return np.sqrt((1.0 - used) * (1.0 + used))


def variables(study: Claims, runs: Runs) -> dict:
    """Return the variables of the dataset for the static limits of the two motions."""
    entries: dict[str, tuple] = {}
    for motion in study.amplitude:
        entries |= _curves(motion) | _shares(motion) | _split(study, runs, motion)
    slowest, excess = claims.velocities(study)[0], 1.5 / (0.75 * (1.0 - j0(np.pi))) - 1.0
    about = "excess of Eq 33 over the static limit at large amplitudes, over the limit"
    return entries | {
        "claims_slowest": variable((), slowest, "smallest velocity of this study"),
        "claims_paper_velocity": variable(
            (), claims.PAPER_VELOCITY, "smallest velocity of the paper"
        ),
        "static_asymptote_excess": variable((), excess, about),
    }


def _curves(motion: str) -> dict:
    """Return the static limit and the formulas on a fine axis, and their largest differences."""
    amplitude = np.linspace(0.0, STATIC_AMPLITUDES[motion], CURVE_POINTS)
    dim = f"{motion}_curve_amplitude"
    exact = FORMS[motion][STATIC].function(amplitude)
    entries = {
        dim: variable(dim, amplitude, f"amplitude of the curves, motion {motion}"),
        f"{motion}_curve_limit": variable(dim, exact, "static friction, exact limit"),
    }
    for name, (formula, long_name) in FORMULAS[motion].items():
        values = FORMS[motion][formula].function(amplitude)
        gap = values - exact
        most = int(np.argmax(gap))
        where = f"amplitude of the largest excess of {long_name}"
        entries |= {
            f"{motion}_curve_{name}": variable(dim, values, long_name),
            f"{motion}_gap_{name}": variable((), gap[most], f"largest excess of {long_name}"),
            f"{motion}_gap_{name}_at": variable((), amplitude[most], where),
        }
    return entries


def _shares(motion: str) -> dict:
    """Return the used and remaining fractions of the friction bound at each radius and
    amplitude."""
    radius, amplitudes = np.linspace(0.0, 1.0, RADII), np.array(SHARE_AMPLITUDES[motion])
    dims = (f"{motion}_share_amplitude", "share_radius")
    at = (motion, radius, amplitudes[:, None])
    used = "fraction of the friction bound that the oscillation uses at its turning points"
    left = "fraction of the friction bound that remains for the forward direction, mean over angle"
    return {
        "share_radius": variable("share_radius", radius, "radius divided by a"),
        dims[0]: variable(dims[0], amplitudes, f"amplitude, motion {motion}"),
        f"{motion}_used_share": variable(dims, used_share(*at), used),
        f"{motion}_left_share": variable(dims, left_share(*at), left),
    }


def _split(study: Claims, runs: Runs, motion: str) -> dict:
    """Return the difference between the paper's run and the static limit.

    The difference is split into a part due to the velocity and a part due to the resolution.
    """
    amplitudes, slowest = claims.limited(study, motion), claims.velocities(study)[0]
    rows = [
        (
            *limit(study, runs, motion, amplitude)[:2],
            *friction(runs(claims.point(study, motion, slowest, amplitude))),
            *friction(runs(claims.point(study, motion, claims.PAPER_VELOCITY, amplitude))),
            value_of(runs(claims.paper_run(motion, amplitude)).result, "mu_macro"),
            value_of(runs(claims.limit_on_squares(study, motion, amplitude)).result, "mu_macro"),
        )
        for amplitude in amplitudes
    ]
    exact, exact_error, march, march_error, slow, slow_error, paper, squares = np.array(rows).T
    columns: dict[str, tuple[np.ndarray, str]] = {
        "limit": (exact, "static friction, exact limit"),
        "limit_error": (exact_error, "error of the limit, from the limit on rings"),
        "limit_squares": (squares, "static limit on the paper's squares"),
        "march": (march, "mu_macro at the smallest velocity of this study"),
        "march_error": (march_error, "error of mu_macro at the smallest velocity"),
        "slow": (slow, "mu_macro at the paper's smallest velocity"),
        "slow_error": (slow_error, "error of mu_macro at the paper's smallest velocity"),
        "paper": (paper, "mu_macro of the paper's own run at its smallest velocity"),
        "paper_shift": (paper - exact, "difference of the paper's run from the limit"),
        "from_velocity": (slow - exact, "part of this difference that is due to the velocity"),
        "from_velocity_error": (slow_error + exact_error, "error of this part"),
        "from_resolution": (
            paper - slow,
            "part of the difference that is due to squares, steps and tolerance",
        ),
        "from_resolution_error": (slow_error, "error of this part"),
        "squares_shift": (squares - exact, "difference of the limit on squares from the limit"),
    }
    for name, (formula, long_name) in FORMULAS[motion].items():
        columns[name] = FORMS[motion][formula].function(np.array(amplitudes)), long_name
    zone = columns["zone"][0]
    with np.errstate(invalid="ignore", divide="ignore"):
        lost = np.where(zone > 0.0, 1.0 - exact / zone, np.nan)
    columns["lost"] = lost, "fraction of the bound inside the stick zone that the oscillation uses"
    dim = f"{motion}_amplitude"
    entries = {dim: variable(dim, amplitudes, f"amplitude, motion {motion}")}
    return entries | {
        f"{motion}_{name}": variable(dim, values, text) for name, (values, text) in columns.items()
    }
