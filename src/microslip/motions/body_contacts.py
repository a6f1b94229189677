"""Contacts that carry one body, and their text format
"load=1,phase=0,amplitude=1;load=1,phase=180".

Each contact has its own load, phase and amplitude of the oscillation.  All contacts move forward
with the body.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass

from microslip.foundation import spec
from microslip.foundation.arguments import real
from microslip.foundation.errors import InputError

EXAMPLE = "phase=0;phase=180"
UNITS = "loads and amplitudes are shares without a unit, phases are in degrees"
MOST_CONTACTS = 8
"""Largest number of contacts on a body."""
LIGHTEST, HEAVIEST = 1e-3, 1e3
"""Allowed range of a contact's load in a text.  Other values are probably typing errors."""
LARGEST_SHARE = 1e3
"""Largest allowed value of a contact's amplitude in a text.  Larger values are probably typing
errors."""


@dataclass(frozen=True)
class BodyContact:
    """One of several contacts that carry a body.

    Parameters
    ----------
    load : float
        Normal load divided by the mean load of the contacts, above 0.
    phase : float
        Phase lead of this contact's oscillation relative to the motion, in degrees.
    amplitude : float
        Amplitude of this contact's oscillation divided by the amplitude of the motion, at least 0.

    Raises
    ------
    InputError
        If a number is outside its range.
    """

    load: float = 1.0
    phase: float = 0.0
    amplitude: float = 1.0

    def __post_init__(self) -> None:
        for name, low in (("load", 0.0), ("phase", -math.inf), ("amplitude", 0.0)):
            real(name, getattr(self, name), low)
        if self.load == 0.0:
            raise InputError("load", self.load, "allowed is a number above 0")


def contacts_of(text: str) -> tuple[BodyContact, ...]:
    """Parse the text that describes several contacts.  The loads are divided by their mean.

    Raises InputError about `contacts` if the text cannot be parsed.
    """
    if not isinstance(text, str):
        raise InputError("contacts", text, f"allowed is a text such as {EXAMPLE!r}")
    records = [_numbers(number, part, text) for number, part in enumerate(text.split(";"), 1)]
    if len(records) > MOST_CONTACTS:
        allowed = f"allowed are up to {MOST_CONTACTS} contacts, not {len(records)}"
        raise InputError("contacts", text, allowed)
    loads = [record["load"] for record in records]
    # equal loads become exactly 1
    mean = sum(loads) / len(loads) if len(set(loads)) > 1 else loads[0]
    return tuple(
        BodyContact(record["load"] / mean, record["phase"] % 360.0, record["amplitude"])
        for record in records
    )


def contacts_text(contacts: tuple[BodyContact, ...]) -> str:
    """Return the text that describes contacts, with 12 digits; the inverse of `contacts_of`."""
    return ";".join(
        f"load={one.load:.12g},phase={one.phase:.12g},amplitude={one.amplitude:.12g}"
        for one in contacts
    )


def _numbers(number: int, part: str, text: str) -> dict[str, float]:
    """Parse the numbers of one contact from `part`, a section of `text`.  Error messages contain
    the contact's `number`."""
    try:
        words = spec.numbers_in(part, text, "contacts", EXAMPLE)
        spec.refuse_unknown(text, "contacts", words, asdict(BodyContact()))
        numbers = asdict(BodyContact()) | words
        spec.refuse_outside(text, "contacts", "load", numbers["load"], (LIGHTEST, HEAVIEST))
        limits = (0.0, LARGEST_SHARE)
        spec.refuse_outside(text, "contacts", "amplitude", numbers["amplitude"], limits)
    except InputError as error:
        problem = f"contact {number}: {error.allowed} ({UNITS})"
        raise InputError("contacts", text, problem) from None
    return numbers
