"""The runs behind the verdicts: results by request, and how each can be repeated."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from microslip.foundation.canonical import canonical_json
from microslip.studies.tables import Answers, value_of


@dataclass(frozen=True)
class Run:
    """A stored result: its name, what was asked, and what came out."""

    key: str
    request: dict
    result: dict


class Runs(Answers):
    """Answers that keep the runs in the order in which they were first asked for."""

    def __init__(self, answer: Callable):
        super().__init__(answer)
        self.found: dict[str, Run] = {}

    def __call__(self, request: dict) -> Run:
        text = canonical_json(request)
        if text not in self.found:
            record = self.record(request)
            self.found[text] = Run(record["key"], request, record["result"])
        return self.found[text]


def friction(run: Run) -> tuple[float, float]:
    """(mu_macro, its error) of a certified point; the error is infinite if it did not converge."""
    error = value_of(run.result, "mu_macro_error")
    good = value_of(run.result, "converged", bool) and np.isfinite(error)
    return value_of(run.result, "mu_macro"), error if good else np.inf


def resolution(run: Run) -> tuple[int, ...]:
    """(cells, angles, steps) of a run as far as it has them, 0 for what it has not."""
    used = run.request | {name: n for name, n in run.result.items() if name in ("cells", "angles")}
    steps = run.result.get("steps_per_period") or run.request.get("steps")
    return tuple(int(n or 0) for n in (used.get("cells"), used.get("angles"), steps))


def command(request: dict) -> str:
    """A line for the shell that computes a request again."""
    kind, motion = request["kind"], request["motion"]
    if kind == "point":
        words = ["microslip point", motion, f"--velocity {request['velocity']}"]
        words += [f"--amplitude {request['amplitude']}"] if request["amplitude"] else []
        words += [f"--poisson {request['poisson']}"] if request["poisson"] != "0" else []
        words += [f"--model {request['model']}"] if request["model"] != "auto" else []
        words += [f"--{n} {request[n]}" for n in ("tolerance", "cells", "steps") if request[n]]
        return " ".join(words)
    place = [repr(motion), request["velocity"]]
    place += [request["amplitude"]] if request.get("amplitude") else []
    names, call = _CALLS[kind]
    given = [f"{name}={_shown(request[name])}" for name in names if request.get(name) is not None]
    module, _, function = call.partition(" ")
    return (
        f'python -c "from {module} import {function.partition("(")[0]}; '
        f'print({function.replace("...", ", ".join([*place, *given]))})"'
    )


_CALLS = {
    "history": (("start", "travel", "cells"), "microslip history(...).force_forward[-1]"),
    "field": (("cells",), "microslip traction_field(...)"),
    "patches": (
        ("poisson", "cells", "angles", "steps"),
        "microslip.adaptive.stick_area patches(...)['least_stick']",
    ),
    "run": (
        ("poisson", "model", "method", "cells", "angles", "steps", "tolerance"),
        "microslip.adaptive.single_run run_trial(...)['mu_macro']",
    ),
}
"""Names of the arguments in a request, and the function that takes them, by kind."""


def _shown(value: str | float) -> str:
    """Numbers, which requests hold as text, as they are; other text in quotes."""
    try:
        float(value)
    except ValueError:
        return repr(value)
    return str(value)


def made_by(request: dict) -> str:
    """Short description of how a run was computed."""
    kinds = {
        "point": "certified point",
        "history": f"transient from {request.get('start')}",
        "field": "steady tractions",
        "patches": "a period from inside",
        "run": f"single run, method {request.get('method')}",
    }
    limit = request["kind"] == "point" and request["velocity"] == "0"
    return "static limit" if limit else kinds[request["kind"]]
