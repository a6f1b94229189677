"""Requests of the studies: plain dicts with numbers as canonical strings, see sweeps.batches.

- trial: one timed run of (point, model, method, resolution);
- choice: one timed solve at a tolerance, which picks its own model and resolution;
- probe: one solve with a method exchanged, with nothing timed;
- point: an ordinary point of a sweep, solved tightly, that the others are compared with;
- drive: the line of a self-propelled motion, from stall to no load;
- scaling: what a step costs at one size.

Requests that are timed (trial, choice, scaling) name the model of the CPU, so that times of
different CPUs have different keys and never meet in one chart.
"""

from typing import NamedTuple

from microslip.foundation.canonical import number
from microslip.foundation.machine import cpu_model
from microslip.studies.ladders import Level, exact_model

RINGS_TOLERANCE, TOLERANCE = 1e-6, 3e-5
"""Tolerances of references: with rings only, which are cheap, and with angular points."""
MOST_WORK = 5_000_000
"""Step solves x unknowns that a probe may take: several times what the shipped method needs."""


class Point(NamedTuple):
    """A point of a motion, all numbers dimensionless; amplitude None: the motion is steady."""

    motion: str
    velocity: float
    amplitude: float | None = None
    poisson: float = 0.0


def of_point(point: Point) -> dict:
    """The part of a request that names the point."""
    return {
        "motion": point.motion,
        "velocity": number(point.velocity),
        "amplitude": None if point.amplitude is None else number(point.amplitude),
        "poisson": number(point.poisson),
    }


def trial(
    point: Point, model: str, method: str, level: Level, tolerance: float, repeats: int
) -> dict:
    """One timed run; level: ladders.Level.  A steady motion takes no steps."""
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
    """One timed solve, as anybody would call it."""
    kind = {"kind": "choice", "cpu": cpu_model(), "tolerance": number(tolerance)}
    return of_point(point) | kind | {"repeats": repeats}


def probe(
    point: Point, method: str, tolerance: float, cells: int | None = None, steps: int | None = None
) -> dict:
    """One solve with another method, on a budget; cells, steps: imposed resolution, None: by the
    tolerance."""
    kind = {"kind": "probe", "method": method, "model": "auto", "tolerance": number(tolerance)}
    budget = {"most_work": MOST_WORK}
    return of_point(point) | kind | {"cells": cells, "steps": steps} | budget


def reference(point: Point, tolerance: float | None = None) -> dict:
    """An ordinary point; tolerance: None for what a reference is worth."""
    if tolerance is None:
        rings = exact_model(point.motion, point.poisson) == "radial"
        tolerance = RINGS_TOLERANCE if rings else TOLERANCE
    kind = {"kind": "point", "model": "auto", "tolerance": number(tolerance)}
    return of_point(point) | kind | {"cells": None, "steps": None}


def scaling(model: str, cells: int | None, angles: int, steps: int | None) -> dict:
    """Request for the cost of a step at a resolution, over a period of `steps` steps."""
    sizes = {"cells": cells, "angles": angles, "steps": steps}
    return {"kind": "scaling", "cpu": cpu_model(), "model": model, "poisson": "0"} | sizes
