"""One small contact of every kind, each with a suitable motion."""

from microslip.contact.modes import PolarContact
from microslip.contact.ring_contact import RadialContact
from microslip.contact.squares import CartesianContact

CONTACTS = {
    "rings": (lambda: RadialContact.resolved(5, 0.7), "transverse", 0.0),
    "angular points": (lambda: PolarContact(4, 4, True, 0.3, 0.6), "bore", 0.3),
    "angular points of a translation": (
        lambda: PolarContact(4, 4, False, 0.3, 0.6),
        "transverse",
        0.3,
    ),
    "squares": (lambda: CartesianContact(5, 0.3), "bore", 0.3),
}
"""Functions that build a contact, names of motions, and Poisson's ratios."""
