"""Pressures: integrals, closed forms, marches and text forms."""

import pickle
import re
from dataclasses import fields

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.signal import fftconvolve
from stubs.agreement import assert_agree

import microslip
from microslip.contact.contact import forward_slip
from microslip.contact.path import EULER, make_path
from microslip.contact.registry import MODELS
from microslip.contact.rings import make_rings
from microslip.foundation.errors import InputError
from microslip.scene.by_name import PRESSURES, motion_named, pressure_named
from microslip.scene.hertz import Ellipse, Hertz
from microslip.scene.indenters import Indenter, Power
from microslip.scene.named import Transverse
from microslip.scene.pressure import Pressure
from microslip.scene.problem import Problem
from microslip.theory import hertz, indenters, paper

INDENTERS = ["power", "power:exponent=1", "power:exponent=8", "punch", "punch:flat=0.5"]
EXTREME = ["power:exponent=100", "punch:flat=0", "punch:flat=0.99"]
ROUND = ["hertz", *INDENTERS, "ring", "ring:inner=0.9"]
PLANAR = ["ellipse", "ellipse:ratio=0.3,across=1"]


def pushed(name, model, cells, displacement, steps=40):
    """Forward displacements from rest, and the force after each of them."""
    contact = MODELS[model].build(
        Problem(motion_named("longitudinal"), 1.0, 1.0, 0.0, pressure_named(name)), cells, 8, None
    )
    way = np.linspace(0.0, displacement, steps + 1)
    path = make_path(lambda t: (t, 0.0 * t, 0.0 * t), way, EULER)
    start = np.zeros_like(forward_slip(contact))
    return way, contact.march(path, start, 1e-9).forces[:, 0]


# Properties of pressures


@pytest.mark.parametrize("name", ROUND)
def test_a_round_bound_carries_the_load_and_the_full_slip_torque(name):
    pressure = pressure_named(name)
    settings = {"epsabs": 1e-11, "epsrel": 1e-10, "limit": 500}
    parts = [0.0, pressure.inner or 0.5, 0.8, 1.0]
    pairs = list(zip(parts[:-1], parts[1:], strict=True))

    def integral(power):
        def ring(r):
            return 2.0 * np.pi * r**power * float(pressure.bound(r))

        return sum(quad(ring, *pair, **settings)[0] for pair in pairs if pair[1] > pair[0])

    assert integral(1) == pytest.approx(1.0, abs=1e-8)
    assert integral(2) == pytest.approx(pressure.torque, abs=1e-8)


@pytest.mark.parametrize("name", ROUND)
def test_rings_carry_the_load_and_the_torque(name):
    pressure = pressure_named(name)
    rings = make_rings(12, 0.95, pressure)
    assert rings.area @ rings.bound == pytest.approx(1.0, abs=1e-10)
    assert rings.area @ (rings.bound * rings.radius) == pytest.approx(pressure.torque, abs=1e-10)
    middle = np.sin(0.5 * (rings.psi[1:] + rings.psi[:-1]))
    assert np.all(np.abs(rings.radius - middle) <= np.diff(np.sin(rings.psi)))
    assert np.sin(rings.psi[0]) == pytest.approx(pressure.inner)


