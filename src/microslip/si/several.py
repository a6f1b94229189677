"""A body on several contacts in SI units.

All dimensionless groups refer to a contact with the mean load; see solver.body_problem.  The body's
drive is divided by the number of contacts.  Computed forces are multiplied by this number.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from microslip.motions.body_contacts import contacts_of, contacts_text
from microslip.pressures.by_name import pressure_named
from microslip.si.bodies import TwoBodies
from microslip.si.shapes import ShapedContact


@dataclass(frozen=True)
class Carriers:
    """The contacts of a body.

    Attributes
    ----------
    text : str or None
        The contacts as text for microslip.solve; None for a single contact.
    count : int
        Number of contacts.
    heaviest, widest : float
        Largest load of a contact, divided by the mean load; largest amplitude of a contact, divided
        by the body's amplitude.
    """

    text: str | None = None
    count: int = 1
    heaviest: float = 1.0
    widest: float = 1.0

    def most_loaded(self, contact: TwoBodies) -> TwoBodies:
        """Return the contact with the largest load.  contact: the contact with the mean load."""
        if self.heaviest == 1.0:
            return contact
        load = contact.load * self.heaviest
        if not isinstance(contact, ShapedContact):
            return replace(contact, load=load)
        pressure = pressure_named(contact.pressure)
        grown = float(pressure.radius(float(pressure.of_load(self.heaviest))))
        return replace(contact, load=load, size=contact.size * grown)


def read_carriers(contacts: Any) -> Carriers:
    """The Carriers for the argument `contacts`.  Raises InputError."""
    if contacts is None:
        return Carriers()
    carriers = contacts_of(contacts)
    text = contacts_text(carriers)
    most = (max(one.load for one in carriers), max(one.amplitude for one in carriers))
    return Carriers(text, len(carriers), *most)
