"""Quantities with units, and error messages with the place where reading stopped."""

import pytest
from bad_input_tables.odd_quantities import ROWS, Q

from microslip.foundation.units import BASES, CYCLIC, UNITS, read

HALF_A_DIGIT = 1e-15
"""Relative rounding error of a few floats and of pi."""


def name_of(value):
    try:
        return repr(value)[:40]
    except ValueError:  # a whole number with thousands of digits
        return "huge"


@pytest.mark.parametrize(("value", "unit", "expected"), ROWS, ids=name_of)
def test_an_odd_quantity_is_its_value_or_is_refused(value, unit, expected):
    if not isinstance(expected, str):
        result = read(value, unit).si
        assert type(result) is float
        assert result == pytest.approx(expected, rel=HALF_A_DIGIT, abs=0.0)
        return
    with pytest.raises(ValueError, match="allowed is") as caught:
        read(value, unit)
    assert expected in str(caught.value) and "\n" not in str(caught.value)


def test_every_unit_is_what_pint_defines_by_the_same_name():
    registry = Q(1, "m")._REGISTRY
    for name, unit in UNITS.items():
        if CYCLIC.fullmatch(name) or unit.powers[BASES.index("K")]:
            continue  # pint leaves out the turn; temperatures have an offset there
        usual = {"hbar": "hectobar", "kn": "knot"}.get(name, name.replace("rev", "turn"))
        factor, root = registry.get_root_units(usual)
        size = unit.factor * 1000 ** unit.powers[BASES.index("kg")]  # pint's root is the gram
        assert float(size) == pytest.approx(factor, rel=HALF_A_DIGIT), name
        exponents = dict((1 * root).unit_items())
        for base, power in zip(("meter", "gram", "second"), unit.powers, strict=False):
            assert exponents.get(base, 0) == power, name


@pytest.mark.parametrize(
    ("texts", "unit"),
    [
        (["1 um", "1e-3 mm", "0.000001 m", "1000 nm", "10000 angstrom", Q(1.0, "um")], "m"),
        (["210 GPa", "2.1e11 Pa", "210000 N/mm^2", "2.1e5 MPa"], "Pa"),
        (["1 ksi", "1000 psi"], "Pa"),
        (["3 mm", "3 millimeter", "3 millimetre", "3000 micrometer"], "m"),  # as in netCDF files
        (["600 rpm", "10 Hz", "10 turn/s", "3600 deg/s", "36000 rev/hour"], "Hz"),
    ],
)
def test_equal_quantities_are_equal_to_the_last_bit(texts, unit):
    """Values are computed in fractions and rounded once, to a float."""
    assert len({read(text, unit).si for text in texts}) == 1


@pytest.mark.parametrize(
    ("text", "deviation"),
    [
        ("0.25 +- 10 %", 0.025),
        ("0.25 +- 0.025", 0.025),
        ("25 % +- 2 %", 0.02),  # in the unit of the value
        ("0.25 ± 0.25", 0.25),
    ],
)
def test_an_uncertainty_in_per_cent_is_a_share_of_the_value(text, deviation):
    quantity = read(text, "")
    assert (quantity.si, quantity.deviation) == (0.25, pytest.approx(deviation))
