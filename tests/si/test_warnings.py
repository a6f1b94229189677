"""Warnings where a contact violates the theory, hardness scales, and materials."""

import math
import re

import pytest
from stubs.si_contact import contact as contact_of

import microslip
from microslip.foundation.errors import InputError
from microslip.si.materials import MATERIALS, Material, read_hardness
from microslip.si.warnings import warnings_of

MILD = {"radius": "5 mm", "load": "10 N", "mu": 0.3, "speed": "1 mm/s", "frequency": "20 kHz"}
MILD |= {"young": "210 GPa", "nu": 0.3, "counterbody": "210 GPa, 0.3", "amplitude": "0.3 um"}
STEEL = 210e9 / (2.0 * (1.0 - 0.3**2))
"""Modulus E* of this contact."""
ENERGY = 0.05
"""Work of adhesion of clean surfaces, N/m."""


def warned(words, motion="transverse", **changes):
    """Warnings with these words."""
    contact = contact_of(motion, **MILD | changes)
    return [text for text in warnings_of(contact, contact.inputs.speed) if words in text]


def rigid_at(contact_radius, radius):
    """Load with a contact radius on a rigid counterbody: F = 4 E* a^3 / (3 R)."""
    load = 4.0 / 3.0 * (210e9 / 0.91) * contact_radius**3 / radius
    return {"load": load, "counterbody": "rigid"}


WARNED = {
    "yields": {"hardness": "1.5 GPa"},
    "0.49 of the smaller radius": rigid_at(0.49 * 5e-3, 5e-3),
    # 0.15 times the radius of either ball
    "0.3 of the radius of relative curvature": rigid_at(0.15 * 5e-3, 2.5e-3)
    | {"counter_radius": 5e-3},
    "amplitude": {"amplitude": "20 um"},
    "shear wave": {"density": "7850 kg/m^3", "frequency": "20 MHz"},
    "slip speed": {"density": "7850 kg/m^3", "speed": "400 m/s"},
    "beta": {"counterbody": "rigid"},
    "mu is 1.2": {"mu": 1.2},
    "units of forces": {"mu": 0.009},
    "clean smooth surfaces adhere": {"load": "10 mN"},
    "distance between atoms": {"amplitude": "0.1 nm"},
    "every metal, ceramic or glass": {"load": "40 kN"},
    "internal losses": {"nu": 0.47},
}


@pytest.mark.parametrize("word", WARNED)
def test_a_violated_assumption_has_one_warning(word):
    assert len(warned(word, **WARNED[word])) == 1
    assert not warned(word, hardness="7 GPa", density="7850 kg/m^3")


def test_an_infinite_pressure_at_the_tip_of_a_cone_has_one_warning():
    cone = {"radius": None, "contact_radius": "0.1 mm", "pressure": "power:exponent=1"}
    for hardness in ({}, {"hardness": "7 GPa"}):
        (text,) = warned("pressure", **cone | hardness)
        mean = float(f"{10.0 / (math.pi * 1e-8) / 1e6:.2g}")
        assert "tip" in text and f"the mean pressure is {mean:g} MPa" in text


# Adhesion


KENDALL = math.sqrt(8.0 * math.pi * STEEL * ENERGY * 10e-3**3)
PUNCH = {"contact_radius": 10e-3, "pressure": "punch:flat=0.99", "load": 1e3}
PARABOLA = {"contact_radius": 5e-6, "pressure": "power:exponent=2"}
PARABOLA |= {"load": 4.0 / 3.0 * STEEL * 5e-6**3 / 5e-3}  # that of a sphere of radius 5 mm
ELLIPSE = {"radius": 5e-3, "radius_across": 50e-6, "load": 1e-3}


DMT = {"counterbody": "rigid", "radius": 1e-8, "load": 1e-9, "amplitude": 1e-8}
JKR = DMT | {"young": 1e6, "radius": 1e-2}


@pytest.mark.parametrize(
    ("shape", "force", "digits", "theory"),
    [
        (DMT, 2.0 * math.pi * ENERGY * 1e-8, 0.03, "DMT"),
        (JKR, 1.5 * math.pi * ENERGY * 1e-2, 0.03, "JKR"),
        (PUNCH, KENDALL, 0.03, ""),
        (PARABOLA, 1.5 * math.pi * ENERGY * 5e-3, 0.02, ""),
        # Derjaguin: 2 pi w sqrt(R' R''); an upper bound for a slender ellipse
        (ELLIPSE, math.pi * ENERGY * 2 * 0.5e-3, 0.3, ""),
    ],
)
def test_the_pull_off_force_is_that_of_the_shape(shape, force, digits, theory):
    (text,) = warned("adhere", **{"radius": None} | shape)
    value, prefix = re.search(r"about ([\d.e+-]+) (k|m|u|n|)N", text).groups()
    unit = {"k": 1e3, "": 1.0, "m": 1e-3, "u": 1e-6, "n": 1e-9}[prefix]
    assert float(value) * unit == pytest.approx(force, rel=digits) and f": {theory}" in text


def test_adhesion_without_a_formula_is_not_checked():
    ring = {"radius": None, "contact_radius": "10 mm", "pressure": "ring:inner=0.5", "load": "1 N"}
    result = microslip.predict("transverse", **MILD | ring, tolerance=0.1)
    assert not any("adhere" in text for text in result.warnings)
    assert any("adhesion" in text for text in result.not_checked)


