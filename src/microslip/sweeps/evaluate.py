"""Compute the result of a request as plain values for JSON.

Requests are defined in microslip.sweeps.batches.  The functions in this module import the solver
only when needed.
"""

import logging
import math
import time
from collections.abc import Callable
from statistics import median
from typing import Any, TypeVar

import microslip
from microslip.config.axes import DRIVES
from microslip.foundation import machine
from microslip.foundation.errors import InputError, SolverError

Answer = TypeVar("Answer")

log = logging.getLogger(__name__)

SHORTEST = 0.02
"""Shortest CPU time that is measured, in seconds.  Shorter runs are repeated and measured
together."""
LONG_ENOUGH = 2.0
"""Total CPU time of the readings, in seconds, after which no further reading is taken."""


def computed(request: dict, time_limit: float | None = None) -> dict:
    """Compute the result of a request as a dict of values that JSON can represent.

    time_limit: time limit of a point, as in microslip.solve.  If the solver raises SolverError or
    InputError, the point is a gap in the dataset.  Then `converged` is False, `crashed` is True,
    and `reason` is the error message in one line.  Any other exception is an error of the code or
    the machine and propagates.
    """
    try:
        limits = {} if time_limit is None else {"time_limit": time_limit}
        return plain(_KINDS[request["kind"]](request, **limits))
    except (SolverError, InputError) as error:
        log.debug("%s", request, exc_info=True)
        reason = " ".join(f"{type(error).__name__}: {error}".split())
        return {"converged": False, "crashed": True, "reason": reason}


def is_final(result: dict) -> bool:
    """False if the solver failed or reached its time limit.  Such a point is computed again."""
    return not result.get("crashed") and result.get("exhausted") != "time"


def timed(run: Callable[[], Answer], repeats: int) -> tuple[Answer, float]:
    """Call a function repeatedly.  Return its result and the CPU time of one call, in seconds.

    The first call is not timed, because it may compile code.  The time is the median of `repeats`
    readings, or of fewer if the readings take longer than LONG_ENOUGH.  CPU time excludes other
    processes.
    """
    result = run()
    readings: list[float] = []
    spent, calls = 0.0, 1
    while len(readings) < repeats and (spent < LONG_ENOUGH or not readings):
        begun = time.process_time()
        for _ in range(calls):
            run()
        took = time.process_time() - begun
        spent += took
        if took < SHORTEST and not readings:
            calls = max(2 * calls, math.ceil(1.2 * calls * SHORTEST / max(took, 1e-6)))
        else:
            readings.append(took / calls)
    return result, median(readings)


# Kinds of requests


def _point(request: dict, time_limit: float | None = None) -> dict:
    return _solved(request, model=request["model"], time_limit=time_limit)


def _history(request: dict) -> dict:
    history = microslip.history(request["motion"], **_of_single_run(request))
    names = ("phase", "displacement_forward", "force_forward", "force_lateral", "torque")
    return {name: getattr(history, name) for name in names}


def _field(request: dict) -> dict:
    return microslip.traction_field(request["motion"], **_of_single_run(request))


def _period(request: dict) -> dict:
    """Compute one period of the periodic state, packed by microslip.sweeps.period_codec."""
    from microslip.sweeps.period_codec import packed

    return _result_or_reason(lambda: packed(microslip.period(**_at(request)), request["angles"]))


def _trial(request: dict) -> dict:
    """Time a run at one resolution; `applies` is False if the method cannot be used."""
    from microslip.adaptive import single_run

    place = _place(request)
    settings = {"model": request["model"], "method": request["method"]}
    motion = {name: place[name] for name in ("motion", "poisson", "pressure") if name in place}
    reason = single_run.applies(**motion, **settings)
    if reason:
        return {"applies": False, "converged": False, "reason": reason}
    settings |= {"cells": request["cells"], "angles": request["angles"]}
    settings["steps"] = request["steps"] or 2  # a steady motion ignores the number of steps
    settings["tolerance"] = float(request["tolerance"])

    def run() -> dict:
        return single_run.run_trial(**place, **settings)

    return {"applies": True} | _timed(run, request["repeats"])


def _choice(request: dict) -> dict:
    """Time `solve` with a tolerance and automatic settings."""
    return _timed(lambda: _solved(request), request["repeats"])


