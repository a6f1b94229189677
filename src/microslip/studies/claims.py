"""Check of the paper: verdicts on its statements, the runs behind them, static limits, and the
stick patches of the oscillating bore."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from microslip.studies import evidence, static_limits, verdicts
from microslip.studies.answers import Answers, Row, number
from microslip.studies.evidence import COLUMNS
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
    """Yield each request with its job."""
    tables = (rows for rows, _ in evidence.sources(study).values())
    for request in chain.from_iterable(chain.from_iterable(tables)):
        place = request["motion"], request.get("amplitude")
        if request["kind"] == "run":
            yield (0, *place), request
        elif request["kind"] == "point" and request["motion"] == "bore":
            yield (1, *place), request
        else:
            yield (2, request["kind"] == "patches"), request


def values(study: Claims, answers: Answers) -> dict[str, Any]:
    """Return the values of the variables."""
    import pandas as pd

    tables = evidence.tables_of(study, answers)
    checks = pd.concat({name: part.checks(tables) for name, part in PARTS.items()}, names=["part"])
    entries = _verdicts(checks) | static_limits.values(study, tables)
    entries |= _patches(study, answers)
    runs = pd.DataFrame([_run(*run) for run in answers.rows.values()])
    return entries | dict(runs)


def report(dataset: xr.Dataset) -> Iterator[str]:
    """Yield lines of text with the verdict on every statement."""
    for claim, verdict in zip(dataset["claim"].values, dataset["verdict"].values, strict=True):
        yield f"claim {claim}: {verdicts.WORDS[int(verdict)]}"


# Statements, parts and checks


def _verdicts(checks: pd.DataFrame) -> dict[str, Any]:
    """Return the statements, their parts, and the checks of the parts.

    checks: checks of all parts, with the name of the part as the first level of the index.
    """
    parts: list[Row] = []
    for name, part in PARTS.items():
        own = checks[checks.index.get_level_values("part") == name]
        parts.append(
            {
                "part": name,
                "part_claim": part.claim,
                "part_text": part.text,
                "part_counts": part.counts,
                "part_where": verdicts.where(own),
                "part_shown_by": verdicts.shown_by(own),
                "part_verdict": verdicts.of_part(own["outcome"]),
            }
        )
        for code, word in enumerate(verdicts.OUTCOMES):
            parts[-1][f"part_{word}"] = int((own["outcome"] == code).sum())
    of_claims = [
        [p["part_verdict"] for p in parts if p["part_claim"] == claim and p["part_counts"]]
        for claim in STATEMENTS
    ]
    return {
        "claim": list(STATEMENTS),
        "statement": list(STATEMENTS.values()),
        "verdict": [verdicts.of_claim(codes) for codes in of_claims],
        **{name: [part[name] for part in parts] for name in parts[0]},
        "check_part": checks.index.get_level_values("part"),
        **{f"check_{name}": checks[name] for name in (*COLUMNS, "against", "margin", "outcome")},
    }


# Runs


def _run(request: dict, row: Row) -> dict[str, Any]:
    """Return a row of the table of runs."""
    error = evidence.friction(row)[1]
    on_rings = "polar" if request["kind"] in ("history", "field", "patches") else ""
    forces = row.get("force_forward")
    return {
        "run": row["key"],
        "run_what": _description(request),
        "run_motion": request["motion"],
        "run_velocity": float(request["velocity"]),
        "run_amplitude": number(request, "amplitude"),
        "run_poisson": float(request.get("poisson", 0)),
        "run_model": row.get("model") or request.get("model") or on_rings,
        "run_cells": row.get("cells") or 0,
        "run_angles": row.get("angles") or 0,
        "run_steps": row.get("steps_per_period") or row.get("steps") or 0,
        "run_tolerance": number(request, "tolerance"),
        "run_mu_macro": float(forces[-1]) if forces else number(row, "mu_macro"),
        "run_error": error if np.isfinite(error) else np.nan,
        "run_converged": row.get("converged", True),
        "run_command": command(request),
    }


def _description(request: dict) -> str:
    """Return a short description of how a run was computed."""
    kinds = {
        "point": "static limit" if request["velocity"] == "0" else "certified point",
        "history": f"transient from {request.get('start')}",
        "field": "steady tractions",
        "patches": "tractions over a period",
        "run": f"single run, method {request.get('method')}",
    }
    return kinds[request["kind"]]


SHOWN = {
    "history": "['force_forward'][-1]",
    "field": "",
    "patches": "['least_stick']",
    "run": "['mu_macro']",
}
"""Part of the result that the command of a run prints, by the kind of the request."""


def command(request: dict) -> str:
    """Return a shell command that repeats the computation of a request."""
    kind = request["kind"]
    if kind != "point":
        shown = f"computed({request}){SHOWN[kind]}"
        return f'python -c "from microslip.sweeps.evaluate import computed; print({shown})"'
    defaults = {"amplitude": None, "poisson": "0", "pressure": "hertz", "model": "auto"}
    defaults |= {"tolerance": None, "cells": None, "steps": None}
    options = {"velocity": request["velocity"]} | {
        name: value
        for name, usual in defaults.items()
        if (value := request.get(name, usual)) not in (None, usual)
    }
    words = (f"--{name} {value}" for name, value in options.items())
    return f"microslip point {request['motion']} {' '.join(words)}"


# Patches of the oscillating bore


def _patches(study: Claims, answers: Answers) -> dict:
    """Return the stick patches and edges at the smallest velocity and the amplitude nearest 1."""
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
    """Return the theoretical edges of the stick zone for v -> 0 at the moments of the patches.

    stick_area.patches returns the moments.  Next to a turning point, the stick zone is a leaf on
    one side of the contact, where |cos angle| >= tau/g.  A point inside the leaf slips only at the
    other turning point.  In mid-stroke, the stick zone is a circle.  Its radius depends on the
    rotation since the last turning point.
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