def test_the_time_of_a_wave_is_that_over_the_contact_radius():
    inputs = {"frequency": "10 MHz", "density": "7850 kg/m^3"}
    (text,) = warned("shear wave", **inputs)
    radius = contact_of("transverse", **MILD | inputs).contact_radius
    radians = 2.0 * math.pi * 1e7 * radius / math.sqrt(210e9 / 2.6 / 7850.0)
    assert float(re.search(r"([\d.]+) radians", text)[1]) == pytest.approx(radians, rel=0.05)


# Files


@pytest.mark.parametrize(
    ("newtons", "load", "separates"),
    [([140, 100, 60, 100], "50 N", False), ([90, 30, 0, 0, 0, 30], None, True)],
)
def test_bodies_separate_if_the_load_of_a_file_vanishes(tmp_path, newtons, load, separates):
    rows = "\n".join(f"{one},{0.1 * k}" for k, one in enumerate(newtons))
    (tmp_path / "load.csv").write_text(f"load [N],lateral [um]\n{rows}\n")
    inputs = {"amplitude": None, "load": load, "frequency": "1 kHz"}
    assert len(warned("separate", f"file:{tmp_path}/load.csv", **inputs)) == separates


UNIFORM = "".join(f"{x},{y},5\n" for x in range(40) for y in range(20))
"""A pressure of 5 on 40 x 20 cells: half the longer side is 20, and the load is 4000."""
UNITS = "forward [mm],lateral [mm],pressure [MPa]"
MATRIX = 40 * f"{20 * '5 '}\n"


@pytest.mark.parametrize(
    ("text", "options", "size", "load", "differences"),
    [
        (f"{UNITS}\n{UNIFORM}", "", 20e-3, 4.03e3, ()),
        (f"{UNITS}\n{UNIFORM}", "", 2e-3, 4e6, ("contact radius", "load")),
        (MATRIX, ",pitch=1 mm", 10e-3, 4e3, ("contact radius",)),
        (MATRIX, ",pitch=1", 10e-3, 4e3, ()),
    ],
)
def test_a_pressure_file_whose_units_contradict_the_inputs_has_a_warning(
    text, options, size, load, differences, tmp_path
):
    (tmp_path / "pad.csv").write_text(text)
    pressure = f"file:{tmp_path / 'pad.csv'}{options}"
    pad = {"radius": None, "contact_radius": size, "load": load, "pressure": pressure}
    texts = warned("pressure file", **pad)
    assert [text.split(" is ")[0].removeprefix("the ") for text in texts] == [*differences]


def test_a_check_without_its_property_is_named_with_the_body():
    assert len(microslip.predict("transverse", **MILD, tolerance=0.1).not_checked) == 2
    glass = MILD | {"material": "glass", "young": None, "nu": None, "counterbody": "gold"}
    (text,) = microslip.predict("transverse", **glass, tolerance=0.1).not_checked
    assert "hardness of the counterbody" in text


# Materials


VICKERS = 9.80665e6 / math.sin(math.radians(68.0))
"""A kilogram-force a square millimetre of faces at 136 degrees, as a pressure on their plan."""


@pytest.mark.parametrize(
    ("text", "pressure"),
    [("700 HV", 700 * VICKERS), ("62.5HRC", 764.5 * VICKERS), ("7 GPa", 7e9), (7e9, 7e9)],
)
def test_a_hardness_is_a_pressure_on_any_scale(text, pressure):
    assert read_hardness(text).si == pytest.approx(pressure, rel=1e-4)


@pytest.mark.parametrize(
    ("name", "shear_modulus"),
    [
        ("brass", 37.3e9),  # Kaye and Laby, 2.2.2
        ("gold", 27.0e9),  # WebElements
        ("alumina", 169e9),  # R. G. Munro, 1997
        ("diamond", 535e9),  # H. J. McSkimin and P. Andreatch, J. Appl. Phys. 43, 1972
    ],
)
def test_two_elastic_constants_give_the_published_third(name, shear_modulus):
    assert MATERIALS[name].shear_modulus == pytest.approx(shear_modulus, rel=0.012)


def test_a_material_has_units():
    assert Material("210 GPa", "30 %", "7.85 g/cm^3", "7 GPa") == Material(210e9, 0.3, 7850.0, 7e9)


@pytest.mark.parametrize(
    ("values", "problem"),
    [
        ((0.0, 0.3), "young = .*above 0"),
        (("210", 0.3), "young = .*without a unit"),
        (("210 GPa +- 1 %", 0.3), "young = .*uncertainty"),
        ((210e9, 0.7), "poisson = .*at most 0.5"),
        ((210e9, 0.3, None, "7 N"), "hardness = .*units of Pa"),
    ],
)
def test_a_bad_material_is_refused(values, problem):
    with pytest.raises(InputError, match=f"^{problem}"):
        Material(*values)


def test_a_body_is_a_name_a_material_or_two_numbers():
    bodies = ("79 GPa, 0.42", (79e9, 0.42), ("79 GPa", 0.42), Material("79 GPa", 0.42))
    contacts = [contact_of("transverse", **MILD | {"counterbody": body}) for body in bodies]
    assert {one.bodies[1] for one in contacts} == {Material(79e9, 0.42)}
    assert {one.inputs.texts["counterbody"] for one in contacts} == {"E = 79 GPa, nu = 0.42"}
