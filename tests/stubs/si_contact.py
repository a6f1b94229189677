"""A contact in SI units from inputs of predict."""

from microslip.si.contact import contact_of
from microslip.si.inputs import read_inputs

STEEL = {"young": 210e9, "nu": 0.3}
BALL = STEEL | {"radius": 5e-3, "load": 10.0, "mu": 0.3}


def contact(motion=None, **given):
    """The checked contact.  motion: None for a contact without a motion."""
    return contact_of(read_inputs(motion, **given))
