"""Build the dataset stability, with the outcome of every method in every case."""

from collections.abc import Callable, Iterator

import numpy as np
import xarray as xr

from microslip.config.quantities import MU_MACRO
from microslip.config.settings import Stability
from microslip.datasets.variables import flags, variable
from microslip.solver import method_names
from microslip.studies.stability import stability as study
from microslip.studies.tables import Answers, finished, table, value_of

OUTCOMES = ("not_applicable", "converged", "slow", "wrong", "diverged")
NOT_APPLICABLE, CONVERGED, SLOW, WRONG, DIVERGED = range(len(OUTCOMES))

GROUPS = {"axes": ("Quantities that are varied in the blocks of cases", ("axis",))}
"""Groups of the dataset. The table of methods and cases is the root group."""

RESULT_COLUMNS: dict[str, tuple] = {
    "mu_macro": ("mu_macro", MU_MACRO.description, float),
    "claimed_error": ("mu_macro_error", "error estimate of mu_macro", float),
    "work": ("work", "step solves times unknowns, summed over all runs", float),
    "reason": ("reason", "reason of the method for giving up, else empty", str),
}
"""Variables for each method and case: (name in a result, long_name, type)."""
CASE_COLUMNS: dict[str, tuple] = {
    "case_axis": (lambda axis, *_: axis.name, "block of the case", str),
    "case_value": (lambda _, value, __: value, "value of the varied quantity"),
    "case_label": (lambda _, value, __: f"{value:g}", "the value as text", str),
}
AXIS_COLUMNS: dict[str, tuple] = {
    "axis": (lambda axis: axis.name, "block of cases", str),
    "axis_label": (lambda axis: axis.label, "varied quantity", str),
    "axis_note": (lambda axis: axis.note, "values of the fixed quantities", str),
}

UNSOLVED = "a step was left unsolved"
"""First words of `reason` if a run reached the iteration limit close to the solution of a step."""


def outcome(
    result: dict | None, reference: float, reference_error: float, imposed: bool = False
) -> int:
    """Return the outcome of a probe, an index into OUTCOMES.

    A probe is not applicable if the method was not run. It is converged if the run converged and
    differs from the reference by at most the sum of the two error estimates. It is wrong if the run
    converged, but differs by more. It is slow if the run used up its budget and reports this. It is
    diverged if the run diverged or returned no number.

    Parameters
    ----------
    result : dict or None
        Result of the probe. If the method was not run, it is None or its entry `applies` is False.
    reference, reference_error : float
        Reference and its error estimate, dimensionless.
    imposed : bool
        True if the resolution was imposed. An imposed resolution can be too coarse for the
        tolerance, so every run with a periodic state counts as converged.
    """
    if result is None or not result.get("applies", True):
        return NOT_APPLICABLE
    mu, error = value_of(result, "mu_macro"), value_of(result, "mu_macro_error")
    reason = value_of(result, "reason", str)
    if reason.startswith("diverged"):
        return DIVERGED
    if value_of(result, "exhausted", str):
        return SLOW
    if not np.isfinite(mu) and not reason.startswith(UNSOLVED):
        return DIVERGED
    if not value_of(result, "periodic" if imposed else "converged", bool):
        return SLOW
    return CONVERGED if abs(mu - reference) <= error + reference_error else WRONG


def build(settings: Stability, answer: Callable) -> xr.Dataset:
    """Build the dataset of the study.

    answer: function that returns the record of a request, such as batches.answer with a store.
    """
    answers = Answers(answer)
    cases = study.cases(settings)
    truths = [answers(study.reference(settings, overrides)) for _, _, overrides in cases]
    reference = np.array([value_of(truth, "mu_macro") for truth in truths])
    reference_error = np.array([value_of(truth, "mu_macro_error") for truth in truths])
    imposed = [bool({"cells", "steps"} & overrides.keys()) for _, _, overrides in cases]
    probes = [
        [study.probe(settings, method, *case) for case in cases] for method in settings.methods
    ]
    results = [[request and answers(request) for request in row] for row in probes]
    outcomes = [
        [outcome(*four) for four in zip(row, reference, reference_error, imposed, strict=True)]
        for row in results
    ]
    both = ("method", "case")
    variables = {"outcome": flags(both, outcomes, "outcome of the method", OUTCOMES)}
    for name, (key, long_name, kind) in RESULT_COLUMNS.items():
        values = [[value_of(result or {}, key, kind) for result in row] for row in results]
        variables[name] = variable(both, values, long_name, kind)
    away = np.abs(variables["mu_macro"][1] - reference)
    variables["error"] = variable(both, away, "distance of mu_macro from the reference")
    summaries = [method_names.method_named(method).summary for method in settings.methods]
    variables |= {
        "method": variable("method", list(settings.methods), "name of the method", str),
        "method_summary": variable("method", summaries, "description of the method", str),
        "reference": variable("case", reference, "mu_macro that probes are compared with"),
        "reference_error": variable("case", reference_error, "error estimate of the reference"),
    }
    variables |= table("axis", ((axis,) for axis in study.axes(settings)), AXIS_COLUMNS)
    variables |= table("case", cases, CASE_COLUMNS)
    title = "Where methods for the friction of a vibrated Hertz contact fail"
    more = {"tolerance": settings.tolerance}
    return finished(variables, title, answers, settings, CASE_COLUMNS, **more)


def report(dataset: xr.Dataset) -> Iterator[str]:
    """Yield a line of text for each method: the number of cases with each outcome."""
    for method, row in zip(dataset["method"].values, dataset["outcome"].values, strict=True):
        counts = ((OUTCOMES[i], int((row == i).sum())) for i in range(1, len(OUTCOMES)))
        yield f"{method}: " + ", ".join(f"{count} {name}" for name, count in counts)
