"""From a configuration to results: requests, batches of them, and their answers.

A request is a plain dict that says what to compute, with numbers as canonical strings; together
with the digest of the solver it names a result. A job gets a batch of requests and computes those
that the store does not hold, so how points are cut into batches never decides what is computed.

The solver is imported only when something has to be computed.
"""

import importlib.metadata
import logging
import math
import platform
import time
from functools import cache

import microslip

from .config import HISTORIES_OF_SWEEP
from .keys import batch_name, number, result_key, source_digest

log = logging.getLogger(__name__)

# The initial states of Figure 5.
STARTS = ("stress-free", "full-rotation", "full-slip")


def point_requests(sweep):
    """List the requests for all points of a config.Sweep.

    The order is that of the dataset: Poisson's ratio, amplitude, velocity, the last one fastest.
    """
    common = {
        "kind": "point",
        "scene": sweep.scene,
        "model": sweep.model,
        "tolerance": number(sweep.tolerance),
        "cells": sweep.cells,
        "steps": sweep.steps,
    }
    velocities = [number(v) for v in sweep.velocity]
    amplitudes = [None] if sweep.amplitude is None else [number(a) for a in sweep.amplitude]
    return [
        {**common, "poisson": number(poisson), "amplitude": amplitude, "velocity": velocity}
        for poisson in sweep.poisson
        for amplitude in amplitudes
        for velocity in velocities
    ]


def history_requests(configuration, name):
    """List the requests for the single runs that go into the dataset of the sweep `name`."""
    given = configuration.histories
    requests = {
        "transverse": lambda settings: [
            _single("history", "transverse", settings, start="stress-free")
        ],
        "field": lambda settings: [_single("field", "continuous-bore", settings)],
        "transients": lambda settings: [
            _single("history", "continuous-bore", settings, start=start) for start in STARTS
        ],
    }
    return [r for run in HISTORIES_OF_SWEEP[name] for r in requests[run](given[run])]


def _single(kind, scene, settings, **more):
    counts = ("cells", "steps", "periods")
    numbers = {k: number(v) for k, v in settings.items() if k not in counts}
    return {"kind": kind, "scene": scene} | settings | numbers | more


def batches(requests, size, digest):
    """Cut requests into lists of `size` and return them by name; the name tells the content."""
    cuts = (requests[i : i + size] for i in range(0, len(requests), size))
    return {batch_name([result_key(r, digest) for r in cut]): cut for cut in cuts}


def group(request):
    """Name the subfolder of the store that a request's result goes to."""
    kind = "points" if request["kind"] == "point" else "histories"
    return f"{kind}/{request['scene']}"


def answer(request, store):
    """Return the record that answers `request` and the seconds that the solver took for it.

    It comes from the store if that has it (0 seconds), else it is computed and stored. The record
    is a dict: key, request, result, versions. Raises CacheError if it cannot be stored.
    """
    key = result_key(request, source_digest())
    record = store.read(group(request), key)
    if record is not None:
        return record, 0.0
    started = time.perf_counter()
    result = _compute(request)
    seconds = time.perf_counter() - started
    # How long it took is left out: equal requests have equal records, bit for bit.
    record = {"key": key, "request": request, "result": result, "versions": versions()}
    store.write(group(request), key, record)
    return record, seconds


def run_batch(requests, store, progress=iter):
    """Answer every request; return the batch's index (dict) and its statistics (dict).

    progress: wraps the list of requests and yields them one by one, such as tqdm. The index
    depends on the requests and the solver alone; times and counts are in the statistics.
    """
    keys, not_converged, computed, seconds = [], 0, 0, 0.0
    for request in progress(requests):
        record, took = answer(request, store)
        keys.append(record["key"])
        computed += took > 0
        seconds += took
        if not record["result"].get("converged", True):
            not_converged += 1
            log.info("not converged: %s: %s", label(request), record["result"]["reason"])
    index = {"keys": keys, "not_converged": not_converged}
    statistics = {"points": len(keys), "computed": computed, "solver_seconds": seconds}
    return index, statistics


def label(request):
    """Describe a request in a few words, for messages."""
    names = ("poisson", "amplitude", "velocity", "start")
    given = ", ".join(f"{name} {request[name]}" for name in names if request.get(name) is not None)
    return f"{request['scene']} at {given}"


@cache
def versions():
    """Versions of Python and of the numerical libraries that compute a result, as a dict."""
    found = {name: importlib.metadata.version(name) for name in ("numpy", "scipy", "numba")}
    return {"python": platform.python_version(), **found}


def _compute(request):
    """Ask the solver; the result as a dict of plain values."""
    if request["kind"] == "point":
        return _solved(request)
    given = {k: float(request[k]) for k in ("velocity", "amplitude", "travel") if k in request}
    given |= {k: request[k] for k in ("cells", "steps", "periods", "start") if k in request}
    if request["kind"] == "field":
        return _plain(microslip.traction_field(request["scene"], **given))
    history = microslip.history(request["scene"], **given)
    names = ("phase", "displacement_forward", "force_forward", "force_lateral", "torque")
    return _plain({name: getattr(history, name) for name in names})


def _solved(request):
    amplitude = request["amplitude"]
    try:
        result = microslip.solve(
            request["scene"],
            float(request["velocity"]),
            None if amplitude is None else float(amplitude),
            poisson=float(request["poisson"]),
            model=request["model"],
            tolerance=float(request["tolerance"]),
            cells=request["cells"],
            steps=request["steps"],
        ).to_dict()
    except (ArithmeticError, RuntimeError) as error:
        # One point that fails is a gap in the map, not the end of the sweep.
        result = {"converged": False, "reason": f"{type(error).__name__}: {error}"}
    result.pop("solve_time_s", None)
    return _plain(result)


def _plain(value):
    """Python values that JSON can hold, from NumPy's or a dict of them; NaN becomes None."""
    if isinstance(value, dict):
        return {str(name): _plain(item) for name, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if hasattr(value, "tolist"):
        return _plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
