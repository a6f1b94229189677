"""The dataset stability: what became of every method in every case."""

from collections.abc import Callable, Iterator

import numpy as np
import xarray as xr

from microslip.config.quantities import MU_MACRO
from microslip.config.settings import Stability
from microslip.datasets.variables import flags, variable
from microslip.solver import method_names
from microslip.studies.stability import stability as study
from microslip.studies.tables import Answers, finished, value_of

OUTCOMES = ("not_applicable", "converged", "slow", "wrong", "diverged")
NOT_APPLICABLE, CONVERGED, SLOW, WRONG, DIVERGED = range(len(OUTCOMES))

GROUPS = {"axes": ("What is varied in the blocks of cases", ("axis",))}
"""Groups of the dataset that are not over methods and cases."""

NUMBERS = {
    "mu_macro": ("mu_macro", MU_MACRO.description),
    "claimed_error": ("mu_macro_error", "error of mu_macro that the method claims"),
    "work": ("work", "step solves times unknowns, summed over all runs"),
}

UNSOLVED = "a step was left unsolved"
"""How the reason of a run starts that ran out of iterations near the solution of a step."""


def outcome(
    result: dict | None, reference: float, reference_error: float, imposed: bool = False
) -> int:
    """One of OUTCOMES, as an index.

    result: of a probe, None or `applies` False where the method was not asked; imposed: whether its
    resolution was, which then may be too coarse for the tolerance: that is not the method's.
    Converged: it says
    so, and comes as near to the reference as both claim; wrong: it says so and does not; slow: it
    gave up within its budget, and says so, be it in the middle of a step; diverged: it says so, or
    there is no number for another reason.
    """
    if result is None or not result.get("applies", True):
        return NOT_APPLICABLE
    mu, claimed = value_of(result, "mu_macro"), value_of(result, "mu_macro_error")
    reason = value_of(result, "reason", str)
    if reason.startswith("diverged"):
        return DIVERGED
    if value_of(result, "exhausted", str):
        return SLOW
    if not np.isfinite(mu) and not reason.startswith(UNSOLVED):
        return DIVERGED
    if not value_of(result, "periodic" if imposed else "converged", bool):
        return SLOW
    return CONVERGED if abs(mu - reference) <= claimed + reference_error else WRONG


def build(settings: Stability, answer: Callable) -> xr.Dataset:
    """Assemble the Dataset.

    answer(request) -> record, such as batches.answer with a store.
    """
    answers = Answers(answer)
    cases = study.cases(settings)
    truths = [answers(study.reference(settings, overrides)) for _, _, overrides in cases]
    reference = np.array([value_of(truth, "mu_macro") for truth in truths])
    reference_error = np.array([value_of(truth, "mu_macro_error") for truth in truths])
    results = [
        [_asked(answers, study.probe(settings, method, *case)) for case in cases]
        for method in settings.methods
    ]
    both = ("method", "case")
    imposed = [bool({"cells", "steps"} & overrides.keys()) for _, _, overrides in cases]
    outcomes = [
        [outcome(*four) for four in zip(row, reference, reference_error, imposed, strict=True)]
        for row in results
    ]
    variables = {"outcome": flags(both, outcomes, "what became of the method", OUTCOMES)}
    for name, (key, long_name) in NUMBERS.items():
        values = [[value_of(result or {}, key) for result in row] for row in results]
        variables[name] = variable(both, values, long_name)
    away = np.abs(variables["mu_macro"][1] - reference)
    variables["error"] = variable(both, away, "distance of mu_macro from the reference")
    reasons = [[value_of(result or {}, "reason", str) for result in row] for row in results]
    variables["reason"] = variable(both, reasons, "what the method says if it gave up", str)
    summaries = [method_names.method_named(method).summary for method in settings.methods]
    variables["method_summary"] = variable("method", summaries, "the method in a line", str)
    variables["reference"] = variable("case", reference, "mu_macro that probes are compared with")
    claimed = "error that the reference claims"
    variables["reference_error"] = variable("case", reference_error, claimed)
    axes = study.axes(settings)
    variables["axis_label"] = variable("axis", [a.label for a in axes], "what is varied", str)
    variables["axis_note"] = variable("axis", [a.note for a in axes], "what is held", str)
    coords = {
        "method": variable("method", list(settings.methods), "method that was exchanged", str),
        "axis": variable("axis", [axis.name for axis in axes], "block of cases", str),
        "case_axis": variable("case", [a.name for a, _, _ in cases], "block of the case", str),
        "case_value": variable("case", [v for _, v, _ in cases], "value of what is varied"),
        "case_label": variable("case", [f"{v:g}" for _, v, _ in cases], "the value as text", str),
    }
    title = "Where methods for the friction of a vibrated Hertz contact fail"
    more = {"tolerance": settings.tolerance}
    return finished(variables, coords, title, answers, settings, **more)


def report(dataset: xr.Dataset) -> Iterator[str]:
    """Lines of text: what became of every method, and how often."""
    for method, found in zip(dataset["method"].values, dataset["outcome"].values, strict=True):
        counts = ((OUTCOMES[i], int((found == i).sum())) for i in range(1, len(OUTCOMES)))
        yield f"{method}: " + ", ".join(f"{count} {name}" for name, count in counts)


def _asked(answers: Answers, request: dict | None) -> dict | None:
    return None if request is None else answers(request)
