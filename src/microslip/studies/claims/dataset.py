"""The dataset claims: verdicts, the checks and runs behind them, the static limit, and patches."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator

import numpy as np
import xarray as xr

from microslip.config.settings import Claims
from microslip.datasets.variables import flags, variable
from microslip.studies.claims import claims as asked
from microslip.studies.claims import static_limits, verdicts
from microslip.studies.claims.parts import PARTS
from microslip.studies.claims.runs import Run, Runs, command, friction, made_by, resolution
from microslip.studies.claims.statements import STATEMENTS
from microslip.studies.claims.verdicts import Check
from microslip.studies.tables import columns, finished, value_of
from microslip.theory import hertz, paper

ABOUT = (
    "A check decides if its margin is larger than its error. A part holds if nothing decides "
    "against it; a statement, if all of its parts that count do."
)
GROUPS = {
    "parts": ("What of a statement is asked by itself", ("part",)),
    "checks": ("Comparisons that decide", ("check",)),
    "runs": ("Results behind the checks", ("run",)),
    "patch_period": ("Share that sticks over a period of the oscillating bore", ("patch_step",)),
    "patches": ("What sticks where, at moments of that period", ("patch_moment", "patch_point")),
    "patch_edges": ("Theory's edges of what sticks", ("patch_moment", "patch_edge")),
}
for _motion in static_limits.FORMULAS:
    GROUPS |= {
        f"{_motion}_static": (f"Static limit, motion {_motion}", (f"{_motion}_amplitude",)),
        f"{_motion}_curves": (
            f"Static limit on a fine axis, motion {_motion}",
            (f"{_motion}_curve_amplitude",),
        ),
        f"{_motion}_shares": (
            f"Shares of the friction bound, motion {_motion}",
            (f"{_motion}_share_amplitude", "share_radius"),
        ),
    }
"""Groups of the dataset besides the statements: titles and dims by the name of a group."""
BOUNDARY = 181
"""Angles at which the edge of the alternating patches is given."""


def build(settings: Claims, answer: Callable) -> xr.Dataset:
    """Assemble the Dataset.

    answer(request) -> record, such as batches.answer with a store.
    """
    runs = Runs(answer)
    found = {part.name: list(part.checks(settings, runs)) for part in PARTS}
    variables = _claims(found) | _parts(found) | _checks(found)
    variables |= static_limits.variables(settings, runs) | _patches(settings, runs)
    variables |= _runs(runs.found.values())
    coordinates = {
        name for name, (dims, *_) in variables.items() if dims == name and isinstance(dims, str)
    }
    coords = {name: variables.pop(name) for name in sorted(coordinates)}
    title = "The statements of the paper, judged"
    return finished(variables, coords, title, runs, settings, comment=ABOUT)


def report(dataset: xr.Dataset) -> Iterator[str]:
    """Lines of text: what became of every statement."""
    for claim, verdict in zip(dataset["claim"].values, dataset["verdict"].values, strict=True):
        yield f"claim {claim}: {verdicts.WORDS[int(verdict)]}"


# Statements, parts and checks


def verdict_on(claim: int, checks: dict[str, list[Check]]) -> int:
    """Verdict on a statement, an index of VERDICTS; checks: list of Check by name of the part."""
    parts = [part for part in PARTS if part.claim == claim and part.counts]
    return verdicts.of_claim([verdicts.of_part(checks[part.name]) for part in parts])


def _claims(checks: dict[str, list[Check]]) -> dict:
    numbers = list(STATEMENTS)
    return {
        "claim": variable("claim", numbers, "number of the statement", np.int32),
        "statement": variable("claim", list(STATEMENTS.values()), "what the paper says", str),
        "verdict": flags(
            "claim",
            [verdict_on(number, checks) for number in numbers],
            "what the runs say about the statement",
            verdicts.VERDICTS,
        ),
    }


def _parts(checks: dict[str, list[Check]]) -> dict:
    rows = [checks[part.name] for part in PARTS]
    shows = [_shows(row) for row in rows]
    found: dict[str, tuple] = {
        "part": ([part.name for part in PARTS], "part of a statement", str),
        "part_claim": ([part.claim for part in PARTS], "statement that it is part of", np.int32),
        "part_text": ([part.text for part in PARTS], "what is asked, with its criterion", str),
        "part_counts": ([part.counts for part in PARTS], "the verdict depends on it", bool),
        "part_where": (list(map(verdicts.where, rows)), "where it holds and where not", str),
        "part_shown_by": (
            [check.runs[0] if check else "" for check in shows],
            "name of the result that shows it best",
            str,
        ),
    }
    for name, outcome in zip(verdicts.OUTCOMES, range(3), strict=True):
        counts = [sum(check.outcome == outcome for check in row) for row in rows]
        found[f"part_{name}"] = (counts, f"number of checks: {name}", np.int32)
    values = [verdicts.of_part(row) for row in rows]
    verdict = flags("part", values, "what the checks say", verdicts.VERDICTS)
    return columns("part", found) | {"part_verdict": verdict}


def _shows(row: list[Check]) -> Check | None:
    """The check that a part stands or falls with: against it the clearest, for it the closest."""
    return verdicts.decisive(row, verdicts.FAILS) or verdicts.tightest(row)


def _checks(checks: dict[str, list[Check]]) -> dict:
    rows = [(part.name, check) for part in PARTS for check in checks[part.name]]
    places = [dict(check.place) for _, check in rows]
    numbers = {
        "value": "computed",
        "against": "what it is compared with",
        "margin": "positive where the part holds",
        "error": "error of the margin",
    }
    found: dict[str, tuple] = {
        "check_part": ([name for name, _ in rows], "part that it belongs to", str),
        "check_run": ([c.runs[0] for _, c in rows], "name of the result that it is about", str),
        "check_other_run": (
            [c.runs[1] if c.runs[1:] else "" for _, c in rows],
            "name of a second result behind it",
            str,
        ),
    }
    for name in ("amplitude", "velocity"):
        values = [place.get(name, np.nan) for place in places]
        found[f"check_{name}"] = (values, f"{name} of the check", float)
    for name, long_name in numbers.items():
        found[f"check_{name}"] = ([getattr(check, name) for _, check in rows], long_name)
    outcomes = [check.outcome for _, check in rows]
    outcome = flags("check", outcomes, "what it says", verdicts.OUTCOMES)
    return columns("check", found) | {"check_outcome": outcome}


# Runs, and the patches of the oscillating bore


def _runs(found: Collection[Run]) -> dict:
    requests = [run.request for run in found]
    certified = [friction(run) for run in found]
    sizes = [resolution(run) for run in found]

    def texts(name: str) -> list[str]:
        return [str(request.get(name) or "") for request in requests]

    def numbers(name: str) -> list[float]:
        return [float(request.get(name) or np.nan) for request in requests]

    table = {
        "run": ([run.key for run in found], "name of the result in the store", str),
        "run_what": (list(map(made_by, requests)), "what was run", str),
        "run_motion": (texts("motion"), "what moves", str),
        "run_velocity": ([float(r["velocity"]) for r in requests], "forward velocity", float),
        "run_amplitude": (numbers("amplitude"), "amplitude", float),
        "run_poisson": ([float(r.get("poisson", 0)) for r in requests], "Poisson's ratio", float),
        "run_model": ([_model(run) for run in found], "contact model that was used", str),
        "run_cells": ([s[0] for s in sizes], "rings, or squares across", np.int32),
        "run_angles": ([s[1] for s in sizes], "angular points on half a ring", np.int32),
        "run_steps": ([s[2] for s in sizes], "time steps in a period", np.int32),
        "run_tolerance": (numbers("tolerance"), "tolerance that was asked for", float),
        "run_mu_macro": ([_force(run) for run in found], "mu_macro, where it has one", float),
        "run_error": (
            [error if np.isfinite(error) else np.nan for _, error in certified],
            "error of mu_macro that it claims",
            float,
        ),
        "run_converged": (
            [bool(run.result.get("converged", True)) for run in found],
            "the run says that it converged",
            bool,
        ),
        "run_command": (list(map(command, requests)), "line that computes it again", str),
    }
    return columns("run", table)


def _model(run: Run) -> str:
    polar = run.request["kind"] in ("history", "field", "patches")
    return value_of(run.result, "model", str) or run.request.get("model") or "polar" * polar


def _force(run: Run) -> float:
    """mu_macro of a run, of a transient the force at its end."""
    forces = run.result.get("force_forward")
    return float(forces[-1]) if forces else value_of(run.result, "mu_macro")


def _patches(settings: Claims, runs: Runs) -> dict:
    """The slowest period seen from inside at the amplitude nearest 1, and theory's edges in it."""
    slowest = min(v for v, _ in asked.periods(settings))
    places = [(v, a) for v, a in asked.periods(settings) if v == slowest]
    found: dict = {}
    for velocity, amplitude in sorted(places, key=lambda place: abs(np.log(place[1]))):
        result = runs(asked.period(settings, velocity, amplitude)).result
        if value_of(result, "converged", bool):
            break
    else:
        return found
    found["patch_velocity"] = variable((), velocity, "velocity of the patches")
    found["patch_amplitude"] = variable((), amplitude, "amplitude of the patches")
    share = "size of the traction over the friction bound, 1 where a point slips"
    sides = {side: np.asarray(result[f"stick_{side}"], float) for side in ("right", "left")}
    for side, values in sides.items():
        long_name = f"share of the contact's area that sticks, {SIDES[side]} lateral positions"
        found[f"patch_stick_{side}"] = variable("patch_step", values, long_name)
    both = sides["right"] + sides["left"]
    found["patch_stick"] = variable("patch_step", both, "share of the contact's area that sticks")
    found["patch_phase"] = variable("patch_step", result["phase"], "phase", units="rad")
    for name in ("lateral", "forward"):
        values = result[f"{name}_position"]
        found[f"patch_{name}"] = variable("patch_point", values, f"{name} position over a")
    moments = np.asarray(result["moment_phase"], float)
    dims = ("patch_moment", "patch_point")
    return found | {
        "patch_moment_phase": variable("patch_moment", moments, "phase of the moment", units="rad"),
        "patch_share": variable(dims, result["moment_share"], share),
        **_edges(amplitude, moments),
    }


SIDES = {"right": "positive", "left": "negative"}


def _edges(amplitude: float, moments: np.ndarray) -> dict:
    """Theory's edges of what sticks as v -> 0, at the moments of stick_area.patches.

    Next to a turning point a point that slips at the other one only still sticks: those of one
    side with |cos angle| >= tau/g. In mid-stroke the inner circle that the way from the last
    turning point has left.
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
            dims, [edge[i] for edge in edges], f"{name} position, {EDGE}"
        )
        for i, name in enumerate(("lateral", "forward"))
    }


EDGE = "edge of what sticks as the velocity vanishes, over a"
