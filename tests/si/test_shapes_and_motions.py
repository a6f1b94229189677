"""Contacts of other shapes and motions with several oscillations, in SI units."""

import json
import math
import sys

import pytest
from scipy.integrate import dblquad, quad
from scipy.optimize import minimize_scalar
from scipy.special import ellipk
from stubs.si_contact import BALL as SPHERE_OF_STEEL
from stubs.si_contact import contact as contact_of

import microslip
from microslip import motions
from microslip.app import cli
from microslip.foundation.errors import InputError
from microslip.motions import by_name
from microslip.si.contact import ellipse_of_radii
from microslip.si.warnings import warnings_of

BALL = contact_of(**SPHERE_OF_STEEL)
ASKED = {"material": "steel", "load": "10 N", "mu": 0.3, "speed": "10 mm/s"}
ASKED |= {"amplitude": "0.3 um", "frequency": "20 kHz", "tolerance": 0.01}
SPHERE = ASKED | {"radius": "5 mm"}


def elliptic(across):
    return contact_of(**SPHERE_OF_STEEL, radius_across=across)


def of_size(size, pressure, load=10.0):
    inputs = {n: x for n, x in SPHERE_OF_STEEL.items() if n != "radius"} | {"load": load}
    return contact_of(**inputs, contact_radius=size, pressure=pressure)


# Ellipses


@pytest.mark.parametrize("across", [1e-3, 2e-2])
def test_the_ellipse_of_two_radii_is_pressed_into_shape(across):
    """The displacement under Hertz's pressure on the ellipse has both curvatures.

    It is 1/(pi E*) times the integral of p/rho in polar coordinates about a point.  Along each
    chord p is a semicircle, whose integral has a closed form.
    """
    contact = elliptic(across)
    ratio = ellipse_of_radii(5e-3, across)[0]
    along_forward = across < 5e-3
    a = contact.contact_radius
    axes = (a, ratio * a) if along_forward else (ratio * a, a)
    p0 = 1.5 * contact.load / (math.pi * axes[0] * axes[1])

    def displacement(x, y):
        def integrand(_, angle):
            c, s = math.cos(angle) / axes[0], math.sin(angle) / axes[1]
            alpha = c * c + s * s
            beta = c * x / axes[0] + s * y / axes[1]
            gamma = 1.0 - (x / axes[0]) ** 2 - (y / axes[1]) ** 2
            # integral of sqrt(gamma - 2 beta s - alpha s^2) over the chord
            return 0.5 * math.pi * (gamma + beta * beta / alpha) / math.sqrt(alpha)

        result = dblquad(integrand, 0.0, math.pi, 0.0, 1.0, epsabs=0.0, epsrel=1e-10)[0]
        return p0 * result / (math.pi * contact.E_star)

    middle = displacement(0.0, 0.0)
    assert contact.indentation == pytest.approx(middle, rel=1e-8)
    for place, radius in (((0.5 * axes[0], 0.0), 5e-3), ((0.0, 0.5 * axes[1]), across)):
        fall = sum(one * one for one in place) / (2.0 * radius)
        assert middle - displacement(*place) == pytest.approx(fall, rel=1e-6)


def test_an_ellipse_of_equal_radii_is_the_circle():
    near = elliptic(5e-3 * 1.0001)
    for name in ("contact_radius", "u_lim", "indentation", "largest_pressure"):
        assert getattr(near, name) == pytest.approx(getattr(BALL, name), rel=1e-4)
    same = elliptic(5e-3)
    assert same.pressure == "hertz" and same.u_lim == pytest.approx(BALL.u_lim, rel=1e-12)


def test_u_lim_of_an_ellipse_is_what_full_slip_displaces_its_middle():
    """u_lim is mu times the displacement under the pressure, with G* in place of E*."""
    contact = elliptic(2e-2)
    m = 1.0 - ellipse_of_radii(5e-3, 2e-2)[0] ** 2
    by_hand = 1.5 * 0.3 * 10.0 * ellipk(m) / (math.pi * contact.G_star * contact.contact_radius)
    assert contact.u_lim == pytest.approx(by_hand, rel=1e-10)


# Sizes that are given


def test_a_circle_of_given_size_is_the_sphere_that_makes_it():
    contact = of_size(BALL.contact_radius, "hertz")
    for name in ("radius", "u_lim", "indentation", "largest_pressure"):
        assert getattr(contact, name) == pytest.approx(getattr(BALL, name), rel=1e-12)


def quartic(r):
    """Pressure of an indenter r^4 divided by F/a^2: (5/2 pi) (s - 2 s^3/3), s^2 = 1 - r^2."""
    s = math.sqrt(1.0 - r * r)
    return 2.5 / math.pi * (s - 2.0 * s**3 / 3.0)


