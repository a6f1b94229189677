"""A body on several contacts in SI units: what each of them has of the load and of the drive.

All groups are those of the contact that carries the mean load, see solver.body_problem: so a drive
counts by its share for each contact, and forces of the body are those of that contact times their
number.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from microslip.foundation.errors import InputError
from microslip.motions.body_contacts import contacts_of, contacts_text
from microslip.pressures.by_name import pressure_named
from microslip.si.bodies import TwoBodies
from microslip.si.dimensionless import RealDrive
from microslip.si.shapes import ShapedContact


@dataclass(frozen=True)
class Carriers:
    """The contacts that carry a body.

    Attributes
    ----------
    text : str or None
        As microslip.solve takes them, None where it is one.
    count : int
        How many there are.
    heaviest, widest : float
        Largest load over the mean, and largest share of the amplitude.
    """

    text: str | None = None
    count: int = 1
    heaviest: float = 1.0
    widest: float = 1.0

    def share_of(self, drive: RealDrive) -> RealDrive:
        """The drive of the body divided by the number of contacts."""
        parts = {name: value for name, value in vars(drive).items() if value is not None}
        return RealDrive(**{name: value / self.count for name, value in parts.items()})

    def most_loaded(self, contact: TwoBodies) -> TwoBodies:
        """The contact that carries most, of the one that carries the mean."""
        if self.heaviest == 1.0:
            return contact
        load = contact.load * self.heaviest
        if not isinstance(contact, ShapedContact):
            return replace(contact, load=load)
        pressure = pressure_named(contact.pressure)
        grown = float(pressure.radius(float(pressure.of_load(self.heaviest))))
        return replace(contact, load=load, size=contact.size * grown)


def read_carriers(contacts: Any, **alone: object) -> tuple[Carriers, dict[str, str]]:
    """The Carriers, and a dict of texts of what was understood; raises InputError.

    alone: values, as they were given, of arguments that go with one contact only.
    """
    if contacts is None:
        return Carriers(), {}
    found = contacts_of(contacts)
    for name, value in alone.items():
        if value:
            raise InputError(name, value, "allowed for one contact only, without contacts")
    text = contacts_text(found)
    most = (max(one.load for one in found), max(one.amplitude for one in found))
    return Carriers(text, len(found), *most), {"contacts": " ".join(contacts.split())}
