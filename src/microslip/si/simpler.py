"""Simpler models that have the same friction within its error."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from microslip.answer import limits
from microslip.contact.registry import MODELS
from microslip.scene.hertz import HERTZ
from microslip.si.contact import Contact
from microslip.si.solve import TOLERANCE, Answer, problem_of, solve_at, within_range

SIMPLER: dict[str, dict[str, Any]] = {
    "a sphere suffices: on a circular contact with the same u_lim, mu_macro differs by less than "
    "its error": {"pressure": HERTZ},
    "Poisson's ratio matters for u_lim only: with the ratio 0 and the same u_lim, mu_macro differs "
    "by less than its error": {"poisson": 0.0},
}
"""Changes of a Problem, keyed by the sentence for changes that do not matter."""


def simplifications(contact: Contact, answer: Answer) -> list[str]:
    """Return the sentences of SIMPLER that hold for a contact: the simpler contact has the same
    friction at the same speed, within the error of the answer.

    A contact counts as simpler if another model is chosen for it.  The list is empty for a contact
    under a force, and for an answer that is a closed form, comes from a map or is not converged.
    """
    inputs, friction = contact.inputs, answer.values["friction"]
    if inputs.force is not None or not answer.converged or answer.model not in MODELS:
        return []
    # the choice of a model distinguishes a velocity of 0 from others
    problem = replace(problem_of(contact), velocity=min(contact.velocity, 1.0))
    drive, tolerance = within_range(contact.drive(contact.mean_load)), inputs.tolerance or TOLERANCE
    sentences = []
    for sentence, change in SIMPLER.items():
        if limits.choose_model(replace(problem, **change)) != answer.model:
            result = solve_at(contact, contact.velocity, tolerance, **drive, **change)
            if result.converged and abs(result.friction.value - friction.value) <= friction.error:
                sentences.append(sentence)
    return sentences
