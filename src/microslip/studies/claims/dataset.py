"""Build the dataset claims, with verdicts, checks, runs, static limits, and stick patches."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import xarray as xr

from microslip.config.settings import Claims
from microslip.datasets.variables import flags, variable
from microslip.studies.claims import claims, static_limits, verdicts
from microslip.studies.claims.parts import PARTS
from microslip.studies.claims.runs import Run, Runs, command, friction, made_by, resolution
from microslip.studies.claims.statements import STATEMENTS
from microslip.studies.claims.verdicts import Check
from microslip.studies.tables import finished, table, value_of
from microslip.theory import hertz, paper

ABOUT = (
    "A check decides if its margin is larger than its error. A part holds if no check decides "
    "against it. A statement holds if all of its parts that count hold."
)
GROUPS = {
    "parts": ("Parts of the statements, and their criteria", ("part",)),
    "checks": ("Comparisons of the parts", ("check",)),
    "runs": ("Results behind the checks", ("run",)),
    "patch_period": ("Sticking fraction over a period of the oscillating bore", ("patch_step",)),
    "patches": ("Stick patches at moments of this period", ("patch_moment", "patch_point")),
    "patch_edges": ("Theoretical edges of the patches", ("patch_moment", "patch_edge")),
}
for _motion in static_limits.FORMULAS:
    GROUPS |= {
        f"{_motion}_static": (f"Static limit, motion {_motion}", (f"{_motion}_amplitude",)),
        f"{_motion}_curves": (
            f"Static limit on a fine axis, motion {_motion}",
            (f"{_motion}_curve_amplitude",),
        ),
        f"{_motion}_shares": (
            f"Fractions of the friction bound, motion {_motion}",
            (f"{_motion}_share_amplitude", "share_radius"),
        ),
    }
"""Title and dimensions of each group of the dataset, by name. The statements are the root."""
BOUNDARY = 181
"""Number of points on half the edge of a patch."""


def build(settings: Claims, answer: Callable) -> xr.Dataset:
    """Build the dataset of the study.

    answer: function that returns the record of a request, such as batches.answer with a store.
    """
    runs = Runs(answer)
    checks = {part.name: list(part.checks(settings, runs)) for part in PARTS}
    variables = _claims(checks) | _parts(checks) | _checks(checks)
    variables |= static_limits.variables(settings, runs) | _patches(settings, runs)
    variables |= table("run", ((run,) for run in runs.by_request.values()), RUN_COLUMNS)
    return finished(variables, "Verdicts on the paper's claims", runs, settings, comment=ABOUT)


def report(dataset: xr.Dataset) -> Iterator[str]:
    """Yield lines of text with the verdict on every statement."""
    for claim, verdict in zip(dataset["claim"].values, dataset["verdict"].values, strict=True):
        yield f"claim {claim}: {verdicts.WORDS[int(verdict)]}"


# Statements, parts and checks


def _claims(checks: dict[str, list[Check]]) -> dict:
    """Return the variables of the statements and verdicts.

    checks: a list of Check for each part, by name.
    """
    numbers = list(STATEMENTS)
    parts = {n: [part.name for part in PARTS if part.claim == n and part.counts] for n in numbers}
    judged = [
        verdicts.of_claim([verdicts.of_part(checks[name]) for name in names])
        for names in parts.values()
    ]
    return {
        "claim": variable("claim", numbers, "number of the statement", np.int32),
        "statement": variable("claim", list(STATEMENTS.values()), "statement of the paper", str),
        "verdict": flags("claim", judged, "verdict on the statement", verdicts.VERDICTS),
    }


PART_COLUMNS: dict[str, tuple] = {
    "part": (lambda part, _: part.name, "part of a statement", str),
    "part_claim": (lambda part, _: part.claim, "number of the statement", np.int32),
    "part_text": (lambda part, _: part.text, "criterion of the part", str),
    "part_counts": (lambda part, _: part.counts, "the verdict depends on the part", bool),
    "part_where": (lambda _, row: verdicts.where(row), "where the part holds and where not", str),
    "part_shown_by": (
        lambda _, row: _shown_by(row),
        "name of the result that decides the part",
        str,
    ),
}
CHECK_COLUMNS: dict[str, tuple] = {
    "check_part": (lambda part, _: part.name, "part of the check", str),
    "check_run": (lambda _, check: check.runs[0], "name of the first result of the check", str),
    "check_other_run": (
        lambda _, check: "".join(check.runs[1:2]),
        "name of the second result of the check",
        str,
    ),
    "check_amplitude": (lambda _, check: _place(check, "amplitude"), "amplitude of the check"),
    "check_velocity": (lambda _, check: _place(check, "velocity"), "velocity of the check"),
    "check_value": (lambda _, check: check.value, "computed value"),
    "check_against": (lambda _, check: check.against, "reference that the value is compared with"),
    "check_margin": (lambda _, check: check.margin, "positive where the part holds"),
    "check_error": (lambda _, check: check.error, "error of the margin"),
}
"""Columns of the table of checks: (function of a part and a check, long_name, type).

