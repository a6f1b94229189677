"""Requests of the studies: plain dicts with numbers as canonical strings, see sweeps.batches.

- trial: a timed run at a point, with a model, a method and a resolution;
- choice: a timed solve at a tolerance, which selects its own model and resolution;
- probe: a solve with another method, not timed;
- point: a point of a sweep at a tight tolerance, the reference of the others;
- propulsion: the force-velocity line of a self-propelled motion;
- scaling: the cost of a step at one size.

Timed requests (trial, choice, scaling) contain the model of the CPU, so that times of different
CPUs have different keys and are not drawn in one chart.
"""

from typing import NamedTuple

from microslip.foundation.canonical import number
from microslip.foundation.machine import cpu_model
from microslip.studies.ladders import Level, exact_model

RINGS_TOLERANCE, TOLERANCE = 1e-6, 3e-5
"""Tolerances of references: with rings, which are cheap, and with angular points."""
MOST_WORK = 5_000_000
"""Limit of step solves times unknowns of a probe: several times the work of the shipped method."""


class Point(NamedTuple):
    """A point of a motion, in dimensionless numbers; the amplitude is None for a steady motion."""

    motion: str
    velocity: float
    amplitude: float | None = None
    poisson: float = 0.0


def of_point(point: Point) -> dict:
    """The entries of a request that describe the point."""
    return {
        "motion": point.motion,
        "velocity": number(point.velocity),
        "amplitude": None if point.amplitude is None else number(point.amplitude),
        "poisson": number(point.poisson),
    }


def trial(
    point: Point, model: str, method: str, level: Level, tolerance: float, repeats: int
) -> dict:
    """Request for a timed run at a ladders.Level. The steps of a steady motion are None."""
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


def choice(point: Point, tolerance: float, repeats: int) -> dict:
    """Request for a timed solve at a tolerance."""
    kind = {"kind": "choice", "cpu": cpu_model(), "tolerance": number(tolerance)}
    return of_point(point) | kind | {"repeats": repeats}


def probe(
    point: Point, method: str, tolerance: float, cells: int | None = None, steps: int | None = None
) -> dict:
    """Request for a solve with another method, which takes at most MOST_WORK.

    cells, steps: imposed resolution; None: chosen by the tolerance.
    """
    kind = {"kind": "probe", "method": method, "model": "auto", "tolerance": number(tolerance)}
    budget = {"most_work": MOST_WORK}
    return of_point(point) | kind | {"cells": cells, "steps": steps} | budget


def reference(point: Point, tolerance: float | None = None) -> dict:
    """Request for a point; tolerance: by default RINGS_TOLERANCE or TOLERANCE, by its model."""
    if tolerance is None:
        rings = exact_model(point.motion, point.poisson) == "radial"
        tolerance = RINGS_TOLERANCE if rings else TOLERANCE
    kind = {"kind": "point", "model": "auto", "tolerance": number(tolerance)}
    return of_point(point) | kind | {"cells": None, "steps": None}


def scaling(model: str, cells: int | None, angles: int, steps: int | None) -> dict:
    """Request for the cost of a step at a resolution, measured over a period of `steps` steps."""
    sizes = {"cells": cells, "angles": angles, "steps": steps}
    return {"kind": "scaling", "cpu": cpu_model(), "model": model, "poisson": "0"} | sizes
