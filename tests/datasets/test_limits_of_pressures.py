"""Closed forms for other pressures than Hertz's."""

import numpy as np
import pytest

import microslip
from microslip.config.settings import Sweep
from microslip.datasets import theory_limits
from microslip.datasets.catalogue import FORMS
from microslip.scene.by_name import pressure_named
from microslip.theory import indenters

AMPLITUDE = np.array([0.0, 0.2, 0.6, 0.9, 1.0, 1.5])


def value(motion, name, row, *at):
    return theory_limits.formulas(motion, name)[row].function(*(np.array(x) for x in at))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["power", "ellipse:ratio=0.3"])
@pytest.mark.parametrize("motion", ["transverse", "bore"])
def test_under_the_power_2_and_along_an_ellipse_they_are_the_papers(motion, name):
    rows = theory_limits.formulas(motion, name)
    assert ("mu_static" in rows) == (motion == "transverse" or name == "power")
    for row in ("mu_static_stick_zone", "mu_static"):
        if row in rows:
            sphere = FORMS[motion][row].function(AMPLITUDE)
            assert rows[row].function(AMPLITUDE) == pytest.approx(sphere, abs=1e-8)


@pytest.mark.parametrize("name", ["power:exponent=1", "punch", "power:exponent=8"])
def test_eq_9_is_the_load_where_the_displacement_reaches(name):
    """The stick radius is interpolated in the depth of the indenter; the load is a quadrature."""
    pressure = pressure_named(name)
    result = value("transverse", name, "mu_static_stick_zone", 0.4)
    radius = np.linspace(0.0, 1.0, 100001)
    stick = radius[np.searchsorted(pressure.depth(radius), 0.6)]
    assert result == pytest.approx(
        indenters.static_stick_zone_of(lambda r: float(pressure.bound(r)), stick), abs=1e-4
    )


@pytest.mark.parametrize("name", ["power:exponent=1", "ellipse"])
def test_the_closed_form_along_a_line_has_both_of_its_limits(name):
    rows = theory_limits.formulas("longitudinal", name)
    whole, static = rows["mu_closed_form"].function, rows["mu_static"].function
    # for a large amplitude x friction has the rigid limit (2/pi) arcsin(v/x)
    rigid = 2.0 / np.pi * np.arcsin(0.3)
    assert whole(np.array(300.0), np.array(1000.0)) == pytest.approx(rigid, abs=2e-3)
    assert whole(np.array(1e-7), np.array(0.5)) == pytest.approx(static(np.array(0.5)), abs=1e-3)


@pytest.mark.parametrize("velocity", [0.3, 1.5])
def test_the_forms_of_the_steady_bore_are_those_of_the_solver(velocity):
    solved = microslip.solve("continuous-bore", velocity, pressure="power:exponent=1")
    for row, expected in (("forward", solved.mu_macro), ("torque", solved.mu_torque)):
        result = value("continuous-bore", "power:exponent=1", f"mu_{row}_theory", [velocity])
        assert result == pytest.approx([expected], abs=1e-9)


def test_datasets_of_other_pressures_have_them():
    axes = {"velocity": [0.1, 1.0], "amplitude": [0.2, 0.5]}
    cone = Sweep(motion="transverse", pressure="power:exponent=1", **axes)
    result = theory_limits.variables(cone)
    names = {"mu_large_amplitude", "mu_static_slider", "mu_static_stick_zone", "mu_static"}
    assert names <= result.keys()
    dims, values, attributes = result["mu_static_stick_zone"]
    assert dims == ("amplitude",)
    assert values[1] == pytest.approx(
        indenters.static_stick_zone_of(pressure_named("power:exponent=1").bound, 0.5), abs=1e-6
    )
    assert "Eq 9" in attributes["long_name"]


def test_nothing_is_said_where_nothing_is_known():
    assert theory_limits.formulas("bore", "ring") == {}
    assert "mu_static" not in theory_limits.formulas("transverse", "ring")
    assert theory_limits.formulas("elliptic", "power") == {}