In PART_COLUMNS, the arguments of the function are a part and all its checks.
"""


def _parts(checks: dict[str, list[Check]]) -> dict:
    rows = [checks[part.name] for part in PARTS]
    entries = table("part", zip(PARTS, rows, strict=True), PART_COLUMNS)
    for outcome, name in enumerate(verdicts.OUTCOMES):
        counts = [sum(check.outcome == outcome for check in row) for row in rows]
        entries[f"part_{name}"] = variable("part", counts, f"number of checks: {name}", np.int32)
    values = [verdicts.of_part(row) for row in rows]
    return entries | {
        "part_verdict": flags("part", values, "verdict on the part", verdicts.VERDICTS)
    }


def _shown_by(row: list[Check]) -> str:
    """Return the name of the run that shows the verdict on a part.

    The run belongs to the check that fails most clearly or, if no check fails, to the check that
    holds most narrowly.
    """
    check = verdicts.decisive(row, verdicts.FAILS) or verdicts.tightest(row)
    return check.runs[0] if check else ""


def _place(check: Check, name: str) -> float:
    return dict(check.place).get(name, np.nan)


def _checks(checks: dict[str, list[Check]]) -> dict:
    rows = [(part, check) for part in PARTS for check in checks[part.name]]
    outcomes = [check.outcome for _, check in rows]
    outcome = flags("check", outcomes, "outcome of the check", verdicts.OUTCOMES)
    return table("check", rows, CHECK_COLUMNS) | {"check_outcome": outcome}


# Runs, and the patches of the oscillating bore


def _number(name: str) -> Callable[[Run], float]:
    return lambda run: float(run.request.get(name) or np.nan)


def _error(run: Run) -> float:
    error = friction(run)[1]
    return error if np.isfinite(error) else np.nan


def _model(run: Run) -> str:
    polar = run.request["kind"] in ("history", "field", "patches")
    return value_of(run.result, "model", str) or run.request.get("model") or "polar" * polar


def _force(run: Run) -> float:
    """Return mu_macro of a run, or the force at the end of a transient."""
    forces = run.result.get("force_forward")
    return float(forces[-1]) if forces else value_of(run.result, "mu_macro")


RUN_COLUMNS: dict[str, tuple] = {
    "run": (lambda run: run.key, "name of the result in the store", str),
    "run_what": (lambda run: made_by(run.request), "kind of the run", str),
    "run_motion": (lambda run: run.request.get("motion") or "", "motion", str),
    "run_velocity": (lambda run: float(run.request["velocity"]), "forward velocity"),
    "run_amplitude": (_number("amplitude"), "amplitude"),
    "run_poisson": (lambda run: float(run.request.get("poisson", 0)), "Poisson's ratio"),
    "run_model": (_model, "contact model of the run", str),
    "run_cells": (lambda run: resolution(run)[0], "rings, or squares across", np.int32),
    "run_angles": (lambda run: resolution(run)[1], "angular points on half a ring", np.int32),
    "run_steps": (lambda run: resolution(run)[2], "time steps in a period", np.int32),
    "run_tolerance": (_number("tolerance"), "requested tolerance"),
    "run_mu_macro": (_force, "mu_macro, where the run has one"),
    "run_error": (_error, "error estimate of mu_macro"),
    "run_converged": (
        lambda run: run.result.get("converged", True),
        "the run converged",
        bool,
    ),
    "run_command": (
        lambda run: command(run.request),
        "command that computes the result again",
        str,
    ),
}
"""Columns of the table of runs: (function of the run, long_name, type)."""


def _patches(settings: Claims, runs: Runs) -> dict:
    """Return the stick patches and edges at the smallest velocity and the amplitude nearest 1."""
    slowest = min(v for v, _ in claims.periods(settings))
    places = [(v, a) for v, a in claims.periods(settings) if v == slowest]
    for velocity, amplitude in sorted(places, key=lambda place: abs(np.log(place[1]))):
        result = runs(claims.period(settings, velocity, amplitude)).result
        if value_of(result, "converged", bool):
            break
    else:
        return {}
    entries = {
        "patch_velocity": variable((), velocity, "velocity of the patches"),
        "patch_amplitude": variable((), amplitude, "amplitude of the patches"),
    }
    share = "size of the traction divided by the friction bound, 1 where a point slips"
    sides = {side: np.asarray(result[f"stick_{side}"], float) for side in ("right", "left")}
    for side, values in sides.items():
        long_name = f"sticking fraction of the contact area, {SIDES[side]} lateral positions"
        entries[f"patch_stick_{side}"] = variable("patch_step", values, long_name)
    both = sides["right"] + sides["left"]
    entries["patch_stick"] = variable("patch_step", both, "sticking fraction of the contact area")
    entries["patch_phase"] = variable("patch_step", result["phase"], "phase", units="rad")
    for name in ("lateral", "forward"):
        values = result[f"{name}_position"]
        entries[f"patch_{name}"] = variable("patch_point", values, f"{name} position divided by a")
    moments = np.asarray(result["moment_phase"], float)
    dims = ("patch_moment", "patch_point")
    return entries | {
        "patch_moment_phase": variable("patch_moment", moments, "phase of the moment", units="rad"),
        "patch_share": variable(dims, result["moment_share"], share),
        **_edges(amplitude, moments),
    }


SIDES = {"right": "positive", "left": "negative"}


def _edges(amplitude: float, moments: np.ndarray) -> dict:
    """Return the theoretical edges of the stick zone for v -> 0 at the moments of the patches.

    The moments are those of stick_area.patches. Next to a turning point, the stick zone is a leaf
    on one side of the contact, where |cos angle| >= tau/g. A point inside the leaf slips only at
    the other turning point. In mid-stroke, the stick zone is a circle. Its radius depends on the
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
    dims = ("patch_moment", "patch_edge")
    return {
        f"patch_edge_{name}": variable(
            dims, [edge[i] for edge in edges], f"{name} position of the edge, divided by a"
        )
        for i, name in enumerate(("lateral", "forward"))
    }
