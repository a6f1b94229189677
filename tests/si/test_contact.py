"""Contacts in SI units: Hertz's theory, other shapes, and dimensionless groups, by hand."""

import math

import pytest
from scipy.integrate import dblquad, quad
from stubs.si_contact import BALL
from stubs.si_contact import contact as contact_of

from microslip.si.materials import Material
from microslip.theory import hertz

STEEL = Material(210e9, 0.3)
SPHERE = contact_of(**BALL)


def elliptic(across):
    return contact_of(**BALL, radius_across=across)


def of_size(size, pressure, load=10.0):
    inputs = {name: one for name, one in BALL.items() if name != "radius"} | {"load": load}
    return contact_of(**inputs, contact_radius=size, pressure=pressure)


# Spheres


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.5])
def test_one_elastic_body_is_the_papers_contact(poisson):
    """The moduli follow from Eq 3, and the integral of Hertz's pressure is the load."""
    contact = contact_of(young=3e9, nu=poisson, radius=0.01, load=7.0, mu=0.4)
    shear_modulus = 3e9 / (2 * (1 + poisson))
    assert contact.E_star == pytest.approx(3e9 / (1 - poisson**2))
    assert contact.G_star == pytest.approx(4 * shear_modulus / (2 - poisson))
    assert contact.poisson == poisson
    a, depth = contact.contact_radius, contact.indentation
    assert 4 / 3 * contact.E_star * math.sqrt(0.01) * depth**1.5 == pytest.approx(7.0)
    share = quad(lambda r: 2 * math.pi * r * math.sqrt(1 - r**2), 0, 1)[0]
    assert contact.largest_pressure * a**2 * share == pytest.approx(7.0)
    # In working units the modulus is G* = 3/4.
    assert contact.G_star * a * contact.u_lim / (0.4 * 7.0) == pytest.approx(hertz.G_STAR)


def test_a_steel_ball_of_10_mm_on_steel_by_hand():
    """E* = 210/(2 * 0.91) GPa; a^3 = 3 * 10 * 0.005 / (4 E*); p0 = 3 F/(2 pi a^2)."""
    contact = contact_of(counterbody=STEEL, **BALL)
    assert contact.E_star == pytest.approx(115.385e9, rel=1e-5)
    assert contact.contact_radius == pytest.approx(68.753e-6, rel=1e-4)
    assert contact.largest_pressure == pytest.approx(1.0101e9, rel=1e-4)
    # u_lim = 3 mu F (2 - nu) / (16 G_half a) with two bodies of G = 80.77 GPa in series
    assert contact.u_lim == pytest.approx(3 * 3.0 * 1.7 / (16 * 40.385e9 * 68.753e-6), rel=1e-4)
    assert contact.mismatch == 0.0
    # a hollow of radius R' leaves the curvature 1/R - 1/R'
    hollow = contact_of(counterbody=STEEL, counter_radius=-10e-3, **BALL)
    assert hollow.contact_radius == pytest.approx(contact.contact_radius * 2 ** (1 / 3))


def test_dundurs_beta_vanishes_for_equal_and_for_incompressible_bodies():
    soft = {"young": 1e9, "nu": 0.3, "radius": 1.0, "load": 1.0, "mu": 1.0}
    others = [Material(young, 0.3) for young in (1e9, 2e9, 1e12)]
    betas = [contact_of(counterbody=other, **soft).mismatch for other in others]
    assert 0.0 == betas[0] < betas[1] < betas[2]
    assert contact_of(**soft).mismatch == pytest.approx(0.5 * (1 - 0.6) / 0.7)
    assert contact_of(**soft | {"nu": 0.5}).mismatch == 0.0


# Ellipses


@pytest.mark.parametrize("across", [1e-3, 2e-2])
def test_the_ellipse_of_two_radii_is_pressed_into_shape(across):
    """The displacement under Hertz's pressure on the ellipse has both curvatures.

    It is 1/(pi E*) times the integral of p/rho in polar coordinates about a point.  Along each
    chord p is a semicircle, whose integral has a closed form.
    """
    contact = elliptic(across)
    ratio, a = contact.ratio, contact.contact_radius
    axes = (a, ratio * a) if across < 5e-3 else (ratio * a, a)
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
    assert contact.largest_pressure == pytest.approx(p0, rel=1e-12)
    assert contact.indentation == pytest.approx(middle, rel=1e-8)
    # u_lim is mu times the displacement in the middle, with G* in place of E*
    u_lim = 0.3 * middle * contact.E_star / contact.G_star
    assert contact.u_lim == pytest.approx(u_lim, rel=1e-8)
    for place, radius in (((0.5 * axes[0], 0.0), 5e-3), ((0.0, 0.5 * axes[1]), across)):
        fall = sum(one * one for one in place) / (2.0 * radius)
        assert middle - displacement(*place) == pytest.approx(fall, rel=1e-6)


CIRCLES = [
    (elliptic(5e-3 * 1.0001), 1e-4),
    (elliptic(5e-3), 1e-12),
    (of_size(SPHERE.contact_radius, "hertz"), 1e-12),
]


@pytest.mark.parametrize(("contact", "digits"), CIRCLES)
def test_an_ellipse_of_equal_radii_and_a_circle_of_known_size_are_the_sphere(contact, digits):
    for name in ("contact_radius", "radius", "u_lim", "indentation", "largest_pressure"):
        assert getattr(contact, name) == pytest.approx(getattr(SPHERE, name), rel=digits)


