"""Study of the failures of methods, in which all methods are tested in the same cases.

Each block of the configuration starts at a base point and varies one quantity, up to values at
which methods fail.  This quantity can belong to the point, the resolution or a method.  Each value
of the quantity is a case.  All probes have the same tolerance.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from microslip.foundation.canonical import number as text_of_number
from microslip.periodic.methods import SHIPPED, declared, method_named, split
from microslip.studies import requests as forms
from microslip.studies.answers import Answers, Row, columns, number
from microslip.studies.requests import Point

if TYPE_CHECKING:
    import xarray as xr

    from microslip.config.settings import Block, Stability

TRUTH_SHARE = 0.1
"""Tolerance of the references, divided by the tolerance of the probes."""
MOST_WORK = 5_000_000
"""Work budget of a probe: number of step solves times number of unknowns.  The budget is several
times the work that the shipped method needs."""
BLOCKS_PER_JOB = 5
"""Number of blocks in one job."""
UNSOLVED = "a step was left unsolved"
"""First words of `reason` if the step solver reached its iteration limit with a small residual."""
OUTCOMES = ("not_applicable", "converged", "slow", "wrong", "diverged")
NOT_APPLICABLE, CONVERGED, SLOW, WRONG, DIVERGED = range(len(OUTCOMES))

TITLE = "Where methods for the friction of a vibrated Hertz contact fail"
COMMENT = "The outcome of a method is judged by the distance from the reference of the case."


# Requests


def cases(study: Stability) -> list[tuple[str, Block, float]]:
    """Return the tuple (name of the block, block, value) of each case, in the order of the
    dataset."""
    return [(name, block, v) for name, block in study.axes.items() for v in block.values]


def _place(block: Block, value: float) -> tuple[Point, dict[str, Any]]:
    """Return the point of a case, and the resolution that the case imposes."""
    names = ("velocity", "amplitude", "poisson", "cells", "steps")
    first = {name: values[0] for name in names if (values := getattr(block, name))}
    at = first | {block.quantity: value}
    point = Point(block.motion, *(at[name] for name in names[:3]))
    return point, {name: at.get(name) for name in names[3:]}


def probe(study: Stability, method: str, block: Block, value: float) -> dict | None:
    """Return the request that runs a method in a case, or None if the block does not apply to the
    method.

    A block that varies `step` applies to methods with this parameter and, for comparison, to the
    shipped method.
    """
    if block.quantity == "step" and method != SHIPPED:
        name, numbers = split(method)
        if "step" not in (declared(name, "parameters") or ()):
            return None
        words = (f"{k}={text_of_number(n)}" for k, n in (numbers | {"step": value}).items())
        method = f"{name}:{','.join(words)}"
    point, sizes = _place(block, value)
    how = {"model": "auto", "method": method, "tolerance": study.tolerance, "most_work": MOST_WORK}
    return forms.of("probe", point, **how, **sizes)


def reference(study: Stability, block: Block, value: float) -> dict:
    """Return the request for the reference of a case, which is computed with the shipped method and
    without an imposed resolution."""
    return forms.solve(_place(block, value)[0], TRUTH_SHARE * study.tolerance)


def requests(study: Stability) -> Iterator[tuple[tuple, dict]]:
    """Yield each request with its job.  Every method has separate jobs."""
    for name, block, value in cases(study):
        yield (0, name), reference(study, block, value)
    number_of = {name: index for index, name in enumerate(study.axes)}
    for method in study.methods:
        for name, block, value in cases(study):
            if (request := probe(study, method, block, value)) is not None:
                yield (1, method, number_of[name] // BLOCKS_PER_JOB), request


# The dataset


def outcome(
    result: Row | None, reference: float, reference_error: float, imposed: bool = False
) -> int:
    """Return the outcome of a probe as an index into OUTCOMES.

    - not applicable: the method was not run.
    - converged: the run converged, and its result differs from the reference by at most the sum of
      the two error estimates.
    - wrong: the run converged to a result that differs by more.
    - slow: the run did not converge within its budget and reports this.
    - diverged: the run diverged or did not return a finite number.

    Parameters
    ----------
    result : dict or None
        Result of the probe.  If the method was not run, it is None or its entry `applies` is False.
    reference, reference_error : float
        Reference value and its error estimate, both dimensionless.
    imposed : bool
        True if the resolution was imposed.  An imposed resolution can be too coarse for the
        tolerance, so every run with a periodic state counts as converged.
    """
    if result is None or not result.get("applies", True):
        return NOT_APPLICABLE
    mu, error = number(result, "mu_macro"), number(result, "mu_macro_error")
    reason = result.get("reason") or ""
    if reason.startswith("diverged"):
        return DIVERGED
    if result.get("exhausted"):
        return SLOW
    if not np.isfinite(mu) and not reason.startswith(UNSOLVED):
        return DIVERGED
    if not result.get("periodic" if imposed else "converged"):
        return SLOW
    return CONVERGED if abs(mu - reference) <= error + reference_error else WRONG


def values(study: Stability, answers: Answers) -> dict[str, Any]:
    """Return the values of all variables of the dataset."""
    every, blocks = cases(study), study.axes
    rows: list[Row] = []
    for name, block, value in every:
        own = {"case_axis": name, "case_value": value, "case_label": f"{value:g}"}
        rows.append(answers(reference(study, block, value)) | own)
    probes: list[Row] = []
    for method in study.methods:
        for (_, block, value), row in zip(every, rows, strict=True):
            request = probe(study, method, block, value)
            result = {"applies": False} if request is None else answers(request)
            mu, error = number(row, "mu_macro"), number(row, "mu_macro_error")
            code = outcome(result, mu, error, bool(block.cells or block.steps))
            off = abs(number(result, "mu_macro") - mu)
            probes.append(result | {"outcome": code, "error": off})
    results = columns("stability", "method case", probes, len(study.methods), len(every))
    return (
        columns("stability", "case", rows)
        | results
        | {
            "method": study.methods,
            "method_summary": [method_named(method).summary for method in study.methods],
            "axis": list(blocks),
            "axis_label": [block.title or block.quantity for block in blocks.values()],
            "axis_note": [block.note for block in blocks.values()],
        }
    )


def report(dataset: xr.Dataset) -> Iterator[str]:
    """Yield a line of text for each method with the number of cases for each outcome."""
    for method, row in zip(dataset["method"].values, dataset["outcome"].values, strict=True):
        counts = ((OUTCOMES[i], int((row == i).sum())) for i in range(1, len(OUTCOMES)))
        yield f"{method}: " + ", ".join(f"{count} {name}" for name, count in counts)
