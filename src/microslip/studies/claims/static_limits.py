"""The static limit beside the paper's formulas for it, and what hid the difference from the paper.

Everything for the two oscillating motions; a formula of the paper counts the whole bound inside the
stick zone, while the oscillation has used up a part of it (see microslip.solver.static_limit).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import j0

from microslip.config.records import STATIC_AMPLITUDES
from microslip.config.settings import Claims
from microslip.datasets.variables import variable
from microslip.studies.claims import claims as asked
from microslip.studies.claims.runs import Run, Runs, friction
from microslip.studies.tables import value_of
from microslip.theory import hertz
from microslip.theory import paper as theory
from microslip.theory.catalogue import FORMS, STATIC

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
"""The paper's formulas by motion: name -> (name in theory.catalogue, long_name)."""
CURVE_POINTS = 501
SHARE_AMPLITUDES = {"transverse": (0.1, 0.25, 0.5, 0.75), "bore": (0.25, 0.5, 1.0, 2.0)}
RADII = 201


@dataclass(frozen=True)
class Limit:
    """A static limit with an error that trusts no closed form, and the runs behind it."""

    value: float
    error: float
    runs: tuple[Run, ...]


def limit(study: Claims, runs: Runs, motion: str, amplitude: float) -> Limit:
    """The Limit at an amplitude: the closed form, its error its distance from the limit on rings
    and what that claims as its own error."""
    closed = runs(asked.point(study, motion, 0.0, amplitude))
    rings = runs(asked.resolved_limit(study, motion, amplitude))
    value, rounding = friction(closed)
    resolved, error = friction(rings)
    return Limit(value, rounding + error + abs(resolved - value), (closed, rings))


def asymptote(amplitude: ArrayLike) -> np.ndarray:
    """Static limit of the oscillating bore at large amplitudes, where the stick zone is small.

    There its radius is c = (4/e) exp(-D(1/2) amplitude), the share of the bound that the rotation
    uses is (2/pi) arcsin(r/c), and the integral of what is left closes with a Bessel function:
    3/4 (1 - J0(pi)) c^2. Eq 33 tends to 3/2 c^2. amplitude: any shape; dimensionless, never 0.
    """
    radius = 4.0 / np.e * np.exp(-hertz.D_half() * np.asarray(amplitude, float))
    return 0.75 * (1.0 - j0(np.pi)) * radius**2


