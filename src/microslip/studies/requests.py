"""Build the requests of the studies.

A request is a dict whose numbers are canonical strings, see sweeps.batches. The kinds of requests
are:

- trial: a timed run at a point, with a model, a method and a resolution;
- choice: a timed solve at a tolerance, with automatic selection of the model and resolution;
- probe: an untimed solve with a given method;
- point: a solve at a tight tolerance, used as the reference for the other requests;

Timed requests (trial, choice) contain the name of the CPU. Therefore, times measured on
different CPUs have different keys and are not drawn in one chart.
"""

from typing import NamedTuple

from microslip.config.settings import StudyPoint
from microslip.foundation.canonical import number
from microslip.foundation.machine import cpu_model
from microslip.studies.ladders import Level, exact_model

RINGS_TOLERANCE, TOLERANCE = 1e-6, 3e-5
"""Tolerance of a reference computed with rings (cheap), and with angular points."""
MOST_WORK = 5_000_000
"""Work budget of a probe (number of step solves times number of unknowns). It is several times the
work of the shipped method."""


class Point(NamedTuple):
    """A motion with its dimensionless parameters. The amplitude of a steady motion is None."""

    motion: str
    velocity: float
    amplitude: float | None = None
    poisson: float = 0.0


AnyPoint = Point | StudyPoint
"""A point of a study, or a point of the configuration."""


def of_point(point: AnyPoint) -> dict:
    """Return the entries of a request that describe the point."""
    return {
        "motion": point.motion,
        "velocity": number(point.velocity),
        "amplitude": None if point.amplitude is None else number(point.amplitude),
        "poisson": number(point.poisson),
    }


def trial(
    point: AnyPoint, model: str, method: str, level: Level, tolerance: float, repeats: int
) -> dict:
    """Return the request for a timed run at a level of a ladder (ladders.Level).

    The number of steps of a steady motion is None.
    """
    return of_point(point) | {
        "kind": "trial",
        "cpu": cpu_model(),
        "model": model,
        "method": method,
        "cells": level.cells,
        "angles": level.angles,
        "steps": None if point.amplitude is None else level.steps,
        "tolerance": number(tolerance),
        "repeats": repeats,
    }


def choice(point: AnyPoint, tolerance: float, repeats: int) -> dict:
    """Return the request for a timed solve at a tolerance."""
    kind = {"kind": "choice", "cpu": cpu_model(), "tolerance": number(tolerance)}
    return of_point(point) | kind | {"repeats": repeats}


def probe(
    point: AnyPoint,
    method: str,
    tolerance: float,
    cells: int | None = None,
    steps: int | None = None,
) -> dict:
    """Return the request for an untimed solve with a method and the budget MOST_WORK.

    cells, steps: imposed resolution. If None, the resolution follows from the tolerance.
    """
    kind = {"kind": "probe", "method": method, "model": "auto", "tolerance": number(tolerance)}
    budget = {"most_work": MOST_WORK}
    return of_point(point) | kind | {"cells": cells, "steps": steps} | budget


def reference(point: AnyPoint, tolerance: float | None = None) -> dict:
    """Return the request for the reference of a point.

    tolerance: defaults to RINGS_TOLERANCE for rings and to TOLERANCE for other models.
    """
    if tolerance is None:
        rings = exact_model(point.motion, point.poisson) == "radial"
        tolerance = RINGS_TOLERANCE if rings else TOLERANCE
    kind = {"kind": "point", "model": "auto", "tolerance": number(tolerance)}
    return of_point(point) | kind | {"cells": None, "steps": None}
