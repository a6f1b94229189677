"""Claims: what is run to judge the statements of the paper.

Every function returns one request, and the module that judges calls the same functions, so that
what is asked and what is judged cannot drift apart. Certified points come first; where the paper's
own numbers or a look inside are wanted there are single runs.
"""

from microslip.config.records import STATIC_AMPLITUDES
from microslip.config.settings import Claims
from microslip.foundation.canonical import number
from microslip.studies import requests
from microslip.studies.ladders import exact_model

PAPER_VELOCITY = 0.005
"""The smallest velocity in the paper's maps, of both motions."""
PAPER_SQUARES, PAPER_STEPS = 32, 100
"""The paper's squares along a side, and steps in a period that its run here has."""
PAPER_TOLERANCE = 1e-3
"""The paper's error of stresses."""

STEADY_VELOCITIES = (0.1, 0.3, 0.5, 0.8, 1.2, 3.0)
TRANSIENT_VELOCITY = 0.8
STARTS = ("stress-free", "full-rotation", "full-slip")
TRAVEL = 10.0
"""Forward way of a transient in u_lim, twice that of the paper's Figure 5."""
CELLS = {"fine": 32, "coarse": 16}
"""Rings of transients and of steady tractions; the difference of the two is their error."""
FIELD_VELOCITIES = (0.2, 0.5, 0.8, 1.2)
"""Velocities of steady tractions: all but the last have the centre of rotation in the contact."""

PERIOD_STEPS = 64
NEAR_STATIC = PAPER_VELOCITY
"""Largest velocity at which an oscillating bore counts as near static friction."""
FEW = 2
"""Runs of the paper in one job."""


def velocities(study: Claims) -> list[float]:
    """Velocities of the study and the paper's smallest one, ascending."""
    return sorted({*study.velocity, PAPER_VELOCITY})


def point(
    study: Claims,
    motion: str,
    velocity: float,
    amplitude: float | None = None,
    model: str = "auto",
    cells: int | None = None,
) -> dict:
    """A certified point; velocity 0: the static limit; cells: an imposed number of squares."""
    place = requests.Point(motion, velocity, amplitude)
    kind = {"kind": "point", "model": model, "tolerance": number(study.tolerance)}
    return requests.of_point(place) | kind | {"cells": cells, "steps": None}


def resolved_limit(study: Claims, motion: str, amplitude: float) -> dict:
    """The static limit on rings: the oscillation's tractions computed, no closed form in it."""
    return point(study, motion, 0.0, amplitude, exact_model(motion, 0.0))


def limit_on_squares(study: Claims, motion: str, amplitude: float) -> dict:
    """The static limit on the paper's squares."""
    return point(study, motion, 0.0, amplitude, "cartesian", PAPER_SQUARES)


def paper_run(motion: str, amplitude: float) -> dict:
    """The paper's own run at its smallest velocity: 32 x 32 squares, 8,000 plain steps."""
    place = requests.Point(motion, PAPER_VELOCITY, amplitude)
    sizes = {"cells": PAPER_SQUARES, "angles": 1, "steps": PAPER_STEPS}
    how = {"kind": "run", "model": "cartesian", "method": "paper"}
    return requests.of_point(place) | how | sizes | {"tolerance": number(PAPER_TOLERANCE)}


def transient(start: str, cells: str) -> dict:
    """Forces of the continuous bore from one of the three initial states on; cells: of CELLS."""
    numbers = {"velocity": number(TRANSIENT_VELOCITY), "travel": number(TRAVEL)}
    return (
        {"kind": "history", "motion": "continuous-bore", "start": start}
        | numbers
        | {"cells": CELLS[cells]}
    )


def field(velocity: float, cells: str) -> dict:
    """Steady tractions of the continuous bore; cells: of CELLS."""
    place = {"motion": "continuous-bore", "velocity": number(velocity)}
    return {"kind": "field", "cells": CELLS[cells]} | place


def period(study: Claims, velocity: float, amplitude: float, coarse: bool = False) -> dict:
    """A period of the oscillating bore from inside, or the same with half as many rings."""
    cells = 2 * (study.cells // 4) if coarse else study.cells
    place = requests.Point("bore", velocity, amplitude)
    sizes = {"cells": cells, "angles": cells, "steps": PERIOD_STEPS}
    return requests.of_point(place) | {"kind": "patches"} | sizes


def limited(study: Claims, motion: str) -> list[float]:
    """Amplitudes at which there is static friction that the paper's maps show."""
    return [a for a in study.amplitude[motion] if a <= STATIC_AMPLITUDES[motion]]


def sliding(study: Claims) -> list[float]:
    """The largest transverse amplitude, in a list, if the contact slides in every stroke there."""
    largest = study.amplitude["transverse"][-1]
    return [largest] if largest > STATIC_AMPLITUDES["transverse"] else []


def periods(study: Claims) -> list[tuple[float, float]]:
    """(velocity, amplitude) of the periods that are looked into, those near static friction."""
    slow = [v for v in velocities(study) if v <= NEAR_STATIC]
    return [(v, a) for v in slow[-2:] for a in limited(study, "bore")]


def rows(study: Claims) -> list[list[dict]]:
    """Certified points, a list for each motion and amplitude, from the static limit upwards."""
    return [
        [point(study, motion, v, amplitude) for v in (0.0, *velocities(study))]
        for motion, amplitudes in study.amplitude.items()
        for amplitude in amplitudes
    ]


def steady(study: Claims) -> list[dict]:
    """Certified points of the continuous bore, resolved though Eq 21 is exact."""
    return [point(study, "continuous-bore", v, model="polar") for v in STEADY_VELOCITIES]


def pieces(study: Claims) -> tuple[list, list]:
    """Requests grouped by job: two lists of lists of requests, the slow jobs and the fast ones."""
    of_paper = [paper_run("transverse", amplitude) for amplitude in sliding(study)]
    of_paper += [paper_run(motion, a) for motion in study.amplitude for a in limited(study, motion)]
    long = [of_paper[i : i + FEW] for i in range(0, len(of_paper), FEW)]
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
    two = [transient(start, cells) for start in STARTS for cells in CELLS]
    two += [field(velocity, cells) for velocity in FIELD_VELOCITIES for cells in CELLS]
    short = [request for row in fast for request in row] + statics + steady(study) + two
    return long + slow, [inside, short]