def flat_end(r, b=0.8):
    """Pressure of a punch that is flat up to b, divided by F/a^2, by Abel's integral (Sneddon)."""

    def slope(x):
        return 2.0 * math.sqrt(max(x * x - b * b, 0.0)) - b * math.acos(min(b / x, 1.0))

    def abel(s):  # with x^2 = r^2 + s^2 the integrand has no root
        x = math.hypot(r, s)
        return slope(x) / x

    first = math.sqrt(max(b * b - r * r, 0.0))
    top = quad(abel, first, math.sqrt(1.0 - r * r), epsabs=0.0, epsrel=1e-12)[0]
    work = quad(lambda x: x * slope(x), b, 1.0, epsabs=0.0, epsrel=1e-12)[0]
    return top / (2.0 * math.pi * work)


def largest_of(function, low, high):
    result = minimize_scalar(lambda r: -function(r), bounds=(low, high), method="bounded")
    return -result.fun


LARGEST = {
    "ellipse:ratio=0.3": 3.0 / (2.0 * math.pi * 0.3),
    "ellipse:ratio=0.05,across=1": 3.0 / (2.0 * math.pi * 0.05),
    # F = p0 2 pi Integral r sqrt(1 - ((r - 3/4) / (1/4))^2) dr = p0 2 pi (3/4) (pi/2) (1/4)
    "ring:inner=0.5": 16.0 / (3.0 * math.pi**2),
    "power:exponent=1": math.inf,
    # n x^(n - 2) integrated from 0 to 1, times G*/pi = (n + 1) / (2 n pi)
    "power:exponent=1.5": 2.5 / math.pi,
    "power:exponent=2": 1.5 / math.pi,
    "power:exponent=4": largest_of(quartic, 0.0, 1.0),
    "punch:flat=0.8": largest_of(flat_end, 0.5, 0.99),
}


@pytest.mark.parametrize("name", LARGEST)
def test_the_largest_pressure_is_that_of_the_closed_form(name):
    contact = of_size(1e-4, name)
    expected = LARGEST[name] * BALL.load / 1e-8
    assert contact.largest_pressure == pytest.approx(expected, rel=1e-7)


def test_the_largest_pressure_of_a_hertzian_ellipse():
    contact = elliptic(2e-2)
    ratio, _ = ellipse_of_radii(5e-3, 2e-2)
    area = math.pi * ratio * contact.contact_radius**2
    assert contact.largest_pressure == pytest.approx(1.5 * BALL.load / area, rel=1e-12)


@pytest.mark.parametrize(("grid", "mean_height"), [("cells", 4.0), ("samples", 1.0)])
def test_the_largest_pressure_of_a_file_is_its_largest_value(grid, mean_height, tmp_path):
    """A single nonzero value is the mean over a cell, or the height of a pyramid."""
    rows = [f"{x},{y},{5.0 * (x == y == 0)}" for x in (-1, 0, 1) for y in (-1, 0, 1)]
    path = tmp_path / "one.csv"
    path.write_text("\n".join(["forward,lateral,pressure", *rows]))
    contact = of_size(1e-4, f"file:{path},grid={grid}")
    # the load is 5 step^2 for both; a is half a step for a cell, and one step for a pyramid
    assert contact.largest_pressure == pytest.approx(BALL.load / 1e-8 / mean_height, rel=1e-12)


UNIFORM = "".join(f"{x},{y},5\n" for x in range(40) for y in range(20))
"""A pressure of 5 on 40 x 20 cells: half the longer side is 20, and the load is 4000."""


MM, UM = (f"forward [{unit}],lateral [{unit}],pressure [MPa]" for unit in ("mm", "um"))
NO_PRESSURE, NO_LENGTH = "forward [mm],lateral [mm],pressure", "forward,lateral,pressure [MPa]"


@pytest.mark.parametrize(
    ("heading", "options", "size", "load", "differences"),
    [
        (MM, "", 20e-3, 4.03e3, ()),
        (MM, "", 20e-3, 4.1e3, ("load",)),
        (MM, "", 40e-3, 4e3, ("contact radius",)),
        (MM, "", 2e-3, 4e6, ("contact radius", "load")),
        (UM, "", 20e-6, 4e-3, ()),
        (NO_PRESSURE, "", 20e-3, 3e3, ()),
        (NO_PRESSURE, "", 40e-3, 3e3, ("contact radius",)),
        (NO_LENGTH, "", 40e-3, 3e3, ()),
        ("", ",pitch=1 mm", 20e-3, 4e3, ()),
        ("", ",pitch=1 mm", 10e-3, 4e3, ("contact radius",)),
        ("", ",pitch=1", 10e-3, 4e3, ()),
    ],
)
def test_a_pressure_file_whose_units_contradict_the_inputs_is_reported(
    heading, options, size, load, differences, tmp_path
):
    text = f"{heading}\n{UNIFORM}" if heading else 40 * f"{20 * '5 '}\n"
    (tmp_path / "pad.csv").write_text(text)
    contact = of_size(size, f"file:{tmp_path / 'pad.csv'}{options}", load)
    texts = [text for text in warnings_of(contact, 0.0) if "pressure file" in text]
    assert [text.split(" is ")[0].removeprefix("the ") for text in texts] == [*differences]