@pytest.mark.parametrize("cells", [15, 32])
@pytest.mark.parametrize("name", [*ROUND, *PLANAR])
def test_squares_carry_the_load_and_the_torque(name, cells):
    pressure = pressure_named(name)
    loads = pressure.cell_loads(cells)
    centres = (np.arange(cells) + 0.5) * 2.0 / cells - 1.0
    forward, lateral = (half * centres for half in pressure.half_widths)
    lever = np.hypot(forward[:, None], lateral)
    assert loads.shape == (cells, cells)
    assert loads.min() >= 0.0
    assert loads.sum() == pytest.approx(1.0, abs=1e-12)
    assert np.sum(loads * lever) == pytest.approx(pressure.torque, abs=0.6 / cells**2 + 1e-3)
    assert loads == pytest.approx(loads[::-1], abs=1e-12)
    assert loads == pytest.approx(loads[:, ::-1], abs=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("name", [*ROUND, *PLANAR])
def test_u_lim_is_the_largest_displacement_under_full_slip(name):
    """Displacements are sums over a fine grid, with a closed form for the influence of a cell on
    itself (Love 1929)."""
    pressure = pressure_named(name)
    result = []
    for n in (81, 161):
        a, b = (2.0 / n * half for half in pressure.half_widths)
        offsets = np.arange(1 - n, n)
        distance = np.hypot(a * offsets[:, None], b * offsets)
        own = 2.0 * (a * np.arcsinh(b / a) + b * np.arcsinh(a / b)) / (a * b)
        kernel = np.where(distance > 0.0, 1.0 / np.where(distance > 0.0, distance, 1.0), own)
        loads = pressure.cell_loads(n)
        field = fftconvolve(loads, kernel)[n - 1 : 2 * n - 1, n - 1 : 2 * n - 1]
        result.append(field[loads > 0.0].max() / (np.pi * pressure.G_star))
    assert 2.0 * result[1] - result[0] == pytest.approx(1.0, abs=3e-3)


def test_the_cone_is_loves():
    """p ~ arccosh(1/r); u_lim = mu d E*/G* and F = (E*/2) d a give G* = 1."""
    cone, r = pressure_named("power:exponent=1"), np.array([0.01, 0.3, 0.9])
    assert cone.G_star == pytest.approx(1.0, rel=1e-12)
    assert cone.bound(r) == pytest.approx(np.arccosh(1.0 / r) / np.pi, rel=1e-12)


@pytest.mark.parametrize("name", [*INDENTERS, *EXTREME])
def test_an_indenter_keeps_what_closed_forms_claim(name):
    """The loads of the contact and of smaller contacts are known; closed forms have an error of
    1e-8."""
    pressure, depth = pressure_named(name), np.array([0.2, 0.7, 1.0])
    radius = pressure.radius(depth)
    below = [quad(lambda x: float(pressure.depth(x)), 0.0, c, epsabs=1e-13)[0] for c in radius]
    exact = pressure.stiffness * (radius * depth - below)
    assert pressure.total(depth) == pytest.approx(exact, abs=1e-8)
    assert pressure.total(1.0) == pytest.approx(1.0, abs=1e-8)
    depth = np.array([1e-3, 0.3, 1.0, 2.5])
    assert pressure.depth(pressure.radius(depth)) == pytest.approx(depth, rel=1e-9)
    assert pressure.total(pressure.of_load(depth)) == pytest.approx(depth, rel=1e-9)
    assert pressure.radius(0.0) == pressure.of_load(0.0) == pressure.stick_radius(1.0) == 0.0
    assert pressure.stick_radius(0.3) == pytest.approx(float(pressure.radius(0.7)))


class Depth(Indenter):
    """A class that defines `depth` alone."""

    def depth(self, c):
        return np.asarray(c, float) ** 2.5


def test_an_indenter_needs_no_more_than_its_depth():
    own, exact, r = Depth(), Power(2.5), np.linspace(0.05, 0.95, 7)
    assert own.G_star == pytest.approx(exact.G_star, rel=1e-9)
    assert own.bound(r) == pytest.approx(exact.bound(r), rel=1e-9)
    assert own.of_load(r) == pytest.approx(exact.of_load(r), rel=1e-9)


CONTRADICTIONS = [
    (Depth, "slope", lambda self, c: 3.0 * c**2),
    (Depth, "slope", lambda self, c: 5.0 * c**1.5),
    (Depth, "depth", lambda self, c: 2.0 * c**2),
    (Depth, "radius", lambda self, depth: depth),
    *((Depth, name, lambda self, one: one) for name in ("of_load", "loading")),
    (Depth, "load", lambda self, r, c: r**2),
    (Hertz, "ring_means", lambda self, psi: (1.0, np.sin(psi[1:]))),
    *((Ellipse, name, 1.5) for name in ("G_star", "torque")),
    (Ellipse, "largest", 0.5),
    (Ellipse, "area", 3.0),
    *((Ellipse, "cell_loads", one) for one in (lambda self, n: np.eye(n), lambda self, n: [1.0])),
    (Ellipse, "cell_loads", lambda self, n: np.tile(np.arange(n) * 2.0 / (n - 1) / n**2, (n, 1))),
]


@pytest.mark.parametrize(("base", "name", "value"), CONTRADICTIONS)
def test_attributes_of_an_own_pressure_that_contradict_each_other_are_named(base, name, value):
    kind = type("Own", (base,), {name: value, "__post_init__": lambda self: None})
    with pytest.raises(InputError, match=f"^pressure = 'own': .*{name}.* contradict each other"):
        Problem(Transverse(), 0.1, 0.5, pressure=kind())


# Marches under each pressure


@pytest.mark.parametrize("name", ["hertz", *INDENTERS])
@pytest.mark.parametrize("model", ["radial", "mdr"])
def test_the_first_loading_is_a_smaller_contact_missing(name, model):
    way, force = pushed(name, model, 64, 1.05)
    exact = pressure_named(name).loading(way)
    assert force == pytest.approx(exact, abs=2e-3)
    assert force[-1] == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("name", PLANAR)
def test_an_ellipse_is_loaded_like_a_sphere(name):
    way, force = pushed(name, "cartesian", 32, 1.05, steps=10)
    assert force == pytest.approx(hertz.mindlin_force(way), abs=6e-3)


@pytest.mark.parametrize("name", ["ring", "ring:inner=0.9"])
def test_a_ring_slides_as_a_whole_at_u_lim_and_not_before(name):
    way, force = pushed(name, "radial", 64, 1.1, steps=44)
    assert force[-1] == pytest.approx(1.0, abs=1e-6)
    assert force[way > 1.02].min() > 1.0 - 1e-6
    assert force[way < 0.9].max() < 1.0 - 1e-4


# Closed forms


@pytest.mark.slow
def test_integrals_over_the_record_are_the_closed_forms_of_a_sphere():
    pressure = pressure_named("power")
    for amplitude in (1e-3, 0.25, 0.9):
        result = indenters.static_transverse(pressure, amplitude)
        assert result == pytest.approx(paper.static_limit_transverse(amplitude), abs=1e-9)
        assert 1.0 - pressure.loading(amplitude) == pytest.approx(
            (1.0 - amplitude) ** 1.5, abs=1e-9
        )
    for amplitude in (0.1, 1.0, 3.0):
        result = indenters.static_bore(pressure, float(hertz.bore_angle(amplitude)))
        assert result == pytest.approx(paper.static_limit_bore(amplitude), abs=1e-9)
    r = np.array([0.05, 0.2, 0.399])
    angle = indenters.torsion_angle(pressure, 0.4, 0.3)
    assert angle == pytest.approx(hertz.lubkin_angle(0.4, 0.3), rel=1e-10)
    result = indenters.torsion_traction(pressure, r, 0.4)
    assert result == pytest.approx(hertz.lubkin_traction(r, 0.4), rel=1e-9)


EXACT = [
    ("transverse", 0.0, 0.5, "radial"),
    ("longitudinal", 0.0, 0.5, "radial"),
    ("bore", 0.0, 1.0, "polar"),
    ("longitudinal", 0.01, 0.6, "radial"),
    ("longitudinal", 0.3, 0.6, "radial"),
    ("continuous-bore", 0.6, None, "polar"),  # Eqs 17 and 18
]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["power:exponent=1", "power:exponent=8", "punch"])
@pytest.mark.parametrize(("motion", "velocity", "amplitude", "model"), EXACT)
def test_closed_forms_agree_with_marches(name, motion, velocity, amplitude, model):
    settings = {"pressure": name, "tolerance": 2e-3}
    exact = microslip.solve(motion, velocity, amplitude, pressure=name)
    result = microslip.solve(motion, velocity, amplitude, model=model, **settings)
    assert (exact.model, result.model) == ("closed-form", model)
    assert_agree(result, exact)
    if exact.torque is not None and result.torque is not None:
        assert abs(result.mu_torque - exact.mu_torque) <= result.torque.error + 1e-3