# Contacts of known size


LARGEST = {
    "ellipse:ratio=0.05,across=1": 3.0 / (2.0 * math.pi * 0.05),
    # F = p0 2 pi Integral r sqrt(1 - ((r - 3/4) / (1/4))^2) dr = p0 2 pi (3/4) (pi/2) (1/4)
    "ring:inner=0.5": 16.0 / (3.0 * math.pi**2),
    "power:exponent=1": math.inf,
    # n x^(n - 2) integrated from 0 to 1, times G*/pi = (n + 1) / (2 n pi)
    "power:exponent=1.5": 2.5 / math.pi,
}


@pytest.mark.parametrize("name", LARGEST)
def test_the_largest_pressure_is_that_of_the_closed_form(name):
    expected = LARGEST[name] * 10.0 / 1e-8
    assert of_size(1e-4, name).largest_pressure == pytest.approx(expected, rel=1e-7)


@pytest.mark.parametrize(("grid", "mean_height"), [("cells", 4.0), ("samples", 1.0)])
def test_the_largest_pressure_of_a_file_is_its_largest_value(grid, mean_height, tmp_path):
    """A single nonzero value is the mean over a cell, or the height of a pyramid."""
    rows = [f"{x},{y},{5.0 * (x == y == 0)}" for x in (-1, 0, 1) for y in (-1, 0, 1)]
    path = tmp_path / "one.csv"
    path.write_text("\n".join(["forward,lateral,pressure", *rows]))
    contact = of_size(1e-4, f"file:{path},grid={grid}")
    # the load is 5 step^2 for both; a is half a step for a cell, and one step for a pyramid
    assert contact.largest_pressure == pytest.approx(10.0 / 1e-8 / mean_height, rel=1e-12)


def test_u_lim_of_a_cone_is_that_of_its_depth():
    """The load of a cone is E* a d (Sneddon), and u_lim = mu d E*/G* for all indenters."""
    contact = of_size(1e-4, "power:exponent=1")
    depth = contact.load / (contact.E_star * 1e-4)
    assert contact.indentation == pytest.approx(depth, rel=1e-6)
    expected = contact.mu * depth * contact.E_star / contact.G_star
    assert contact.u_lim == pytest.approx(expected, rel=1e-6)


# Groups


def test_dimensionless_groups_by_hand():
    contact = contact_of("transverse", **BALL, speed=1e-3, amplitude=1e-6, frequency=20e3)
    assert contact.velocity == pytest.approx(1e-3 / (2 * math.pi * 20e3 * contact.u_lim))
    assert contact.amplitude == pytest.approx(1e-6 / contact.u_lim)
    spin = contact_of("continuous-bore", **BALL, speed=1e-3, rotation=2.0)
    assert spin.velocity == pytest.approx(1e-3 / (2.0 * spin.contact_radius), rel=1e-15)
    assert spin.amplitude is None


def test_the_unit_of_a_bore_leaves_half_the_radius_sticking():
    """An angle of D(1/2) mu F_z/(pi G a^2) has the stick radius a/2 (Eq 24)."""
    for other in (None, STEEL, Material(70e9, 0.2)):
        contact = contact_of(counterbody=other, **BALL)
        a = contact.contact_radius
        angle = 3 * 0.3 * 10.0 / (4 * math.pi * contact.G * a**2) * hertz.D_half()
        moving = {"speed": 1e-3, "amplitude": angle, "frequency": 100.0}
        bore = contact_of("bore", counterbody=other, **BALL, **moving)
        assert bore.amplitude == pytest.approx(1.0)
        assert bore.velocity == pytest.approx(1e-3 / (2 * math.pi * 100.0 * angle * a))


@pytest.mark.parametrize(
    ("label", "sizes", "expected", "largest"),
    [
        ("elliptic", {"amplitude": 2.0, "forward_amplitude": 1.0}, (1.0, 0.5), 2.0),
        ("transverse-bore", {"amplitude": 1.0, "rotation_amplitude": 0.0}, (1.0, 0.0), 1.0),
        ("normal", {"amplitude": 0.2, "load_amplitude": 5.0}, (0.4, 1.0), 0.5),
        ("normal", {"forward_amplitude": 0.5, "load_amplitude": 2.5}, (1.0, 0.5), 0.5),
    ],
)
def test_amplitudes_are_shares_of_the_largest(label, sizes, expected, largest):
    units = {"amplitude": SPHERE.u_lim, "forward_amplitude": SPHERE.u_lim}
    parts = {name: size * units.get(name, 1.0) for name, size in sizes.items()}
    moving = {"speed": 1e-3, "frequency": 1e3, "phase": 0.5 * math.pi}
    contact = contact_of(label, **BALL, **moving, **parts)
    name, _, text = contact.motion.partition(":")
    result = {k: float(v) for k, v in (part.split("=") for part in text.split(","))}
    assert name == label and result.pop("phase") == pytest.approx(90.0)
    parts = {"forward": "forward", "rotation": "angle", "load": "load", "amplitude": "lateral"}
    names = [parts[one.partition("_")[0]] for one in sizes]
    assert result == pytest.approx(dict(zip(names, expected, strict=True)))
    assert contact.amplitude == pytest.approx(largest)
    assert contact.velocity == pytest.approx(1e-3 / (2e3 * math.pi * SPHERE.u_lim))
