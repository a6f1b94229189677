"""Contacts in SI units: Hertz's theory, dimensionless groups, predictions and warnings."""

import math

import pytest
from bad_input_tables.odd_quantities import Q
from scipy.integrate import quad
from stubs.si_contact import BALL as SPHERE
from stubs.si_contact import contact as contact_of

import microslip
from microslip.foundation.errors import InputError
from microslip.si.materials import MATERIALS, Material, read_hardness
from microslip.si.warnings import warnings_of
from microslip.theory import hertz

STEEL = Material(210e9, 0.3)
BALL = {"radius": "5 mm", "load": "10 N", "mu": 0.3, "speed": "1 mm/s"}
SPIN = BALL | {"material": "steel"}
EXAMPLE = BALL | {"young": "210 GPa", "nu": 0.3, "amplitude": "1 um", "frequency": "20 kHz"}


# Hertz's theory


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.5])
def test_one_elastic_body_is_the_papers_contact(poisson):
    """The moduli follow from Eq 3, and the integral of Hertz's pressure is the load."""
    contact = contact_of(young=3e9, nu=poisson, radius=0.01, load=7.0, mu=0.4)
    shear_modulus = 3e9 / (2 * (1 + poisson))
    assert contact.E_star == pytest.approx(3e9 / (1 - poisson**2))
    assert pytest.approx(shear_modulus) == contact.G
    assert contact.G_star == pytest.approx(4 * shear_modulus / (2 - poisson))
    assert contact.poisson == poisson
    a, depth = contact.contact_radius, contact.indentation
    assert 4 / 3 * contact.E_star * math.sqrt(0.01) * depth**1.5 == pytest.approx(7.0)
    share = quad(lambda r: 2 * math.pi * r * math.sqrt(1 - r**2), 0, 1)[0]
    assert contact.largest_pressure * a**2 * share == pytest.approx(7.0)
    # In working units the modulus is G* = 3/4.
    assert contact.G_star * a * contact.u_lim / (0.4 * 7.0) == pytest.approx(hertz.G_STAR)


def test_both_lines_of_eq_24_agree():
    c, contact = 0.37, contact_of(**SPHERE | {"radius": 0.01, "load": 50.0, "mu": 0.2})
    a = contact.contact_radius
    first = contact.mu * contact.E_star * a / (math.pi * contact.G * contact.radius) * hertz.D(c)
    assert hertz.lubkin_angle(c, contact.poisson) * contact.u_lim / a == pytest.approx(first)


def test_a_steel_ball_of_10_mm_on_steel_by_hand():
    """E* = 210/(2 * 0.91) GPa; a^3 = 3 * 10 * 0.005 / (4 E*); p0 = 3 F/(2 pi a^2)."""
    contact = contact_of(counterbody=STEEL, **SPHERE)
    assert contact.E_star == pytest.approx(115.385e9, rel=1e-5)
    assert contact.contact_radius == pytest.approx(68.753e-6, rel=1e-4)
    assert contact.largest_pressure == pytest.approx(1.0101e9, rel=1e-4)
    # u_lim = 3 mu F (2 - nu) / (16 G_half a) with two bodies of G = 80.77 GPa in series
    assert contact.u_lim == pytest.approx(3 * 3.0 * 1.7 / (16 * 40.385e9 * 68.753e-6), rel=1e-4)
    assert contact.mismatch == 0.0


def test_the_stiffer_the_counterbody_the_more_the_bodies_differ():
    soft = {"young": 1e9, "nu": 0.3, "radius": 1.0, "load": 1.0, "mu": 1.0}
    others = [Material(young, 0.3) for young in (1e9, 2e9, 1e12)]
    betas = [contact_of(counterbody=other, **soft).mismatch for other in others]
    assert betas[0] == 0.0
    assert betas[0] < betas[1] < betas[2]
    rigid = contact_of(**soft)
    assert rigid.mismatch == pytest.approx(0.5 * (1 - 0.6) / 0.7)
    assert betas[2] == pytest.approx(rigid.mismatch, rel=3e-3)
    assert contact_of(**soft | {"nu": 0.5}).mismatch == 0.0


def test_dimensionless_groups_by_hand():
    contact = contact_of("transverse", **SPHERE, speed=1e-3, amplitude=1e-6, frequency=20e3)
    velocity, amplitude = contact.velocity, contact.amplitude
    assert velocity == pytest.approx(1e-3 / (2 * math.pi * 20e3 * contact.u_lim))
    assert amplitude == pytest.approx(1e-6 / contact.u_lim)
    turning = contact_of("continuous-bore", **SPHERE, speed=1e-3, rotation=2.0)
    assert turning.velocity == pytest.approx(1e-3 / (2.0 * contact.contact_radius), rel=1e-15)
    assert turning.amplitude is None


