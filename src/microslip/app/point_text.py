"""Text that `microslip point` prints for a Result."""

from __future__ import annotations

from microslip.adaptive.result import Result
from microslip.foundation.number_text import number_text
from microslip.models.registry import MODELS
from microslip.motions.by_name import motion_named
from microslip.motions.problem import Problem

RATIO = "a ratio: mean forward force over mu F_z; the coefficient felt is mu_apparent = mu mu_macro"
"""Explanation next to a number."""
OWN_EQUATIONS = (
    "an approximation: the error is that of its own equations, not of what they leave out"
)

DIGITS = 6
"""Significant digits of numbers known exactly."""


def as_text(result: Result) -> str:
    """Lines on standard output for a Result."""
    if result.force is not None:
        assert result.velocity_error is not None  # as under all forces
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
    if _leaves_something_out(result):
        lines.append(OWN_EQUATIONS)
    if not result.converged:
        quantity = "mu_macro" if result.force is None else "velocity"
        lines.append(f"NOT CONVERGED: {quantity}: {result.reason}")
    return "\n".join(lines)


def _leaves_something_out(result: Result) -> bool:
    """Whether no refinement of the model would find what the contact does."""
    if result.model not in MODELS:
        return False  # a closed form, whose error is known
    problem = Problem(motion_named(result.motion), result.velocity, result.amplitude)
    return not MODELS[result.model].exact(problem)
