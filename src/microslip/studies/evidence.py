"""Evidence for the statements of the paper: requests of runs, and tables of values from the runs.

Most runs are points at the tolerance of the study.  The other runs are single runs: the paper's own
runs, transients, fields of tractions, and periods.

Each row of a table of requests contains requests that belong together, such as a fine and a coarse
run.  The table of evidence has a line for each of these rows, with the columns

- amplitude, velocity: amplitude and velocity of the first run; for a steady motion, the amplitude
  is NaN;
- value, error: value read from the runs, and its error estimate, which is infinite if a run did not
  converge;
- other: second value, for comparison;
- run, other_run: names of the first two results.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from microslip.config.settings import STATIC_AMPLITUDES
from microslip.studies import requests as forms
from microslip.studies.answers import MOTIONS, Answers, Row, number
from microslip.studies.requests import Point, exact_model
from microslip.sweeps.request import STARTS, request_of
from microslip.theory import paper

if TYPE_CHECKING:
    import pandas as pd

    from microslip.config.settings import Claims

PAPER_VELOCITY = 0.005
"""Smallest velocity in the paper's maps for the two oscillating motions."""
PAPER_SQUARES, PAPER_STEPS = 32, 100
"""Number of squares along a side (the same as in the paper), and number of steps per period in our
run."""
PAPER_TOLERANCE = 1e-3
"""Tolerance of the tractions in the paper."""
STEADY_VELOCITIES = (0.1, 0.3, 0.5, 0.8, 1.2, 3.0)
TRANSIENT = {"motion": "continuous-bore", "velocity": 0.8, "travel": 10.0}
"""Transient of the continuous bore.  The forward travel, in units of u_lim, is twice that of Figure
5 in the paper."""
CELLS = (32, 16)
"""Number of rings for transients and steady tractions.  The error is estimated as the difference
between the fine and the coarse run."""
FIELD_VELOCITIES = (0.2, 0.5, 0.8, 1.2)
"""Velocities of the runs for steady tractions.  The centre of rotation is inside the contact at
velocities up to 0.8."""
PERIOD_STEPS = 64
NEAR_STATIC = PAPER_VELOCITY
"""Largest velocity at which an oscillating bore counts as close to the static limit."""
STIFF_EXPONENTS = (100, 50, 25)
"""Exponents of the indenters for extrapolation to a flat end, which has a constant stiffness."""
STIFF_AMPLITUDES, STIFF_RATIOS = (0.4, 0.8), (0.02, 0.1, 0.2, 0.35, 0.5, 0.7, 0.9)
"""Amplitudes of the indentation depth, and ratios of the velocity to the amplitude."""
COLUMNS = ("amplitude", "velocity", "run", "other_run", "other", "value", "error")
"""Columns of an empty table of evidence."""


# Requests


def velocities(study: Claims) -> list[float]:
    """Return the velocities of the study and the paper's smallest velocity, in ascending order."""
    return sorted({*study.velocity, PAPER_VELOCITY})


def static_amplitudes(study: Claims, motion: str) -> list[float]:
    """Return the amplitudes of a motion at which static friction is visible in the paper's maps."""
    return [a for a in study.amplitude[motion] if a <= STATIC_AMPLITUDES[motion]]


def paper_run(motion: str, amplitude: float) -> dict:
    """Return the request that repeats the paper's own run at the paper's smallest velocity.

    The run has 32 x 32 squares and 8,000 steps.
    """
    sizes = {"cells": PAPER_SQUARES, "angles": 1, "steps": PAPER_STEPS}
    how = {"model": "cartesian", "method": "paper", "tolerance": PAPER_TOLERANCE}
    return forms.of("run", Point(motion, PAPER_VELOCITY, amplitude), **how, **sizes)


