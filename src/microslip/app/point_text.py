"""The output of `microslip point` in words."""

from __future__ import annotations

from microslip.adaptive.result import Result
from microslip.foundation.number_text import number_text
from microslip.models.registry import MODELS
from microslip.motions.by_name import motion_named
from microslip.motions.problem import Problem

RATIO = (
    "a ratio: mean forward force divided by mu F_z; the coefficient of friction is mu times "
    "mu_macro"
)
"""Explanation of mu_macro for users."""
OWN_EQUATIONS = (
    "an approximate model: the error estimate covers its discretisation, not the approximation"
)

DIGITS = 6
"""Number of significant digits if there is no error estimate."""


def as_text(result: Result) -> str:
    """Return the printed lines for a result."""
    if result.force is not None:
        assert result.velocity_error is not None  # set under a force
        lines = [f"velocity = {number_text(result.velocity, result.velocity_error, digits=DIGITS)}"]
    else:
        ratio = number_text(result.mu_macro, result.mu_macro_error, digits=DIGITS)
        lines = [f"mu_macro = {ratio}", RATIO]
    if result.torque is not None:
        torque = number_text(result.torque.value, result.torque.error, digits=DIGITS)
        lines.append(f"mu_torque = {torque}")
    resolved = f"{result.cells} cells"
    if result.angles > 1:
        resolved += f" x {result.angles} angles"
    if result.steps_per_period:
        resolved += f", {result.steps_per_period} steps a period"
    lines.append(f"model {result.model}" + (f" ({resolved})" if result.cells else ""))
    if _is_approximate(result):
        lines.append(OWN_EQUATIONS)
    if not result.converged:
        quantity = "mu_macro" if result.force is None else "velocity"
        lines.append(f"NOT CONVERGED: {quantity}: {result.reason}")
    return "\n".join(lines)


def _is_approximate(result: Result) -> bool:
    """True for a model whose error does not vanish when its mesh is refined."""
    if result.model not in MODELS:
        return False  # a closed form
    problem = Problem(motion_named(result.motion), result.velocity, result.amplitude)
    return not MODELS[result.model].exact(problem)