def test_a_prediction_warns_of_a_pressure_file_that_contradicts_the_load(tmp_path):
    (tmp_path / "pad.csv").write_text(f"forward [um],lateral [um],pressure [MPa]\n{UNIFORM}")
    pad = {"pressure": f"file:{tmp_path / 'pad.csv'}", "contact_radius": "20 um"}
    rigid = {"speed": "1 km/s"}
    warnings = microslip.predict("transverse", **ASKED | pad | rigid).warnings
    (text,) = [text for text in warnings if "file" in text]
    assert text.startswith("the load is 10 N, but 4 mN in the pressure file")
    right = ASKED | pad | rigid | {"load": "4 mN"}
    assert not any("file" in text for text in microslip.predict("transverse", **right).warnings)


def test_a_cone_yields_at_its_tip_and_says_so_once():
    cone = {"contact_radius": "0.1 mm", "pressure": "power:exponent=1"}
    for hardness in ({}, {"hardness": "7 GPa"}):
        result = microslip.predict("transverse", **ASKED | cone | hardness)
        assert result.largest_pressure_Pa == math.inf
        assert "infinite" in str(result)
        (about,) = [text for text in result.warnings if "pressure" in text and "tip" in text]
        mean = 10.0 / (math.pi * 1e-8)
        assert f"the mean pressure is {float(f'{mean / 1e6:.2g}'):g} MPa" in about
        texts = [*result.warnings, *result.not_checked]
        assert not any("inf" in text.replace("infinite", "") for text in texts)
        assert not any("stay elastic" in text for text in texts)


def test_u_lim_of_a_cone_is_that_of_its_depth():
    """The load of a cone is E* a d (Sneddon), and u_lim = mu d E*/G* for all indenters."""
    contact = of_size(1e-4, "power:exponent=1")
    depth = contact.load / (contact.E_star * 1e-4)
    assert contact.indentation == pytest.approx(depth, rel=1e-6)
    expected = contact.mu * depth * contact.E_star / contact.G_star
    assert contact.u_lim == pytest.approx(expected, rel=1e-6)


def test_a_prediction_under_another_pressure_is_what_the_solver_says():
    pressure = "power:exponent=4"
    shape = {"contact_radius": "0.1 mm", "pressure": pressure}
    result = microslip.predict("transverse", **ASKED | shape)
    u_lim = of_size(1e-4, pressure).u_lim
    point = 10e-3 / (2.0 * math.pi * 20e3 * u_lim), 0.3e-6 / u_lim
    settings = {"pressure": pressure, "poisson": 0.3, "tolerance": 1e-2}
    assert result.mu_macro == microslip.solve("transverse", *point, **settings).mu_macro
    assert result.pressure == pressure and result.contact_radius_m == 1e-4


# Motions in several ways


@pytest.mark.parametrize(
    ("label", "sizes", "expected", "largest"),
    [
        ("elliptic", (2.0, 1.0, None, None), {"lateral": 1.0, "forward": 0.5}, 2.0),
        ("elliptic", (0.0, 3.0, None, None), {"lateral": 0.0, "forward": 1.0}, 3.0),
        ("transverse-bore", (1.0, None, 0.0, None), {"lateral": 1.0, "angle": 0.0}, 1.0),
        ("normal", (0.2, None, None, 5.0), {"lateral": 0.4, "load": 1.0}, 0.5),
        ("normal", (None, 0.5, None, 2.5), {"forward": 1.0, "load": 0.5}, 0.5),
    ],
)
def test_amplitudes_are_shares_of_the_largest(label, sizes, expected, largest):
    along = [None if size is None else size * BALL.u_lim for size in sizes[:2]]
    parts = {"forward_amplitude": along[1], "rotation_amplitude": sizes[2]}
    parts |= {"load_amplitude": sizes[3], "phase": 0.5 * math.pi}
    moving = {"speed": 1e-3, "amplitude": along[0], "frequency": 1e3}
    contact = contact_of(label, **SPHERE_OF_STEEL, **moving, **parts)
    name, _, text = contact.motion.partition(":")
    result = {k: float(v) for k, v in (part.split("=") for part in text.split(","))}
    assert name == label and result.pop("phase") == pytest.approx(90.0)
    assert result == pytest.approx(expected)
    velocity, amplitude = contact.velocity, contact.amplitude
    assert amplitude == pytest.approx(largest)
    assert velocity == pytest.approx(1e-3 / (2e3 * math.pi * BALL.u_lim))


