"""Requests for the runs that decide the verdicts on the statements.

The functions of this module build the requests, and the module `parts` judges the results. Most
requests are points at the tolerance of the study. The others are single runs: the paper's own runs,
transients, fields of tractions, and periods.
"""

from microslip.config.settings import STATIC_AMPLITUDES, Claims
from microslip.foundation.canonical import number
from microslip.studies import requests
from microslip.studies.ladders import exact_model

PAPER_VELOCITY = 0.005
"""Smallest velocity in the paper's maps of the two motions."""
PAPER_SQUARES, PAPER_STEPS = 32, 100
"""Number of squares along a side (as in the paper), and number of steps per period in our run."""
PAPER_TOLERANCE = 1e-3
"""Tolerance of the stresses in the paper."""

STEADY_VELOCITIES = (0.1, 0.3, 0.5, 0.8, 1.2, 3.0)
TRANSIENT_VELOCITY = 0.8
STARTS = ("stress-free", "full-rotation", "full-slip")
TRAVEL = 10.0
"""Forward travel of a transient in units of u_lim, twice as far as in the paper's Figure 5."""
CELLS = {"fine": 32, "coarse": 16}
"""Number of rings for transients and steady tractions. The error is the difference between the fine
and the coarse run."""
FIELD_VELOCITIES = (0.2, 0.5, 0.8, 1.2)
"""Velocities of the runs for steady tractions. At velocities up to 0.8, the centre of rotation is
inside the contact."""

PERIOD_STEPS = 64
NEAR_STATIC = PAPER_VELOCITY
"""Largest velocity at which an oscillating bore counts as near static friction."""
STIFF_EXPONENTS = (25, 50, 100)
"""Indenter exponents for extrapolation to a flat end. A flat end has a constant stiffness."""
STIFF_AMPLITUDES, STIFF_RATIOS = (0.4, 0.8), (0.02, 0.1, 0.2, 0.35, 0.5, 0.7, 0.9)
"""Amplitudes of the indentation, and ratios of the velocity to the amplitude."""
RUNS_PER_JOB = 2
"""Number of the paper's own runs in one job."""


def velocities(study: Claims) -> list[float]:
    """Return the study's velocities and the paper's smallest velocity, in ascending order."""
    return sorted({*study.velocity, PAPER_VELOCITY})


def point(
    study: Claims,
    motion: str,
    velocity: float,
    amplitude: float | None = None,
    model: str = "auto",
    cells: int | None = None,
) -> dict:
    """Return the request for a point. The velocity 0 requests the static limit.

    cells: imposed number of squares along a side. By default, it follows from the tolerance.
    """
    place = requests.Point(motion, velocity, amplitude)
    kind = {"kind": "point", "model": model, "tolerance": number(study.tolerance)}
    return requests.of_point(place) | kind | {"cells": cells, "steps": None}


def resolved_limit(study: Claims, motion: str, amplitude: float) -> dict:
    """Return the request for the static limit on rings, computed without a closed form."""
    return point(study, motion, 0.0, amplitude, exact_model(motion, 0.0))


def limit_on_squares(study: Claims, motion: str, amplitude: float) -> dict:
    """Return the request for the static limit on the paper's squares."""
    return point(study, motion, 0.0, amplitude, "cartesian", PAPER_SQUARES)


def paper_run(motion: str, amplitude: float) -> dict:
    """Return the request for the paper's own run at its smallest velocity.

    The run has 32 x 32 squares and 8,000 steps.
    """
    place = requests.Point(motion, PAPER_VELOCITY, amplitude)
    sizes = {"cells": PAPER_SQUARES, "angles": 1, "steps": PAPER_STEPS}
    how = {"kind": "run", "model": "cartesian", "method": "paper"}
    return requests.of_point(place) | how | sizes | {"tolerance": number(PAPER_TOLERANCE)}


def transient(start: str, cells: str) -> dict:
    """Return the request for a transient of the continuous bore.

    start: initial state, one of STARTS; cells: number of rings, as a key of CELLS.
    """
    return {
        "kind": "history",
        "motion": "continuous-bore",
        "start": start,
        "velocity": number(TRANSIENT_VELOCITY),
        "travel": number(TRAVEL),
        "cells": CELLS[cells],
    }


