"""Several contacts on one body: "load=1,phase=0,amplitude=1;load=1,phase=180,amplitude=1".

Each has its part of the normal load, its phase of the oscillation and its share of the amplitude;
all of them go forward with the one body that they carry.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass

from microslip.foundation import spec
from microslip.foundation.arguments import real
from microslip.foundation.errors import InputError

EXAMPLE = "phase=0;phase=180"
MEANT = "loads and amplitudes are shares without a unit, phases are in degrees"
MOST_CONTACTS = 8
LIGHTEST, HEAVIEST = 1e-3, 1e3
"""Allowed range of the ratio of two loads; values outside are taken for typing errors."""
LARGEST_SHARE = 1e3
"""Largest allowed amplitude of a contact over that of the motion; larger ones are typing errors."""


@dataclass(frozen=True)
class BodyContact:
    """One of the contacts of a body.

    Parameters
    ----------
    load : float
        Normal load, over the mean load of the contacts, above 0.
    phase : float
        Phase lead of its oscillation over that of the body, degrees.
    amplitude : float
        Its amplitude over that of the body, at least 0.

    Raises
    ------
    InputError
        For numbers out of range.
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
    """Numbers of one contact from its text; error messages name the number of the contact."""
    try:
        given = spec.numbers_in(part, text, "contacts", EXAMPLE)
        spec.refuse_unknown(text, "contacts", given, asdict(BodyContact()))
        numbers = asdict(BodyContact()) | given
        spec.refuse_outside(text, "contacts", "load", numbers["load"], (LIGHTEST, HEAVIEST))
        limits = (0.0, LARGEST_SHARE)
        spec.refuse_outside(text, "contacts", "amplitude", numbers["amplitude"], limits)
    except InputError as error:
        problem = f"contact {number}: {error.allowed} ({MEANT})"
        raise InputError("contacts", text, problem) from None
    return numbers