def test_the_unit_of_a_bore_leaves_half_the_radius_sticking():
    """An angle of D(1/2) mu F_z/(pi G a^2) has the stick radius a/2 (Eq 24)."""
    for other in (None, STEEL, Material(70e9, 0.2)):
        contact = contact_of(counterbody=other, **SPHERE)
        a = contact.contact_radius
        angle = 3 * 0.3 * 10.0 / (4 * math.pi * contact.G * a**2) * hertz.D_half()
        moving = {"speed": 1e-3, "amplitude": angle, "frequency": 100.0}
        bore = contact_of("bore", counterbody=other, **SPHERE, **moving)
        velocity, amplitude = bore.velocity, bore.amplitude
        assert amplitude == pytest.approx(1.0)
        assert velocity == pytest.approx(1e-3 / (2 * math.pi * 100.0 * angle * a))


# Predictions


def test_a_prediction_is_what_the_solver_says_of_its_groups():
    result = microslip.predict("transverse", **EXAMPLE)
    answer = microslip.solve(
        "transverse", result.velocity, result.amplitude, poisson=result.poisson
    )
    assert result.mu_macro == answer.mu_macro
    assert result.mu_macro_error == answer.mu_macro_error
    assert result.mu_apparent == pytest.approx(0.3 * answer.mu_macro)
    assert result.friction_force_N == pytest.approx(3.0 * answer.mu_macro)
    assert result.force_reduction == pytest.approx(1 - answer.mu_macro)
    # the whole contact slides in each stroke
    assert result.mu_static == pytest.approx(0.0, abs=result.mu_static_error)


def test_two_balls_are_one_ball_of_half_the_radius():
    both = microslip.predict("transverse", **EXAMPLE | {"counter_radius": "5 mm"})
    half = microslip.predict("transverse", **EXAMPLE | {"radius": "2.5 mm"})
    assert both.contact_radius_m == pytest.approx(half.contact_radius_m)
    assert both.mu_macro == pytest.approx(half.mu_macro, abs=1e-9)
    hollow = microslip.predict("transverse", **EXAMPLE | {"counter_radius": "-10 mm"})
    assert hollow.contact_radius_m == pytest.approx(both.contact_radius_m * 4 ** (1 / 3))


# Materials


def test_a_material_has_units():
    assert Material("210 GPa", "30 %", "7.85 g/cm^3", "7 GPa") == Material(210e9, 0.3, 7850.0, 7e9)


@pytest.mark.parametrize(
    ("values", "named", "message"),
    [
        ((0.0, 0.3), "young", "above 0"),
        ((math.nan, 0.3), "young", "not finite"),
        (("210", 0.3), "young", "without a unit"),
        ((210e9, 0.7), "poisson", "at most 0.5"),
        ((210e9, 0.3, -7850.0), "density", "above 0"),
        ((210e9, 0.3, None, "7 N"), "hardness", "units of Pa"),
        ((210e9, 0.3, None, None, 5), "source", "a text"),
    ],
)
def test_a_bad_material_is_refused_where_it_is_made(values, named, message):
    with pytest.raises(InputError, match=f"^{named} = ") as caught:
        Material(*values)
    assert message in str(caught.value)


# Warnings

MILD = EXAMPLE | {"counterbody": "210 GPa, 0.3", "amplitude": "0.3 um", "tolerance": 0.1}
FITTING = {"radius": "14 mm", "counter_radius": "-14.1 mm", "young": "50 MPa", "nu": 0.5}


def rigid_at(contact_radius, radius):
    """Load with a contact radius on a rigid counterbody: F = 4 E* a^3 / (3 R)."""
    load = 4.0 / 3.0 * (210e9 / 0.91) * contact_radius**3 / radius
    return {"load": load, "counterbody": "rigid"}


WARNED = {
    "yields": {"hardness": "1.5 GPa"},
    "contact yields": {"hardness": "7 GPa", "counter_hardness": "1.5 GPa"},
    # E* = 50/0.75 MPa and R = 14 * 14.1/0.1 mm give a = (3 F R/(4 E*))^(1/3) = 6.06 mm
    "0.43 of the smaller radius": FITTING | {"counterbody": "rigid"},
    "0.49 of the smaller radius": rigid_at(0.49 * 5e-3, 5e-3),
    # 0.15 times the radius of either ball
    "0.3 of the radius of relative curvature": rigid_at(0.15 * 5e-3, 2.5e-3)
    | {"counter_radius": 5e-3},
    "amplitude": {"amplitude": "20 um"},
    "shear wave": {"density": "7850 kg/m^3", "frequency": "20 MHz"},
    "slip speed": {"density": "7850 kg/m^3", "speed": "400 m/s"},
    "beta": {"counterbody": "rigid"},
    "mu is 1.2": {"mu": 1.2},
    "clean smooth surfaces adhere": {"load": "10 mN"},
    "distance between atoms": {"amplitude": "0.1 nm"},
    "every metal, ceramic or glass": {"load": "40 kN"},
    "internal losses": {"nu": 0.47},
}


