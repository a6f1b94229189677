"""One point as `microslip.solve` answers it, kept among the results of sweeps."""

from __future__ import annotations

import os
import time
import warnings
from dataclasses import replace
from pathlib import Path

from microslip.adaptive.checks import (
    checked_driven_problem,
    checked_request,
    refuse_bounds,
)
from microslip.adaptive.choice import choose_model
from microslip.adaptive.driven_contact import refuse_drive
from microslip.adaptive.request import TOLERANCE
from microslip.adaptive.result import Result
from microslip.config.axes import DRIVES
from microslip.config.records import Sweep
from microslip.foundation.errors import InputError
from microslip.foundation.files import refuse_no_folder, refuse_unusable
from microslip.motions.problem import Problem
from microslip.sweeps import batches
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
    contacts: str | None = None,
    pressure: str = "hertz",
    poisson: float = 0.0,
    model: str = "auto",
    tolerance: float | None = TOLERANCE,
    cells: int | None = None,
    steps: int | None = None,
    time_limit: float | None = None,
) -> Result:
    """Friction at one point, from a folder of results if it is there, else computed and kept there.

    A result is named by the physics, the tolerance and the sources of the solver, so that a sweep,
    the command line and this function find what any of them has computed.  Numbers are rounded to
    12 digits first, as those of sweeps are.  What ran into the time limit, or raised, is not kept.

    Parameters
    ----------
    results : str or path
        Folder, that of a sweep or a new one; the rest as for `microslip.solve`.

    Returns
    -------
    Result
        Its solve_time_s is that of this call.

    Raises
    ------
    InputError
        As `solve` does.
    CacheError
        If the folder cannot be used.
    """
    started = time.perf_counter()
    if isinstance(motion, Problem):
        raise InputError("motion", str(motion), "allowed is a text, by which results are named")
    if not isinstance(results, str | os.PathLike):
        raise InputError("results", results, "is not allowed; allowed: the name of a folder")
    drive = {"force": force, "stiffness": stiffness, "mass": mass, "damping": damping}
    problem = checked_driven_problem(
        motion,
        velocity,
        amplitude,
        pressure=pressure,
        poisson=poisson,
        contacts=contacts,
        **drive,
    )
    tolerance, cells, steps = checked_request(tolerance, cells, steps)
    refuse_bounds(time_limit=time_limit)
    chosen = choose_model(problem, model)
    if problem.drive is not None:
        refuse_drive(problem, chosen)
    if tolerance is None:
        from microslip.adaptive.friction import refuse_choice  # only now: it loads compiled code

        moving = problem if force is None else replace(problem, velocity=1.0, drive=None)
        refuse_choice(moving, model, cells, steps)
    kind, pressure = problem.motion.name, problem.pressure.name
    grid = Sweep(
        name=kind,
        motion=kind,
        velocity=() if velocity is None else (problem.velocity,),
        amplitude=None if amplitude is None else (problem.amplitude,),
        poisson=(problem.poisson,),
        poisson_is_axis=False,
        model=model,
        tolerance=tolerance,
        cells=cells,
        steps=steps,
        pressure=pressure,
        contacts=contacts,
        drives=_drives(**drive),
    )
    (request,) = batches.PointRequests(grid)
    refuse_no_folder(results)
    refuse_unusable([results], [])
    try:
        record, _ = batches.answer(request, Store(results), time_limit)
    except batches.SourcesEdited as edited:
        if edited.record is None:
            raise
        warnings.warn(str(edited), stacklevel=2)
        record = edited.record
    given = {"pressure": pressure} | request | record["result"]
    numbers = ("velocity", "amplitude", "poisson", "tolerance", *DRIVES)
    given |= {k: float(given[k]) for k in numbers if given.get(k) is not None}
    return Result.from_dict(given | {"solve_time_s": time.perf_counter() - started})


def _drives(**given: float | None) -> tuple:
    """The drive in the format of a Sweep."""
    values = ((name, given[name]) for name in DRIVES)
    return tuple((name, (float(value),), False) for name, value in values if value is not None)
