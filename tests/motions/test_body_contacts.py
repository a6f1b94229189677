"""The text form of the contacts of a body."""

import pytest

from microslip.foundation.errors import InputError
from microslip.motions.body_contacts import BodyContact, contacts_of, contacts_text


def test_what_is_not_said_is_usual():
    assert contacts_of("phase=90") == (BodyContact(load=1.0, phase=90.0, amplitude=1.0),)
    assert contacts_of(" amplitude = 2 , load=3 ") == (BodyContact(1.0, 0.0, 2.0),)


def test_loads_count_by_their_ratios():
    one, other = contacts_of("load=2;load=6,phase=-90")
    assert (one.load, other.load) == (0.5, 1.5)
    assert other.phase == 270.0
    assert contacts_of("load=1;load=3,phase=270") == (one, other)
    assert {each.load for each in contacts_of(";".join(["load=0.1"] * 3))} == {1.0}


def test_what_is_written_is_read_as_it_was():
    contacts = contacts_of("load=0.25,phase=120.5;load=0.75,amplitude=0.5")
    assert contacts_of(contacts_text(contacts)) == contacts


BAD = {
    "no text": (["phase=0"], "contacts = ['phase=0']: allowed is a text such as"),
    "nothing": ("", "contact 1: in it '': allowed are numbers as in phase=0;phase=180"),
    "an end too many": ("phase=0;", "contact 2: in it '': allowed are numbers"),
    "no number": ("phase=up", "contact 1: in it 'phase=up': allowed are numbers"),
    "with a unit": ("load=1;phase=180deg", "contact 2: in it 'phase=180deg': allowed are numbers"),
    "endless": ("phase=inf", "contact 1: in it 'phase=inf': allowed are numbers"),
    "twice": ("phase=0,phase=1", "phase occurs twice"),
    "a strange key": ("share=1", "unknown number share; allowed: load, phase, amplitude"),
    "no load": ("load=0", "load = 0: allowed is a number in 0.001..1000"),
    "back": ("amplitude=-1", "amplitude = -1: allowed is a number in 0..1000"),
    "a crowd": (";".join(["phase=0"] * 9), "allowed are up to 8 contacts, not 9"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_contacts_get_one_line(name):
    text, expected = BAD[name]
    with pytest.raises(InputError) as refused:
        contacts_of(text)
    message = str(refused.value)
    assert message.startswith("contacts = ") and expected in message
    assert "\n" not in message