# Models against each other


# Names


@pytest.mark.parametrize(
    ("name", "problem"),
    [
        ("powr", "did you mean power?"),
        ("power:n=1", "unknown number n; allowed: exponent"),
        ("power:exponent=0.5", "exponent = 0.5: allowed is a number in 1..100"),
        ("punch:flat=1", "flat = 1"),
        ("ring:inner=0", "inner = 0"),
        ("ellipse:ratio=2", "ratio = 2"),
        ("ellipse:across=0.5", "across = 0.5"),
        ("file", "file:NAME"),
        (3, "allowed is one of hertz, ellipse, power"),
    ],
)
def test_what_is_no_pressure_is_refused_by_name(name, problem):
    with pytest.raises(ValueError, match=f"pressure = .*{re.escape(problem)}"):
        microslip.solve("transverse", 0.1, 0.5, pressure=name)


@pytest.mark.parametrize("name", PRESSURES)
def test_a_text_is_written_back_without_numbers_that_are_usual(name):
    usual = ",".join(f"{field.name}={field.default:g}" for field in fields(PRESSURES[name]))
    same = pressure_named(f"{name}:{usual}" if usual else name)
    assert str(same) == name and same == PRESSURES[name]() == pickle.loads(pickle.dumps(same))
    assert pressure_named(name) is pressure_named(name)


def test_an_array_is_read_as_the_pressure_that_it_samples():
    """The shear stiffness of an elliptic Hertz contact on cells is that of the closed form."""
    x, y = np.linspace(-1, 1, 201), np.linspace(-0.5, 0.5, 101)
    values = np.sqrt(np.maximum(0.0, 1.0 - x[:, None] ** 2 - (y / 0.5) ** 2))
    read = Pressure.from_array(x, y, values)
    assert read.G_star == pytest.approx(Ellipse(ratio=0.5).G_star, rel=0.01)
    assert read.half_widths == pytest.approx(Ellipse(ratio=0.5).half_widths, rel=0.02)


@pytest.mark.parametrize(
    ("argument", "arrays"),
    [
        ("pressure", ([0, 1], [0, 1], [[1, 2], [3]])),
        ("pressure", ([0, 1], [0, 1], [[1, 2, 3], [1, 2, 3]])),
        ("forward", ("ab", [0, 1], np.ones((2, 2)))),
        ("lateral", ([0, 1], [0, "b"], np.ones((2, 2)))),
    ],
)
def test_what_is_no_array_of_numbers_is_refused_by_the_name_of_the_argument(argument, arrays):
    with pytest.raises(InputError) as raised:
        Pressure.from_array(*arrays)
    assert raised.value.argument == argument
