"""Check the statements of the paper.  The dataset contains the verdicts, the runs that support
them, static limits, and the stick patches of the oscillating bore."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from microslip.studies import evidence, static_limits, verdicts
from microslip.studies.answers import Answers, Row, columns
from microslip.studies.statements import PARTS, STATEMENTS
from microslip.theory import hertz, paper

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from microslip.config.settings import Claims

BOUNDARY = 181
"""Number of points on half the edge of a patch."""

TITLE = "Verdicts on the paper's claims"
COMMENT = (
    "A check decides if its margin is larger than its error. A part holds if no check decides "
    "against it. A statement holds if all of its parts that count hold."
)


def requests(study: Claims) -> Iterator[tuple[tuple, dict]]:
    """Yield each request with the job that computes it."""
    tables = (rows for *_, rows in evidence.sources(study))
    for request in chain.from_iterable(chain.from_iterable(tables)):
        place = request["motion"], request.get("amplitude")
        if request["kind"] == "run":
            yield (0, *place), request
        elif request["kind"] == "point" and request["motion"] == "bore":
            yield (1, *place), request
        else:
            yield (2, request["kind"] == "patches"), request


def values(study: Claims, answers: Answers) -> dict[str, Any]:
    """Return the values of all variables of the dataset."""
    tables = evidence.tables_of(study, answers)
    entries = _verdicts(tables) | static_limits.values(study, tables) | _patches(study, answers)
    runs = [_run(*run) for run in answers.rows.values()]
    return entries | columns("claims", "run", runs)


def report(dataset: xr.Dataset) -> Iterator[str]:
    """Yield a line of text with the verdict on each statement."""
    for claim, verdict in zip(dataset["claim"].values, dataset["verdict"].values, strict=True):
        yield f"claim {claim}: {verdicts.WORDS[int(verdict)]}"


# Statements, parts and checks


def _verdicts(tables: dict[str, pd.DataFrame]) -> dict[str, Any]:
    """Return the variables of the statements, of their parts, and of the checks of the parts.

    tables: tables of evidence, keyed by name.
    """
    parts: list[Row] = []
    checks: list[Row] = []
    for part in PARTS:
        own = part.checks(tables)
        parts.append(part._asdict() | verdicts.of_checks(own))
        checks += own.assign(part=part.part).to_dict("records")
    entries = columns("claims", "part", parts) | columns("claims", "check", checks)
    counting = [part for part in parts if part["counts"]]
    of_claims = [[p["part_verdict"] for p in counting if p["claim"] == one] for one in STATEMENTS]
    return entries | {
        "claim": list(STATEMENTS),
        "statement": list(STATEMENTS.values()),
        "verdict": list(map(verdicts.of_claim, of_claims)),
    }


# Runs


def _run(request: dict, row: Row) -> dict[str, Any]:
    """Return a row of the table of runs."""
    error = evidence.friction(row)[1]
    on_rings = "polar" if request["kind"] in ("history", "field", "patches") else ""
    forces = row.get("force_forward")
    own = {
        "motion": request["motion"],
        "run_what": _description(request),
        "run_model": row.get("model") or on_rings,
        "run_mu_macro": forces[-1] if forces else row.get("mu_macro"),
        "run_error": error if np.isfinite(error) else np.nan,
        "run_converged": row.get("converged", True),
        "run_command": command(request),
    }
    return {"poisson": 0.0} | row | own


SINGLE_RUNS = {
    "history": ("transient from {start}", "['force_forward'][-1]"),
    "field": ("steady tractions", ""),
    "patches": ("tractions over a period", "['least_stick']"),
    "run": ("single run, method {method}", "['mu_macro']"),
}
"""For each kind of single run: a short description, and the part of the result that is printed when
a command repeats the run."""


def _description(request: dict) -> str:
    """Return a short description of how a run was computed."""
    if request["kind"] == "point":
        return "static limit" if request["velocity"] == "0" else "certified point"
    return SINGLE_RUNS[request["kind"]][0].format(**request)


def command(request: dict) -> str:
    """Return a shell command that repeats the computation of a request."""
    kind = request["kind"]
    if kind != "point":
        shown = f"computed({request}){SINGLE_RUNS[kind][1]}"
        return f'python -c "from microslip.sweeps.evaluate import computed; print({shown})"'
    names = ["velocity", "amplitude", "poisson", "pressure", "model", "tolerance", "cells", "steps"]
    usual = {"poisson": "0", "pressure": "hertz", "model": "auto"}
    options = {name: request.get(name) for name in names}
    words = (f"--{n} {v}" for n, v in options.items() if v not in (None, usual.get(n)))
    return f"microslip point {request['motion']} {' '.join(words)}"


# Patches of the oscillating bore


def _patches(study: Claims, answers: Answers) -> dict:
    """Return the stick patches and their edges at the smallest velocity and at the amplitude
    closest to 1."""
    rows = [answers(fine) for fine, _ in evidence.periods(study)]
    slowest = min(float(row["velocity"]) for row in rows)
    rows = [r for r in rows if float(r["velocity"]) == slowest and r.get("converged")]
    if not rows:
        return {}
    row = min(rows, key=lambda row: abs(np.log(float(row["amplitude"]))))
    amplitude = float(row["amplitude"])
    moments = np.asarray(row["moment_phase"], float)
    right, left = (np.asarray(row[f"stick_{side}"], float) for side in ("right", "left"))
    return {
        "patch_velocity": slowest,
        "patch_amplitude": amplitude,
        "patch_stick_right": right,
        "patch_stick_left": left,
        "patch_stick": right + left,
        "patch_phase": row["phase"],
        "patch_lateral": row["lateral_position"],
        "patch_forward": row["forward_position"],
        "patch_moment_phase": moments,
        "patch_share": row["moment_share"],
        **_edges(amplitude, moments),
    }


def _edges(amplitude: float, moments: np.ndarray) -> dict:
    """Return the theoretical edges of the stick zone in the limit v -> 0.  The edges are computed
    at the same moments as the patches.

    The moments are the same as in stick_area.patches.  Next to a turning point, the stick zone is a
    leaf-shaped region on one side of the contact, where |cos angle| >= tau/g.  A point inside the
    leaf slips only at the other turning point.  In mid-stroke, the stick zone is a circle, whose
    radius depends on the rotation since the last turning point.
    """
    c = paper.bore_stick_radius(amplitude)
    radius = c * np.linspace(0.0, 1.0, BOUNDARY)
    angle = np.arccos(np.clip(hertz.lubkin_share(radius, c), 0.0, 1.0))
    radius, angle = np.append(radius, radius[::-1]), np.append(angle, -angle[::-1])
    leaf = np.stack([radius * np.cos(angle), radius * np.sin(angle)])
    turn = np.linspace(0.0, 2.0 * np.pi, radius.size)
    edges = []
    for k, phase in enumerate(moments):
        back = k >= len(moments) // 2
        swing = 0.5 * (1.0 + (-np.sin(phase) if back else np.sin(phase)))
        circle = paper.bore_stick_radius(amplitude * swing)
        side = np.array([[1.0 if back else -1.0], [1.0]])
        edges.append(circle * np.stack([np.cos(turn), np.sin(turn)]) if k % 2 else side * leaf)
    lateral, forward = np.array(edges).transpose(1, 0, 2)
    return {"patch_edge_lateral": lateral, "patch_edge_forward": forward}
