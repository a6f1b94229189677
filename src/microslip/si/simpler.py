"""Simpler contacts that have the same friction within its error."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from microslip.si.contact import Contact
from microslip.si.solve import TOLERANCE, Answer, solve_at, within_range


class Simplification(NamedTuple):
    """A contact that a simpler model resolves.

    Attributes
    ----------
    sentence : str
        What the simpler contact is, and that it suffices.
    applies : callable
        applies(contact) -> whether it is simpler than the contact and much faster to solve.
    changes : dict
        Arguments of microslip.solve.
    """

    sentence: str
    applies: Callable[[Contact], bool]
    changes: dict[str, Any]


SIMPLIFICATIONS = (
    Simplification(
        "a sphere suffices: a circular contact with the same u_lim changes mu_macro by less than "
        "its error",
        lambda contact: contact.shape.hertzian and not contact.shape.is_round,
        {"pressure": "hertz"},
    ),
    Simplification(
        "Poisson's ratio matters for u_lim only: with the same u_lim, a ratio of 0 changes "
        "mu_macro by less than its error",
        lambda contact: contact.poisson > 0.0 and contact.kind.unit != "rad",
        {"poisson": 0.0},
    ),
)


def simplifications(contact: Contact, answer: Answer) -> list[str]:
    """Sentences on simpler contacts whose friction at the same speed differs by less than the error
    of the answer.

    A contact under a force, a friction map and an answer that is not converged have none.
    """
    inputs, known, sentences = contact.inputs, answer.values["friction"], []
    if inputs.force is not None or inputs.map is not None or not answer.converged or contact.steady:
        return []
    drive = within_range(contact.drive(contact.mean_load))
    tolerance = inputs.tolerance or TOLERANCE
    for one in SIMPLIFICATIONS:
        if one.applies(contact):
            result = solve_at(contact, contact.velocity, tolerance, **drive, **one.changes)
            if result.converged and abs(result.friction.value - known.value) <= known.error:
                sentences.append(one.sentence)
    return sentences