def _probe(request: dict) -> dict:
    """Solve with another method; `applies` is False if the method cannot be used."""
    from microslip.adaptive import single_run
    from microslip.adaptive.checks import checked_problem
    from microslip.adaptive.choice import choose_model

    place = _place(request)
    problem = checked_problem(**{"amplitude": None} | place)
    model = choose_model(problem, request["model"])
    how = {"model": model, "method": request["method"], "pressure": problem.pressure.name}
    reason = single_run.applies(place["motion"], place["poisson"], **how)
    if reason:
        return {"applies": False, "converged": False, "reason": reason}
    settings = {"model": request["model"], "method": request["method"]}
    return {"applies": True} | _solved(request, **settings)


def _scaling(request: dict) -> dict:
    from microslip.adaptive import single_run

    sizes = [request["cells"], request["angles"], float(request["poisson"]), request["steps"]]
    return single_run.measure_steps(request["model"], *sizes) | {"machine": machine.describe()}


def _run(request: dict) -> dict:
    """Run at one resolution.  Times are not measured, so that equal requests have equal results."""
    from microslip.adaptive import single_run

    names = ("model", "method", "cells", "angles", "steps")
    settings = {name: request[name] for name in names}
    tolerance = float(request["tolerance"])
    return single_run.run_trial(**_place(request), **settings, tolerance=tolerance)


def _patches(request: dict) -> dict:
    """Compute the stick zone during a period."""
    from microslip.adaptive.stick_area import patches

    return _result_or_reason(lambda: patches(**_at(request)))


def _propulsion(request: dict) -> dict:
    """Compute the force-velocity line of a self-propelled motion, from stall to no load."""
    numbers = {name: float(request[name]) for name in ("poisson", "tolerance")}
    amplitude = float(request["amplitude"])
    line = microslip.propulsion(
        request["motion"], amplitude, points=request["points"], **numbers
    ).to_dict()
    line.pop("solve_time_s")
    return line


_KINDS = {
    "point": _point,
    "history": _history,
    "field": _field,
    "period": _period,
    "trial": _trial,
    "choice": _choice,
    "probe": _probe,
    "scaling": _scaling,
    "run": _run,
    "patches": _patches,
    "propulsion": _propulsion,
}


# Shared functions


def _place(request: dict) -> dict:
    amplitude, velocity = request["amplitude"], request["velocity"]
    place = {
        "motion": request["motion"],
        "velocity": None if velocity is None else float(velocity),
        "amplitude": None if amplitude is None else float(amplitude),
        "poisson": float(request["poisson"]),
    }
    if "pressure" in request:
        place["pressure"] = request["pressure"]
    return place


def _of_single_run(request: dict) -> dict:
    numbers = {k: float(request[k]) for k in ("velocity", "amplitude", "travel") if k in request}
    return numbers | {k: request[k] for k in ("cells", "steps", "periods", "start") if k in request}


def _solved(request: dict, **settings: object) -> dict:
    place = _place(request)
    names = ("cells", "steps", "most_work", "contacts")
    settings |= {name: request[name] for name in names if name in request}
    settings |= {name: float(request[name]) for name in DRIVES if name in request}
    tolerance = request["tolerance"]
    result = microslip.solve(
        place.pop("motion"),
        place.pop("velocity"),
        place.pop("amplitude"),
        tolerance=None if tolerance is None else float(tolerance),
        **place,
        **settings,
    ).to_dict()
    result.pop("solve_time_s", None)
    return result


def _at(request: dict) -> dict:
    return _place(request) | {name: request[name] for name in ("cells", "angles", "steps")}


def _result_or_reason(look: Callable[[], dict]) -> dict:
    """Call a function that requires a periodic state.  Return the reason if there is no such
    state."""
    from microslip.adaptive.period import NoPeriodicState

    try:
        return look()
    except NoPeriodicState as error:
        return {"converged": False, "reason": str(error)}


def _timed(run: Callable[[], dict], repeats: int) -> dict:
    result, seconds = timed(run, repeats)
    return dict(result) | {"seconds": seconds, "machine": machine.describe()}


def plain(value: object) -> Any:
    """Convert NumPy values, also in dicts and lists, to values for JSON; NaN becomes None."""
    if isinstance(value, dict):
        return {str(name): plain(item) for name, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