def test_a_motion_in_several_ways_of_which_one_is_nothing_is_the_other():
    plain = microslip.predict("transverse", **SPHERE)
    for motion, other in (
        ("elliptic", {"forward_amplitude": 0.0}),
        ("transverse-bore", {"rotation_amplitude": "0 deg"}),
    ):
        result = microslip.predict(motion, **SPHERE | other)
        error = plain.mu_macro_error + result.mu_macro_error
        assert result.mu_macro == pytest.approx(plain.mu_macro, abs=error)
        assert result.velocity == plain.velocity and result.amplitude == plain.amplitude


@pytest.mark.long
def test_an_oscillating_load_alone_is_its_closed_form():
    """The static limit is 1 - A for an amplitude A of the load, here 0.5."""
    request = {k: v for k, v in SPHERE.items() if k != "amplitude"}
    result = microslip.predict("normal", **request | {"load_amplitude": "5 N"})
    assert result.mu_static == pytest.approx(0.5, abs=result.mu_static_error)
    assert result.mu_macro > result.mu_static and result.load_amplitude_N == 5.0


# Motions from files

OWN_BORE = """from dataclasses import dataclass

from microslip.motions.named import Bore


@dataclass(frozen=True)
class OwnBore(Bore):
    summary = "turning as it likes"
"""


@pytest.fixture
def own(tmp_path):
    """A motion from a file: a copy of the bore."""
    registry, path = dict(by_name.MOTIONS), list(motions.__path__)
    (tmp_path / "own_bore.py").write_text(OWN_BORE)
    by_name.find(tmp_path)
    yield
    by_name.MOTIONS.clear()
    by_name.MOTIONS.update(registry)
    motions.__path__[:] = path
    del sys.modules["microslip.motions.own_bore"]


def test_a_motion_of_ones_own_has_the_units_of_its_kind(own, capsys):
    spin = SPHERE | {"amplitude": "0.2 deg"}
    result, bore = (microslip.predict(motion, **spin) for motion in ("own-bore", "bore"))
    assert (result.velocity, result.amplitude) == (bore.velocity, bore.amplitude)
    assert result.mu_macro == bore.mu_macro
    assert result.inputs["motion"] == "own-bore: the sphere is turning as it likes"
    with pytest.raises(InputError, match="units of rad"):
        microslip.predict("own-bore", **spin | {"amplitude": "1 um"})
    assert cli.main(["predict", "own-bore", *(f"--{k}={v}" for k, v in spin.items())]) == 0
    assert "0.2 deg = 0.00349066 rad" in capsys.readouterr().out
    point = [f"--velocity={result.velocity!r}", f"--amplitude={result.amplitude!r}"]
    point += [f"--poisson={result.poisson!r}", "--tolerance=0.01", "--json"]
    assert cli.main(["point", "own-bore", *point]) == 0
    assert json.loads(capsys.readouterr().out)["mu_macro"] == result.mu_macro


def test_numbers_after_the_name_of_a_family_are_taken_as_by_solve():
    """An ellipse without a forward oscillation is the transverse motion."""
    line = microslip.predict("elliptic:forward=0,phase=0", **SPHERE)
    assert line.mu_macro == microslip.predict("transverse", **SPHERE).mu_macro


# Bodies that separate


@pytest.mark.long
def test_a_load_amplitude_above_the_load_parts_the_bodies():
    """The mean load is the integral of 10 N + 15 N sin t over its positive part."""
    settings = SPHERE | {"load_amplitude": "15 N", "speed": "1 mm/s", "counterbody": "steel"}
    del settings["amplitude"]
    result = microslip.predict("normal", **settings)
    gone = math.acos(10.0 / 15.0)  # half the phases without contact, around 3 pi/2
    mean = 10.0 * (1.0 - gone / math.pi) + 15.0 * math.sin(gone) / math.pi
    answer = microslip.solve("normal", result.velocity, 1.5, poisson=0.3, tolerance=0.01)
    assert result.mu_macro == answer.mu_macro
    assert result.friction_force_N == pytest.approx(0.3 * mean * result.mu_macro, rel=1e-9)
    assert result.drag_power_W == pytest.approx(1e-3 * result.friction_force_N, rel=1e-12)
    assert sum(f"{mean:.4g} N" in text for text in result.warnings) == 1
    half = microslip.predict("normal", **settings | {"speed": None, "force": 0.15 * mean})
    assert half.force == pytest.approx(0.5, rel=1e-9)