def stiff(study: Claims, amplitude: float, velocity: float, exponent: int) -> dict:
    """Return the request for a point of a power-law indenter with an oscillating indentation."""
    place = point(study, "normal:indentation=1", velocity, amplitude)
    return place | {"pressure": f"power:exponent={exponent}"}


def stiff_points() -> list[tuple[float, float]]:
    """Return the (amplitude, velocity) pairs of the points with an oscillating indentation."""
    return [(a, a * ratio) for a in STIFF_AMPLITUDES for ratio in STIFF_RATIOS]


def field(velocity: float, cells: str) -> dict:
    """Return the request for steady tractions of the continuous bore.

    cells: number of rings, as a key of CELLS.
    """
    place = {"motion": "continuous-bore", "velocity": number(velocity)}
    return {"kind": "field", "cells": CELLS[cells]} | place


def period(study: Claims, velocity: float, amplitude: float, coarse: bool = False) -> dict:
    """Return the request for a period of the oscillating bore.

    coarse: if True, the run has half as many rings.
    """
    cells = 2 * (study.cells // 4) if coarse else study.cells
    place = requests.Point("bore", velocity, amplitude)
    sizes = {"cells": cells, "angles": cells, "steps": PERIOD_STEPS}
    return requests.of_point(place) | {"kind": "patches"} | sizes


def limited(study: Claims, motion: str) -> list[float]:
    """Return the amplitudes of a motion at which static friction is visible in the paper's maps."""
    return [a for a in study.amplitude[motion] if a <= STATIC_AMPLITUDES[motion]]


def sliding(study: Claims) -> list[float]:
    """Return a list with the largest transverse amplitude if the whole contact slides there.

    Otherwise the list is empty.
    """
    largest = study.amplitude["transverse"][-1]
    return [largest] if largest > STATIC_AMPLITUDES["transverse"] else []


def periods(study: Claims) -> list[tuple[float, float]]:
    """Return the (velocity, amplitude) pairs of the periods near static friction."""
    slow = [v for v in velocities(study) if v <= NEAR_STATIC]
    return [(v, a) for v in slow[-2:] for a in limited(study, "bore")]


def rows(study: Claims) -> list[list[dict]]:
    """Return a row of points for each motion and amplitude.

    The velocities of a row increase from the static limit to the largest velocity.
    """
    return [
        [point(study, motion, v, amplitude) for v in (0.0, *velocities(study))]
        for motion, amplitudes in study.amplitude.items()
        for amplitude in amplitudes
    ]


def steady(study: Claims) -> list[dict]:
    """Return points of the continuous bore, computed on a mesh although Eq 21 is exact."""
    return [point(study, "continuous-bore", v, model="polar") for v in STEADY_VELOCITIES]


def pieces(study: Claims) -> tuple[list, list]:
    """Return the slow jobs and the fast jobs as two lists. A job is a list of requests."""
    of_paper = [paper_run("transverse", amplitude) for amplitude in sliding(study)]
    of_paper += [paper_run(motion, a) for motion in study.amplitude for a in limited(study, motion)]
    long = [of_paper[i : i + RUNS_PER_JOB] for i in range(0, len(of_paper), RUNS_PER_JOB)]
    slow: list[list[dict]] = []
    fast: list[list[dict]] = []
    for row in rows(study):
        (slow if row[0]["motion"] == "bore" else fast).append(row)
    inside = [
        period(study, *place, coarse=coarse) for place in periods(study) for coarse in (False, True)
    ]
    statics = [
        ask(study, motion, a)
        for motion in study.amplitude
        for a in limited(study, motion)
        for ask in (resolved_limit, limit_on_squares)
    ]
    statics += [stiff(study, *p, n) for p in stiff_points() for n in STIFF_EXPONENTS]
    two = [transient(start, cells) for start in STARTS for cells in CELLS]
    two += [field(velocity, cells) for velocity in FIELD_VELOCITIES for cells in CELLS]
    short = [request for row in fast for request in row] + statics + steady(study) + two
    return long + slow, [inside, short]
