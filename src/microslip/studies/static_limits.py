"""Compare the static limit of the two oscillating motions with the paper's formulas for this limit.

In the paper's formulas, the whole friction bound inside the stick zone resists the forward motion.
In fact, the oscillation uses a part of this bound (see microslip.periodic.static_limit).  The
paper's own runs do not show the resulting difference, because their velocity is too large and their
resolution is too coarse.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from microslip.config.settings import STATIC_AMPLITUDES
from microslip.datasets.catalogue import FORMS, STATIC
from microslip.studies import evidence
from microslip.theory import hertz, paper

if TYPE_CHECKING:
    import pandas as pd

    from microslip.config.settings import Claims

FORMULAS = {
    "transverse": {"slider": "mu_static_slider", "zone": "mu_static_stick_zone"},
    "bore": {"zone": "mu_static_stick_zone", "zone_printed": "mu_static_stick_zone_printed"},
}
"""Names of the paper's formulas for each motion, as in datasets.catalogue."""
CURVE_POINTS = 501
SHARE_AMPLITUDES = {"transverse": (0.1, 0.25, 0.5, 0.75), "bore": (0.25, 0.5, 1.0, 2.0)}
"""Amplitudes at which the fractions of the friction bound are drawn."""
RADII = 201


def remainder() -> float:
    """Return the integral of the remaining friction bound divided by c^2, where c is the radius of
    the stick zone.  For large amplitudes, the ratio is 3/4 (1 - J0(pi)), where J0 is the Bessel
    function."""
    return 0.75 * (1.0 - scipy.special.j0(np.pi))


def asymptote(amplitude: ArrayLike) -> np.ndarray:
    """Return the static limit of the oscillating bore for large amplitudes (small stick zones).

    The radius of the stick zone is c = (4/e) exp(-D(1/2) amplitude).  At the radius r, the rotation
    uses the fraction (2/pi) arcsin(r/c) of the friction bound.  For comparison, Eq 33 tends to
    (3/2) c^2.  The result is dimensionless and positive.  The amplitude can be an array of any
    shape.
    """
    radius = 4.0 / np.e * np.exp(-hertz.D_half() * np.asarray(amplitude, float))
    return remainder() * radius**2


def used_share(motion: str, radius: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
    """Return the fraction of the friction bound that the oscillation uses at the turning points.

    The fraction is 1 outside the stick radius.  The arguments are broadcast.
    """
    if motion == "bore":
        return np.asarray(hertz.lubkin_share(radius, paper.bore_stick_radius(amplitude)))
    bound = hertz.friction_bound(radius)
    traction = hertz.mindlin_traction(radius, amplitude)
    return np.where(bound > 0, traction / np.where(bound > 0, bound, 1.0), 1.0)


def left_share(motion: str, radius: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
    """Return the fraction of the friction bound that is left for the forward direction.

    The fraction is averaged over the angle.
    """
    used = used_share(motion, radius, amplitude)
    if motion == "bore":
        return 2.0 / np.pi * np.arccos(used)
    return np.sqrt((1.0 - used) * (1.0 + used))


# The dataset


def values(study: Claims, tables: dict[str, pd.DataFrame]) -> dict[str, Any]:
    """Return the values of all variables of the static limits.  `tables` contains the tables of the
    runs that support the values."""
    radius = np.linspace(0.0, 1.0, RADII)
    entries: dict[str, Any] = {
        "share_radius": radius,
        "claims_slowest": evidence.velocities(study)[0],
        "claims_paper_velocity": evidence.PAPER_VELOCITY,
        "static_asymptote_excess": 1.5 / remainder() - 1.0,
    }
    for motion in FORMULAS:
        shown = np.array(SHARE_AMPLITUDES[motion])
        at = motion, radius, shown[:, None]
        limit, march, slow = (tables[f"{motion} {name}"] for name in ("limit", "slow", "paper"))
        columns = {"used_share": used_share(*at), "left_share": left_share(*at)}
        columns |= {"share_amplitude": shown} | _curves(motion) | _table(motion, limit, march, slow)
        entries |= {f"{motion}_{name}": value for name, value in columns.items()}
    return entries


def _curves(motion: str) -> dict:
    """Return the static limit and the paper's formulas on a fine axis.  The largest excess of each
    formula over the limit is also returned."""
    amplitude = np.linspace(0.0, STATIC_AMPLITUDES[motion], CURVE_POINTS)
    exact = FORMS[motion][STATIC].function(amplitude)
    entries: dict[str, Any] = {"curve_amplitude": amplitude, "curve_limit": exact}
    for name, form in FORMULAS[motion].items():
        curve = FORMS[motion][form].function(amplitude)
        most = int(np.argmax(curve - exact))
        entries |= {f"curve_{name}": curve, f"gap_{name}": (curve - exact)[most]}
        entries[f"gap_{name}_at"] = amplitude[most]
    return entries


def _table(motion: str, limit: pd.DataFrame, march: pd.DataFrame, slow: pd.DataFrame) -> dict:
    """Return the difference between the paper's run and the static limit.

    The difference is split into a part due to the velocity and a part due to the resolution.

    limit: static limit. march: friction at the smallest velocity of the study. slow: friction at
    the smallest velocity of the paper.  Each table has a line for each amplitude.
    """
    limit, march, slow = (table.set_index("amplitude") for table in (limit, march, slow))
    amplitude = limit.index.to_numpy(float)
    entries = {n: FORMS[motion][form].function(amplitude) for n, form in FORMULAS[motion].items()}
    with np.errstate(invalid="ignore", divide="ignore"):
        share = 1.0 - limit["value"] / entries["zone"]
    entries |= {"amplitude": amplitude, "lost": np.where(entries["zone"] > 0.0, share, np.nan)}
    for name, table in {"limit": limit, "march": march, "slow": slow}.items():
        entries |= {name: table["value"], f"{name}_error": table["error"]}
    return entries | {
        "limit_squares": limit["squares"],
        "squares_shift": limit["squares"] - limit["value"],
        "paper": limit["paper"],
        "paper_shift": limit["paper"] - limit["value"],
        "from_velocity": slow["value"] - limit["value"],
        "from_velocity_error": slow["error"] + limit["error"],
        "from_resolution": limit["paper"] - slow["value"],
        "from_resolution_error": slow["error"],
    }
