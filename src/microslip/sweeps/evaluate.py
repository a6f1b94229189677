"""Compute the result of a request as plain values that JSON can represent.

Requests are defined in microslip.sweeps.request.  This module imports the solver.
"""

import logging
import math
import time
from collections.abc import Callable
from functools import partial
from statistics import median
from timeit import Timer
from typing import Any, TypeVar

import microslip
from microslip.answer import period, point
from microslip.answer.limits import choose_model, problem_of
from microslip.foundation import machine
from microslip.foundation.canonical import plain
from microslip.foundation.errors import InputError, SolverError
from microslip.sweeps.period_codec import packed
from microslip.sweeps.request import REALS

Answer = TypeVar("Answer")

log = logging.getLogger(__name__)

OTHER_KEYS = ("kind", "cpu")
"""Keys in requests that are not arguments of the function that computes the result.  A measured
time is valid for one CPU only."""
SHORTEST = 0.02
"""Shortest measured CPU time, in seconds.  A shorter run is repeated, and the repetitions are
measured together."""
LONG_ENOUGH = 2.0
"""Total CPU time of the readings, in seconds, after which no further reading is taken."""


def computed(request: dict) -> dict:
    """Compute the result of a request as a dict of values that JSON can represent.

    If no periodic state is found, `converged` is False, and `reason` is the cause.  If the solver
    raises another SolverError or an InputError, the point is a gap in the dataset.  In this case,
    `crashed` is also True, and `reason` is the error message in one line.  Any other exception
    indicates an error of the code or of the machine, and is not caught.
    """
    arguments = {
        name: float(value) if name in REALS and value is not None else value
        for name, value in request.items()
        if name not in OTHER_KEYS
    }
    try:
        return plain(_KINDS[request["kind"]](**arguments))
    except period.NoPeriodicState as error:
        return {"converged": False, "reason": str(error)}
    except (SolverError, InputError) as error:
        log.debug("%s", request, exc_info=True)
        reason = " ".join(f"{type(error).__name__}: {error}".split())
        return {"converged": False, "crashed": True, "reason": reason}


def timed(run: Callable[[], Answer], repeats: int) -> tuple[Answer, float]:
    """Call a function repeatedly, and return its result and the CPU time of one call in seconds.

    The first call is not timed, because it may compile code.  The time is the median of several
    readings.  There are `repeats` readings, or fewer if the readings take longer than LONG_ENOUGH
    in total.  CPU time excludes other processes.
    """
    result, timer, calls = run(), Timer(run, timer=time.process_time), 1
    while (took := timer.timeit(calls)) < SHORTEST:
        calls = max(2 * calls, math.ceil(1.2 * calls * SHORTEST / max(took, 1e-6)))
    readings = [took]
    while len(readings) < repeats and sum(readings) < LONG_ENOUGH:
        readings.append(timer.timeit(calls))
    return result, median(readings) / calls


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
    return packed(microslip.period(**arguments), arguments["angles"])


def _patches(**arguments: Any) -> dict:
    """Compute the stick zone during a period."""
    return period.patches(**arguments)


def _run(**arguments: Any) -> dict:
    """Run at one resolution.  Results contain no measured times, so identical requests give
    identical results."""
    return point.run_trial(**arguments)


def _trial(repeats: int, **arguments: Any) -> dict:
    """Time a run at one resolution.  In the result, `applies` is False if the method cannot be
    used."""
    arguments["steps"] = arguments["steps"] or 2  # a steady motion ignores the number of steps
    return _refusal(**arguments) or {"applies": True} | _timed(partial(_run, **arguments), repeats)


def _choice(repeats: int, **arguments: Any) -> dict:
    """Time a call of `solve` with a tolerance and automatic settings."""
    return _timed(partial(_point, **arguments), repeats)


def _probe(**arguments: Any) -> dict:
    """Solve with another method.  In the result, `applies` is False if the method cannot be
    used."""
    names = ("motion", "velocity", "amplitude", "pressure", "poisson")
    problem = problem_of(**{name: arguments[name] for name in names if name in arguments})
    model = choose_model(problem, arguments["model"])
    return _refusal(**arguments | {"model": model}) or {"applies": True} | _point(**arguments)


KINDS = (_point, _history, _field, _period, _patches, _run, _trial, _choice, _probe)
_KINDS: dict[str, Callable[..., dict]] = {one.__name__.removeprefix("_"): one for one in KINDS}


def _refusal(**arguments: Any) -> dict:
    """Return the result for a model or a method that does not apply, or an empty dict if both
    apply.

    arguments: the arguments of point.applies, and possibly others.
    """
    names = ("motion", "poisson", "model", "method", "pressure")
    reason = point.applies(**{name: arguments[name] for name in names if name in arguments})
    return {"applies": False, "converged": False, "reason": reason} if reason else {}


def _timed(run: Callable[[], dict], repeats: int) -> dict:
    result, seconds = timed(run, repeats)
    return result | {"seconds": seconds, "machine": machine.describe()}
