"""Several contacts on one body: "load=1,phase=0,amplitude=1;load=1,phase=180,amplitude=1".

Each has its part of the normal load, its phase of the oscillation and its share of the amplitude;
all of them go forward with the one body that they carry.
"""

from __future__ import annotations

from dataclasses import dataclass

from microslip.foundation import spec
from microslip.foundation.errors import InputError

USUAL = {"load": 1.0, "phase": 0.0, "amplitude": 1.0}
"""A contact of which nothing is said."""
EXAMPLE = "phase=0;phase=180"
MEANT = "loads and amplitudes are shares without a unit, phases are in degrees"
MOST_CONTACTS = 8
LIGHTEST, HEAVIEST = 1e-3, 1e3
"""Of a load over another: what is less or more is a slip."""
LARGEST_SHARE = 1e3
"""Of the amplitude likewise."""


@dataclass(frozen=True)
class BodyContact:
    """One of the contacts of a body.

    Attributes
    ----------
    load : float
        Normal load, over the mean of all contacts of the body.
    phase : float
        By how much its oscillation is ahead of the phase of the body, degrees from 0 to below 360.
    amplitude : float
        How far it oscillates, over the amplitude of the body.
    """

    load: float
    phase: float
    amplitude: float


def contacts_of(text: str) -> tuple[BodyContact, ...]:
    """The contacts that a text says; loads count by their ratios alone.

    Raises InputError about `contacts` for any other text.
    """
    if not isinstance(text, str):
        raise InputError("contacts", text, f"allowed is a text such as {EXAMPLE!r}")
    records = [_numbers(number, part, text) for number, part in enumerate(text.split(";"), 1)]
    if len(records) > MOST_CONTACTS:
        allowed = f"allowed are up to {MOST_CONTACTS} contacts, not {len(records)}"
        raise InputError("contacts", text, allowed)
    loads = [record["load"] for record in records]
    mean = sum(loads) / len(loads) if len(set(loads)) > 1 else loads[0]  # equal ones are 1 each
    return tuple(
        BodyContact(record["load"] / mean, record["phase"] % 360.0, record["amplitude"])
        for record in records
    )


def contacts_text(contacts: tuple[BodyContact, ...]) -> str:
    """The text of contacts, to 12 digits."""
    return ";".join(
        f"load={one.load:.12g},phase={one.phase:.12g},amplitude={one.amplitude:.12g}"
        for one in contacts
    )


def _numbers(number: int, part: str, text: str) -> dict[str, float]:
    """What is said of a contact; what is wrong is told with its number."""
    try:
        given = spec.numbers_in(part, text, "contacts", EXAMPLE)
        spec.refuse_unknown(text, "contacts", given, USUAL)
        numbers = USUAL | given
        spec.refuse_outside(text, "contacts", "load", numbers["load"], (LIGHTEST, HEAVIEST))
        limits = (0.0, LARGEST_SHARE)
        spec.refuse_outside(text, "contacts", "amplitude", numbers["amplitude"], limits)
    except InputError as error:
        problem = f"contact {number}: {error.allowed} ({MEANT})"
        raise InputError("contacts", text, problem) from None
    return numbers
