"""Solve one point with `microslip.solve`, or reuse the stored result of a sweep."""

from __future__ import annotations

import os
import time
import warnings
from dataclasses import replace
from pathlib import Path

from microslip.adaptive.checks import checked_driven_problem
from microslip.adaptive.request import TOLERANCE, request_for
from microslip.adaptive.result import Result
from microslip.config.axes import DRIVES
from microslip.config.records import Sweep
from microslip.foundation.errors import InputError
from microslip.foundation.files import refuse_no_folder, refuse_unusable
from microslip.motions.problem import Problem
from microslip.sweeps import batches, evaluate
from microslip.sweeps.store import Store


def solve_stored(
    motion: str,
    velocity: float | None = None,
    amplitude: float | None = None,
    *,
    results: str | Path = "results",
    force: float | None = None,
    stiffness: float | None = None,
    mass: float | None = None,
    damping: float | None = None,
    pressure: str = "hertz",
    poisson: float = 0.0,
    model: str = "auto",
    tolerance: float | None = TOLERANCE,
    cells: int | None = None,
    steps: int | None = None,
    time_limit: float | None = None,
) -> Result:
    """Read the friction at one point from a folder of results.  If it is missing, compute and store
    it.

    The key of a result is a hash of the point, the tolerance and the solver's code.  Sweeps, the
    command line and this function therefore share results.  Numbers are rounded to 12 digits, as in
    sweeps.  The result is not stored if the solver failed or reached its time limit.

    Parameters
    ----------
    results : str or path
        Folder of results, which is created if needed.  The other arguments are those of
        `microslip.solve`.

    Returns
    -------
    Result
        The result; its attribute `solve_time_s` is the duration of this call.

    Raises
    ------
    InputError
        If an argument is invalid, as in `microslip.solve`.
    CacheError
        If the folder cannot be used.
    """
    started = time.perf_counter()
    if isinstance(motion, Problem):
        raise InputError("motion", str(motion), "allowed is a text, as in the keys of results")
    if not isinstance(results, str | os.PathLike):
        raise InputError("results", results, "is not allowed; allowed: the name of a folder")
    drive = {"force": force, "stiffness": stiffness, "mass": mass, "damping": damping}
    problem = checked_driven_problem(
        motion,
        velocity,
        amplitude,
        pressure=pressure,
        poisson=poisson,
        **drive,
    )
    point = request_for(problem, model, tolerance, cells=cells, steps=steps, time_limit=time_limit)
    if tolerance is None:
        from microslip.adaptive.friction import refuse_choice  # here: it loads compiled code

        moving = problem if force is None else replace(problem, velocity=1.0, drive=None)
        refuse_choice(replace(point, problem=moving))
    kind, pressure = problem.motion.name, problem.pressure.name
    grid = Sweep(
        name=kind,
        motion=kind,
        velocity=() if velocity is None else (problem.velocity,),
        amplitude=None if amplitude is None else (problem.amplitude,),
        poisson=(problem.poisson,),
        poisson_is_axis=False,
        model=model,
        tolerance=point.tolerance,
        cells=point.cells,
        steps=point.steps,
        pressure=pressure,
        drives=_drives(**drive),
    )
    (request,) = batches.points_of(grid).requests
    refuse_no_folder(results)
    refuse_unusable([results], [])
    try:
        record, _ = batches.answer(request, Store(results), time_limit)
    except batches.SourcesEdited as edited:
        if edited.record is None:
            raise
        warnings.warn(str(edited), stacklevel=2)
        record = edited.record
    values = {"pressure": pressure} | evaluate.arguments(request) | record["result"]
    return Result.from_dict(values | {"solve_time_s": time.perf_counter() - started})


def _drives(**values: float | None) -> tuple:
    """Convert a drive to the format of `Sweep.drives`."""
    pairs = ((name, values[name]) for name in DRIVES)
    return tuple((name, (float(value),), False) for name, value in pairs if value is not None)