def periods(study: Claims) -> list[list[dict]]:
    """Return the requests for periods of the oscillating bore at velocities close to the static
    limit."""
    near_static = [v for v in velocities(study) if v <= NEAR_STATIC][-2:]
    sizes = study.cells, 2 * (study.cells // 4)
    return [
        [
            forms.of("patches", Point("bore", v, a), cells=n, angles=n, steps=PERIOD_STEPS)
            for n in sizes
        ]
        for v, a in product(near_static, static_amplitudes(study, "bore"))
    ]


def sources(study: Claims) -> Iterator[tuple[str, Callable[..., dict], list[list[dict]]]]:
    """Yield the name, the function and the requests of each table that is read from runs.

    The requests are a list of rows.  From the results of a row, the function computes one line of
    the table of evidence.
    """

    def point(*place: Any, model: str = "auto", cells: int | None = None) -> dict:
        return forms.solve(Point(*place), study.tolerance, model, cells)

    steady = [[point("continuous-bore", v, model="polar")] for v in STEADY_VELOCITIES]
    yield "steady", point_of, steady
    stiff = [
        point("normal:indentation=1", a * r, a) for a, r in product(STIFF_AMPLITUDES, STIFF_RATIOS)
    ]
    flat = [[one | {"pressure": f"power:exponent={n}"} for n in STIFF_EXPONENTS] for one in stiff]
    yield "flat end", flat_end_of, flat
    for motion in MOTIONS:
        amplitudes = study.amplitude[motion]
        moving = [[point(motion, v, a)] for a, v in product(amplitudes, velocities(study))]
        yield motion, point_of, moving
        yield f"{motion} closed", point_of, [[point(motion, 0.0, a)] for a in amplitudes]
        limits = [
            [
                point(motion, 0.0, a),
                point(motion, 0.0, a, model=exact_model(motion, 0.0)),
                point(motion, 0.0, a, model="cartesian", cells=PAPER_SQUARES),
                paper_run(motion, a),
            ]
            for a in static_amplitudes(study, motion)
        ]
        yield f"{motion} limit", limit_of, limits
    largest = study.amplitude["transverse"][-1]
    run = [paper_run("transverse", largest), point("transverse", PAPER_VELOCITY, largest)]
    slides = largest > STATIC_AMPLITUDES["transverse"]  # the whole contact
    yield "sliding", paper_run_of, [run] if slides else []
    transients = [
        [request_of("history", start=start, cells=n, **TRANSIENT) for n in CELLS]
        for start in STARTS
    ]
    for name in ("force_forward", "torque"):
        yield name, partial(end_of, name), transients
    fields = [
        [request_of("field", motion="continuous-bore", velocity=v, cells=n) for n in CELLS]
        for v in FIELD_VELOCITIES
    ]
    yield "ratio", partial(both_of, traction_ratio), fields
    yield "angle", partial(both_of, traction_angle), fields
    yield "least stick", partial(both_of, least_stick), periods(study)
    yield "lead", partial(both_of, lead), periods(study)


# Tables of evidence


def tables_of(study: Claims, answers: Answers) -> dict[str, pd.DataFrame]:
    """Return all tables of evidence, keyed by name."""
    import pandas as pd

    tables = {}
    for name, read, requests in sources(study):
        lines = []
        for some in requests:
            rows = [answers(request) for request in some]
            keys = {"run": rows[0]["key"], "other_run": "".join(row["key"] for row in rows[1:2])}
            place = {axis: number(some[0], axis) for axis in ("amplitude", "velocity")}
            lines.append(place | keys | {"other": np.nan} | read(*rows))
        tables[name] = pd.DataFrame(lines) if lines else pd.DataFrame(columns=COLUMNS, dtype=float)
    tables["steady faster"] = beside_previous(tables["steady"])
    for motion in MOTIONS:
        points, closed, limit = (tables[f"{motion}{part}"] for part in ("", " closed", " limit"))
        static = points[points["amplitude"] <= STATIC_AMPLITUDES[motion]]
        rings = {"value": limit["rings"], "error": limit["rings_error"], "run": limit["other_run"]}
        every = pd.concat([closed, points]).sort_values(["amplitude", "velocity"])
        tables |= {
            f"{motion} rings": limit.assign(**rings, other_run=""),
            f"{motion} slow": static[static["velocity"] == velocities(study)[0]],
            f"{motion} paper": static[static["velocity"] == PAPER_VELOCITY],
            f"{motion} faster": beside_previous(every, "amplitude"),
            f"{motion} larger": beside_previous(points, "velocity"),
        }
    return tables


def beside_previous(points: pd.DataFrame, *by: str) -> pd.DataFrame:
    """Return all points except the first of each group.  The value of the previous point is added
    to each row as the column `other`.

    by: names of the columns whose values identify a group.
    """
    groups = points.groupby(list(by)) if by else points
    before = groups[["value", "error", "run"]].shift()
    both = {"other": before["value"], "other_run": before["run"]}
    points = points.assign(**both, error=points["error"] + before["error"])
    return points[before["run"].notna()]


# Values read from rows


def friction(row: Row) -> tuple[float, float]:
    """Return (mu_macro, error estimate) of a point.  The error estimate is infinite if the point
    did not converge."""
    error = number(row, "mu_macro_error")
    is_good = bool(row.get("converged")) and np.isfinite(error)
    return number(row, "mu_macro"), error if is_good else np.inf


def point_of(row: Row) -> dict:
    """Return the friction at a point, as one line of the table of evidence."""
    value, error = friction(row)
    return {"value": value, "error": error}


def limit_of(closed: Row, rings: Row, squares: Row, own: Row) -> dict:
    """Return four values for the static limit: from the closed form, from rings, from squares, and
    from the paper's own run.

    The error of the closed form is estimated with the help of rings.  The estimate is the sum of
    three terms: the difference from the limit on rings, the error estimate of this limit, and the
    rounding error of the closed form.
    """
    (value, rounding), (resolved, error) = friction(closed), friction(rings)
    return {
        "value": value,
        "error": rounding + error + abs(resolved - value),
        "rings": resolved,
        "rings_error": error,
        "squares": number(squares, "mu_macro"),
        "paper": number(own, "mu_macro"),
    }


def paper_run_of(own: Row, accurate: Row) -> dict:
    """Return the friction of the paper's own run.  The error is estimated as the difference from a
    run at the study's tolerance, plus the error of that run."""
    mu, (value, error) = number(own, "mu_macro"), friction(accurate)
    return {"value": mu, "error": error + abs(mu - value)}


def end_of(name: str, *rows: Row) -> dict:
    """Return the value of a quantity at the end of a transient.

    The error estimate is the sum of two terms: the difference from a run with half as many rings,
    and the change over the last tenth of the forward travel.
    """
    fine, coarse = (np.asarray(row[name], float) for row in rows)
    tail = fine[-max(fine.size // 10, 2) :]
    error = abs(fine[-1] - coarse[-1]) + np.abs(tail - fine[-1]).max()
    return {"value": fine[-1], "error": error}


def flat_end_of(*rows: Row) -> dict:
    """Return friction for a flat end, extrapolated from three indenters.

    The difference in friction between an indenter with exponent n and a flat end is a power series
    in 1/n.  The extrapolated value has a third-order error.  The error estimate is the difference
    from the first-order extrapolation.
    """
    (fine, error), (middle, second), (coarse, third) = map(friction, rows)
    value = (8.0 * fine - 6.0 * middle + coarse) / 3.0
    error = abs(value - (2.0 * fine - middle)) + (8.0 * error + 6.0 * second + third) / 3.0
    return {"value": value, "error": error}


def both_of(read: Callable[[Row], tuple[float, float]], fine: Row, coarse: Row) -> dict:
    """Return a value of the fine run, the reference for this value, and an error estimate.

    The error estimate is the change in the difference between value and reference when the number
    of rings is halved.

    read: function that reads the value and the reference from a run.
    """
    if not (fine.get("converged", True) and coarse.get("converged", True)):
        return {"value": np.nan, "error": np.inf}
    (value, other), (coarse_value, coarse_other) = read(fine), read(coarse)
    return {
        "value": value,
        "error": abs((value - other) - (coarse_value - coarse_other)),
        "other": other,
    }


def traction_ratio(row: Row) -> tuple[float, float]:
    """Return two values: the smallest ratio of traction to friction bound, and its reference value,
    0."""
    size = np.hypot(row["traction_lateral"], row["traction_forward"])
    return float((size / np.asarray(row["bound"], float)).min()), 0.0


def traction_angle(row: Row) -> tuple[float, float]:
    """Return two values: the largest angle in degrees between a traction and the traction of Eq 15,
    and its reference value, 0."""
    across, along, lateral, forward = (
        np.asarray(row[name], float)
        for name in ("lateral_position", "forward_position", "traction_lateral", "traction_forward")
    )
    x, y = paper.steady_bore_traction(across, along, float(row["velocity"]))
    angle = np.arctan2(x * forward - y * lateral, x * lateral + y * forward)
    return float(np.degrees(np.abs(angle).max())), 0.0


def least_stick(row: Row) -> tuple[float, float]:
    """Return the smallest stick area in a period, and the area of the smallest cell.  Both areas
    are divided by the contact area."""
    both = np.add(row["stick_right"], row["stick_left"])
    return float(both[1:].min()), min(row["area"]) / np.pi


def lead(row: Row) -> tuple[float, float]:
    """Return two values: the difference between the stick areas of the two sides, and its reference
    value, 0.

    The difference, divided by the total stick area, is computed twice: when the total in the first
    half of the period is smallest, and half a period later.  The smaller absolute value is
    returned.  The result is positive if one side is larger at the first moment, and the other side
    is larger at the second moment.  Otherwise, the result is negative or 0.
    """
    right, left = (np.asarray(row[f"stick_{side}"][1:], float) for side in ("right", "left"))
    half = right.size // 2
    least = int(np.argmin((right + left)[:half]))
    first, second = (
        (left[k] - right[k]) / total if (total := right[k] + left[k]) > 0 else 0.0
        for k in (least, least + half)
    )
    return float(max(min(first, -second), min(-first, second))), 0.0
