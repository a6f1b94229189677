"""Runs that decide the verdicts, and the commands that repeat them."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from microslip.foundation.canonical import canonical_json
from microslip.studies.tables import Answers, value_of


@dataclass(frozen=True)
class Run:
    """A stored result: its key in the store, the request, and the result."""

    key: str
    request: dict
    result: dict


class Runs(Answers):
    """Look up runs by request. `by_request` contains the runs in the order of first request."""

    def __init__(self, answer: Callable):
        super().__init__(answer)
        self.by_request: dict[str, Run] = {}

    def __call__(self, request: dict) -> Run:
        text = canonical_json(request)
        if text not in self.by_request:
            record = self.record(request)
            self.by_request[text] = Run(record["key"], request, record["result"])
        return self.by_request[text]


def friction(run: Run) -> tuple[float, float]:
    """Return (mu_macro, error estimate) of a point. The error is infinite if the point did not
    converge."""
    error = value_of(run.result, "mu_macro_error")
    good = value_of(run.result, "converged", bool) and np.isfinite(error)
    return value_of(run.result, "mu_macro"), error if good else np.inf


def resolution(run: Run) -> tuple[int, ...]:
    """Return (cells, angles, steps) of a run. A missing number is 0."""
    used = run.request | {name: n for name, n in run.result.items() if name in ("cells", "angles")}
    steps = run.result.get("steps_per_period") or run.request.get("steps")
    return tuple(int(n or 0) for n in (used.get("cells"), used.get("angles"), steps))


def command(request: dict) -> str:
    """Return a shell command that repeats the computation of a request."""
    kind, motion = request["kind"], request["motion"]
    if kind == "point":
        words = ["microslip point", motion, f"--velocity {request['velocity']}"]
        words += [f"--amplitude {request['amplitude']}"] if request["amplitude"] else []
        words += [f"--poisson {request['poisson']}"] if request["poisson"] != "0" else []
        words += [f"--pressure {request['pressure']}"] if "pressure" in request else []
        words += [f"--model {request['model']}"] if request["model"] != "auto" else []
        words += [f"--{n} {request[n]}" for n in ("tolerance", "cells", "steps") if request[n]]
        return " ".join(words)
    place = [repr(motion), request["velocity"]]
    place += [request["amplitude"]] if request.get("amplitude") else []
    arguments = [
        f"{name}={_literal(value)}"
        for name, value in request.items()
        if value is not None and name not in ("kind", "motion", "velocity", "amplitude")
    ]
    module, _, function = _CALLS[kind].partition(" ")
    return (
        f'python -c "from {module} import {function.partition("(")[0]}; '
        f'print({function.replace("...", ", ".join([*place, *arguments]))})"'
    )


_CALLS = {
    "history": "microslip history(...).force_forward[-1]",
    "field": "microslip traction_field(...)",
    "patches": "microslip.adaptive.stick_area patches(...)['least_stick']",
    "run": "microslip.adaptive.single_run run_trial(...)['mu_macro']",
}
"""For each kind of request: the module, and the function call."""


def _literal(value: str | float) -> str:
    """Return a value of a request as a Python literal. Numeric strings get no quotes."""
    try:
        float(value)
    except ValueError:
        return repr(value)
    return str(value)


def made_by(request: dict) -> str:
    """Return a short description of how a run was computed."""
    kinds = {
        "point": "certified point",
        "history": f"transient from {request.get('start')}",
        "field": "steady tractions",
        "patches": "tractions over a period",
        "run": f"single run, method {request.get('method')}",
    }
    limit = request["kind"] == "point" and request["velocity"] == "0"
    return "static limit" if limit else kinds[request["kind"]]