def used_share(motion: str, radius: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
    """Share of the friction bound that the oscillation alone uses at its turning points; 1 from the
    stick radius on. radius, amplitude: broadcast."""
    if motion == "bore":
        return np.asarray(hertz.lubkin_share(radius, theory.bore_stick_radius(amplitude)))
    bound = hertz.friction_bound(radius)
    traction = hertz.mindlin_traction(radius, amplitude)
    return np.where(bound > 0, traction / np.where(bound > 0, bound, 1.0), 1.0)


def left_share(motion: str, radius: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
    """Share of the bound that is left for the forward direction, averaged over the angle."""
    used = used_share(motion, radius, amplitude)
    if motion == "bore":
        return 2.0 / np.pi * np.arccos(used)
    return np.sqrt((1.0 - used) * (1.0 + used))


def variables(study: Claims, runs: Runs) -> dict:
    """Variables of the dataset about the static limit of both motions, as a dict."""
    found: dict[str, tuple] = {}
    for motion in study.amplitude:
        found |= _curves(motion) | _shares(motion) | _split(study, runs, motion)
    slowest = asked.velocities(study)[0]
    found["claims_slowest"] = variable((), slowest, "smallest velocity of this study")
    paper = "smallest velocity of the paper"
    found["claims_paper_velocity"] = variable((), asked.PAPER_VELOCITY, paper)
    found["static_asymptote_excess"] = variable(
        (),
        1.5 / (0.75 * (1.0 - j0(np.pi))) - 1.0,
        "what Eq 33 adds to the static limit at large amplitudes, over the limit",
    )
    return found


def _curves(motion: str) -> dict:
    amplitude = np.linspace(0.0, STATIC_AMPLITUDES[motion], CURVE_POINTS)
    dim = f"{motion}_curve_amplitude"
    exact = FORMS[motion][STATIC].function(amplitude)
    found = {
        dim: variable(dim, amplitude, f"amplitude of the curves, motion {motion}"),
        f"{motion}_curve_limit": variable(dim, exact, "static friction, exact limit"),
    }
    for name, (formula, long_name) in FORMULAS[motion].items():
        values = FORMS[motion][formula].function(amplitude)
        gap = values - exact
        most = int(np.argmax(gap))
        found |= {
            f"{motion}_curve_{name}": variable(dim, values, long_name),
            f"{motion}_gap_{name}": variable((), gap[most], f"largest excess of {long_name}"),
            f"{motion}_gap_{name}_at": variable((), amplitude[most], f"where that is, {long_name}"),
        }
    return found


def _shares(motion: str) -> dict:
    radius, amplitudes = np.linspace(0.0, 1.0, RADII), np.array(SHARE_AMPLITUDES[motion])
    dims = (f"{motion}_share_amplitude", "share_radius")
    at = (motion, radius, amplitudes[:, None])
    used = "share of the friction bound that the oscillation uses at its turning points"
    left = "share of the friction bound left for the forward direction, mean over the angle"
    return {
        "share_radius": variable("share_radius", radius, "radius over a"),
        dims[0]: variable(dims[0], amplitudes, f"amplitude, motion {motion}"),
        f"{motion}_used_share": variable(dims, used_share(*at), used),
        f"{motion}_left_share": variable(dims, left_share(*at), left),
    }


def _split(study: Claims, runs: Runs, motion: str) -> dict:
    """How the paper's run differs from the limit: by its resolution, and by its velocity."""
    amplitudes = asked.limited(study, motion)
    rows = [_row(study, runs, motion, amplitude) for amplitude in amplitudes]
    dim = f"{motion}_amplitude"
    found = {dim: variable(dim, amplitudes, f"amplitude, motion {motion}")}
    for name, long_name in SPLIT.items():
        values = [row[name] for row in rows]
        found[f"{motion}_{name}"] = variable(dim, values, long_name)
    for name, (formula, long_name) in FORMULAS[motion].items():
        values = [float(FORMS[motion][formula].function(amplitude)) for amplitude in amplitudes]
        found[f"{motion}_{name}"] = variable(dim, values, long_name)
    zone = np.array(found[f"{motion}_zone"][1], float)
    with np.errstate(invalid="ignore", divide="ignore"):
        lost = 1.0 - np.array([row["limit"] for row in rows]) / zone
    found[f"{motion}_lost"] = variable(dim, np.where(zone > 0.0, lost, np.nan), LOST)
    return found


LOST = "part of the bound inside the stick zone that is not left for the forward direction"
SPLIT = {
    "limit": "static friction, exact limit",
    "limit_error": "error of the limit, from that on rings",
    "limit_squares": "static limit on the paper's squares",
    "march": "mu_macro at the smallest velocity of this study",
    "march_error": "error of mu_macro at the smallest velocity",
    "slow": "mu_macro at the paper's smallest velocity",
    "slow_error": "error of mu_macro at the paper's smallest velocity",
    "paper": "mu_macro of the paper's own run at its smallest velocity",
    "paper_shift": "what the paper's run differs from the limit by",
    "from_velocity": "part of that from the velocity",
    "from_velocity_error": "error of that part",
    "from_resolution": "part of that from squares, steps and tolerance",
    "from_resolution_error": "error of that part",
    "squares_shift": "what the squares alone differ from the limit by, at vanishing velocity",
}
"""Variables over the amplitudes of each motion: name -> long_name."""


def _row(study: Claims, runs: Runs, motion: str, amplitude: float) -> dict[str, float]:
    exact = limit(study, runs, motion, amplitude)
    slowest = asked.point(study, motion, asked.velocities(study)[0], amplitude)
    march, march_error = friction(runs(slowest))
    slow, slow_error = friction(runs(asked.point(study, motion, asked.PAPER_VELOCITY, amplitude)))
    paper = value_of(runs(asked.paper_run(motion, amplitude)).result, "mu_macro")
    squares = value_of(runs(asked.limit_on_squares(study, motion, amplitude)).result, "mu_macro")
    return {
        "limit": exact.value,
        "limit_error": exact.error,
        "limit_squares": squares,
        "march": march,
        "march_error": march_error,
        "slow": slow,
        "slow_error": slow_error,
        "paper": paper,
        "paper_shift": paper - exact.value,
        "from_velocity": slow - exact.value,
        "from_velocity_error": slow_error + exact.error,
        "from_resolution": paper - slow,
        "from_resolution_error": slow_error,
        "squares_shift": squares - exact.value,
    }
