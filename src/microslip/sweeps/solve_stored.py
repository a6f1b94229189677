"""One point as `microslip.solve` answers it, kept among the results of sweeps."""

import math
import time
import warnings
from dataclasses import fields

from microslip.adaptive.asked import TOLERANCE
from microslip.adaptive.checks import checked_point, checked_request, refuse_bounds
from microslip.adaptive.choice import choose_model
from microslip.adaptive.moved import refuse_choice
from microslip.adaptive.result import Result
from microslip.config.records import Sweep
from microslip.sweeps import batches
from microslip.sweeps.cache import Store


def solve_stored(
    scene,
    velocity,
    amplitude=None,
    *,
    results="results",
    pressure="hertz",
    poisson=0.0,
    model="auto",
    tolerance=TOLERANCE,
    cells=None,
    steps=None,
    time_limit=None,
):
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
    kind, velocity, amplitude, poisson = checked_point(
        scene, velocity, amplitude, poisson, pressure
    )
    tolerance, cells, steps = checked_request(tolerance, cells, steps)
    refuse_bounds(time_limit=time_limit)
    choose_model(kind, poisson, model)
    if tolerance is None:
        refuse_choice(kind, model, (velocity, amplitude, poisson), cells, steps)
    grid = Sweep(
        name=kind.name,
        scene=kind.name,
        velocity=(velocity,),
        amplitude=None if amplitude is None else (amplitude,),
        poisson=(poisson,),
        poisson_is_axis=False,
        model=model,
        tolerance=tolerance,
        cells=cells,
        steps=steps,
        pressure=kind.pressure.name,
    )
    (request,) = batches.PointRequests(grid)
    try:
        record, _ = batches.answer(request, Store(results), time_limit)
    except batches.SourcesEdited as edited:
        if edited.record is None:
            raise
        warnings.warn(str(edited), stacklevel=2)
        record = edited.record
    given = {"pressure": kind.pressure.name} | request | record["result"]
    numbers = ("velocity", "amplitude", "poisson", "tolerance")
    given |= {k: float(given[k]) for k in numbers if given[k] is not None}
    return _result(given | {"solve_time_s": time.perf_counter() - started})


def _result(given):
    """The Result with these fields; what a failed solver or JSON left out is NaN, 0 or empty."""
    left_out = {"float": math.nan, "int": 0, "str": "", "bool": False}
    values = {"periods": 0.0}
    for field in fields(Result):
        value = given.get(field.name)
        if value is not None:
            values[field.name] = value
        else:
            values.setdefault(field.name, left_out.get(field.type))
    return Result(**values)