def test_nothing_is_warned_of_without_reason():
    known = MILD | {"hardness": "7 GPa", "density": "7850 kg/m^3"}
    assert microslip.predict("transverse", **known).warnings == ()


@pytest.mark.parametrize("word", WARNED)
def test_what_breaks_is_warned_of(word):
    result = microslip.predict("transverse", **MILD | WARNED[word])
    assert sum(word in text for text in result.warnings) == 1


def test_a_contact_above_half_the_radius_is_refused():
    with pytest.raises(InputError, match=r"^radius = '5 mm': .* 0\.51 of this"):
        microslip.predict("transverse", **MILD | rigid_at(0.51 * 5e-3, 5e-3))


@pytest.mark.parametrize(
    ("text", "pressure"),
    [
        ("700 HV", 700 * 9.80665e6 / math.sin(math.radians(68.0))),  # faces at 136 degrees
        ("60 HRC", 697 * 9.80665e6 / math.sin(math.radians(68.0))),
        ("62.5HRC", 764.5 * 9.80665e6 / math.sin(math.radians(68.0))),
        ("7 GPa", 7e9),
        (7e9, 7e9),
    ],
)
def test_a_hardness_is_a_pressure_on_any_scale(text, pressure):
    assert read_hardness(text).si == pytest.approx(pressure, rel=1e-4)


def test_small_spheres_adhere_by_derjaguin_and_large_soft_ones_by_johnson():
    """The pull-off force is 2 pi R W for a small hard sphere, 3/2 pi R W for a large soft one."""
    moving = {"speed": 1e-3, "amplitude": 1e-8, "frequency": 1e3, "mu": 0.3, "load": 1e-9}
    for young, radius, share, theory, unit, name in (
        (210e9, 1e-8, 2.0, "DMT", 1e-9, "nN"),
        (1e6, 1e-2, 1.5, "JKR", 1e-3, "mN"),
    ):
        contact = contact_of("transverse", young=young, nu=0.3, radius=radius, **moving)
        message = [text for text in warnings_of(contact, 1e-3) if "adhere" in text]
        pull = share * math.pi * radius * 0.05 / unit
        assert len(message) == 1
        assert f"about {pull:.2g} {name}" in message[0] and f": {theory})" in message[0]


def test_a_check_without_its_property_is_named_with_the_body():
    assert len(microslip.predict("transverse", **MILD).not_checked) == 2
    glass = MILD | {"material": "glass", "young": None, "nu": None}
    missing = {"rigid": (), "gold": ("hardness of the counterbody",)}
    for counterbody, names in missing.items():
        texts = microslip.predict("transverse", **glass | {"counterbody": counterbody}).not_checked
        assert len(texts) == len(names) and all(map(str.__contains__, texts, names))


@pytest.mark.parametrize(
    ("name", "shear_modulus", "rounding"),
    [
        ("brass", 37.3e9, 0.012),  # Kaye and Laby, 2.2.2
        ("copper", 48.3e9, 0.012),
        ("gold", 27.0e9, 0.012),  # WebElements
        ("alumina", 169e9, 0.012),  # R. G. Munro, 1997
        ("diamond", 535e9, 0.012),  # H. J. McSkimin and P. Andreatch, J. Appl. Phys. 43, 1972
        ("bearing-steel", 79.6e9, 0.012),
        ("CoCrMo", 87e9, 0.03),  # MakeItFrom.com: E to two digits
    ],
)
def test_two_elastic_constants_give_the_published_third(name, shear_modulus, rounding):
    assert MATERIALS[name].shear_modulus == pytest.approx(shear_modulus, rel=rounding)


def test_a_material_of_ones_own_and_a_pair_of_numbers_are_bodies():
    gold = microslip.Material(young="79 GPa", poisson=0.42)
    named = MILD | {"young": None, "nu": None, "material": STEEL}
    results = [microslip.predict("transverse", **one) for one in (named, MILD)]
    assert results[0].values == results[1].values
    lines = [
        microslip.predict("transverse", **MILD | {"counterbody": body})
        for body in ("79 GPa, 0.42", (79e9, 0.42), ("79 GPa", 0.42), gold)
    ]
    assert lines == lines[:1] * 4
    with pytest.raises(InputError, match="its Poisson's ratio 0.6: .* at most 0.5"):
        microslip.predict("transverse", **MILD | {"counterbody": (79e9, 0.6)})


@pytest.mark.parametrize("speeds", [["1 mm/s"], Q([1.0], "m/s")])
def test_several_speeds_are_for_predict_table(speeds):
    with pytest.raises(InputError, match="predict_table") as caught:
        microslip.predict("transverse", **MILD | {"speed": speeds})
    assert caught.value.argument == "speed"


# Limits


def test_a_bore_of_no_amplitude_has_no_velocity_to_tell():
    still = microslip.predict("bore", amplitude="0 deg", frequency="20 Hz", **SPIN)
    assert (still.velocity, still.mu_macro, still.force_reduction) == (None, 1.0, 0.0)
