"""Compute the result of a request as plain values for JSON.

Requests are defined in microslip.sweeps.request.  The functions in this module import the solver
only when needed.
"""

import logging
import math
import time
from collections.abc import Callable
from functools import partial
from statistics import median
from typing import Any, TypeVar

import microslip
from microslip.config.quantities import DRIVES
from microslip.foundation import machine
from microslip.foundation.canonical import number
from microslip.foundation.errors import InputError, SolverError

Answer = TypeVar("Answer")

log = logging.getLogger(__name__)

REALS = {"velocity", "amplitude", "poisson", "tolerance", "travel", *DRIVES}
"""Keys of requests whose values are numbers written as texts."""
OTHER_KEYS = ("kind", "cpu")
"""Keys of requests that are not arguments.  A measured time is valid for one CPU only."""
SHORTEST = 0.02
"""Shortest CPU time that is measured, in seconds.  Shorter runs are repeated and measured
together."""
LONG_ENOUGH = 2.0
"""Total CPU time of the readings, in seconds, after which no further reading is taken."""


def computed(request: dict) -> dict:
    """Compute the result of a request as a dict of values that JSON can represent.

    If the solver raises SolverError or InputError, the point is a gap in the dataset.  Then
    `converged` is False, `crashed` is True, and `reason` is the error message in one line.  Any
    other exception is an error of the code or the machine and propagates.
    """
    try:
        return plain(_KINDS[request["kind"]](**arguments(request)))
    except (SolverError, InputError) as error:
        log.debug("%s", request, exc_info=True)
        reason = " ".join(f"{type(error).__name__}: {error}".split())
        return {"converged": False, "crashed": True, "reason": reason}


def request_of(kind: str, **arguments: Any) -> dict:
    """Return a request with the arguments of the function that computes it. Numbers become
    canonical texts."""
    texts = {name: number(v) for name, v in arguments.items() if name in REALS and v is not None}
    return {"kind": kind} | arguments | texts


def arguments(request: dict) -> dict:
    """Return the keyword arguments of the function that computes a request.  Numbers written as
    texts become floats."""
    return {
        name: float(value) if name in REALS and value is not None else value
        for name, value in request.items()
        if name not in OTHER_KEYS
    }


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


def _point(**arguments: Any) -> dict:
    result = microslip.solve(**arguments).to_dict()
    result.pop("solve_time_s", None)
    return result


def _history(**arguments: Any) -> dict:
    history = microslip.history(**arguments)
    names = ("phase", "displacement_forward", "force_forward", "force_lateral", "torque")
    return {name: getattr(history, name) for name in names}


def _field(**arguments: Any) -> dict:
    return microslip.traction_field(**arguments)


def _period(**arguments: Any) -> dict:
    """Compute one period of the periodic state, packed by microslip.sweeps.period_codec."""
    from microslip.sweeps.period_codec import packed

    period = partial(microslip.period, **arguments)
    return _result_or_reason(lambda: packed(period(), arguments["angles"]))


def _trial(repeats: int, **arguments: Any) -> dict:
    """Time a run at one resolution; `applies` is False if the method cannot be used."""
    names = ("motion", "poisson", "model", "method", "pressure")
    if reason := _refusal(**{name: arguments[name] for name in names if name in arguments}):
        return reason
    arguments["steps"] = arguments["steps"] or 2  # a steady motion ignores the number of steps
    return {"applies": True} | _timed(partial(_run, **arguments), repeats)


def _choice(repeats: int, **arguments: Any) -> dict:
    """Time `solve` with a tolerance and automatic settings."""
    return _timed(partial(_point, **arguments), repeats)


def _probe(**arguments: Any) -> dict:
    """Solve with another method; `applies` is False if the method cannot be used."""
    from microslip.answer.limits import choose_model, problem_of

    names = ("motion", "velocity", "amplitude", "pressure", "poisson")
    problem = problem_of(**{name: arguments[name] for name in names if name in arguments})
    model, pressure = choose_model(problem, arguments["model"]), problem.pressure.name
    place = arguments["motion"], arguments["poisson"], model, arguments["method"], pressure
    return _refusal(*place) or {"applies": True} | _point(**arguments)


def _run(**arguments: Any) -> dict:
    """Run at one resolution.  Times are not measured, so that equal requests have equal results."""
    from microslip.answer import point

    return point.run_trial(**arguments)


def _patches(**arguments: Any) -> dict:
    """Compute the stick zone during a period."""
    from microslip.answer.period import patches

    return _result_or_reason(partial(patches, **arguments))


_KINDS: dict[str, Callable[..., dict]] = {
    "point": _point,
    "history": _history,
    "field": _field,
    "period": _period,
    "trial": _trial,
    "choice": _choice,
    "probe": _probe,
    "run": _run,
    "patches": _patches,
}


# Shared functions


def _refusal(*place: Any, **settings: Any) -> dict:
    """Return the result for a model or a method that does not apply, and an empty dict otherwise.

    The function has the same arguments as point.applies.
    """
    from microslip.answer import point

    reason = point.applies(*place, **settings)
    return {"applies": False, "converged": False, "reason": reason} if reason else {}


def _result_or_reason(look: Callable[[], dict]) -> dict:
    """Call a function that requires a periodic state.  Return the reason if there is no such
    state."""
    from microslip.answer.period import NoPeriodicState

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
