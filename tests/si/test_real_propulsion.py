"""Self-propelled motions in SI units: groups, powers, scaling, command line."""

import json
import math

import numpy as np
import pytest

import microslip
from microslip.app import cli
from microslip.foundation.number_text import number_text

EIGHT = "elliptic:forward_cycles=2,phase=0"
PRESSED = "normal:forward=1,phase=150"
BALL = {"radius": 5e-3, "load": 10.0, "mu": 0.3, "young": 210e9, "nu": 0.0}
CONTACT_RADIUS = (0.75 * 10.0 * 5e-3 / 210e9) ** (1.0 / 3.0)
U_LIM = 3.0 * 0.3 * 10.0 / (4.0 * 2.0 * 105e9 * CONTACT_RADIUS)
"""u_lim is 3 mu F / (4 G* a) with Hertz's a; at nu = 0, G* = 2 G = E."""


@pytest.mark.slow
@pytest.mark.parametrize(("motion", "share"), [(EIGHT, 1.0), (PRESSED, 0.9)])
def test_the_line_is_that_of_the_groups(motion, share):
    """The unit of force is mu F_z, the unit of speed omega u_lim, the unit of power their
    product."""
    frequency = 20e3
    settings = {"amplitude": share * U_LIM, "frequency": frequency, "points": 3}
    real = microslip.predict_propulsion(motion, **BALL, **settings)
    line = microslip.propulsion(motion, share, tolerance=1e-2, points=3)
    assert real.converged and line.converged
    speed = 2.0 * math.pi * frequency * U_LIM
    assert real.amplitude == pytest.approx(share, rel=1e-9)
    assert real.stall_force_N == pytest.approx(3.0 * line.stall_force, rel=1e-6)
    assert real.no_load_speed_m_s == pytest.approx(speed * line.no_load_velocity, rel=1e-6)
    assert real.force_N == pytest.approx(3.0 * line.force, rel=1e-6, abs=1e-9)
    assert real.power_in_W == pytest.approx(3.0 * speed * line.power_in, rel=1e-6)
    assert real.power_out_W == pytest.approx(real.force_N * real.speed_m_s)
    assert real.efficiency == pytest.approx(real.power_out_W / real.power_in_W)
    assert np.all(real.power_in_W > real.power_out_W)


@pytest.mark.slow
def test_holding_forces_are_in_newtons():
    """Holding forces are 3 N, mu F_z, times the dimensionless ones; the text has their errors."""
    real = microslip.predict_propulsion(EIGHT, **BALL, amplitude=0.5 * U_LIM, frequency=20e3)
    line = microslip.propulsion(EIGHT, 0.5, tolerance=1e-2)
    for name in ("low", "high"):
        force = getattr(real, f"holding_force_{name}_N")
        error = getattr(real, f"holding_force_{name}_error_N")
        assert force == pytest.approx(3.0 * getattr(line, f"holding_force_{name}"), rel=1e-6)
        assert error == pytest.approx(3.0 * getattr(line, f"holding_force_{name}_error"), rel=1e-3)
        assert number_text(force, error, "N") in str(real)


def words(motion, **more):
    settings = {"radius": "5 mm", "load": "10 N", "mu": "0.3", "young": "210 GPa", "nu": "0"}
    settings |= {"amplitude": f"{U_LIM} m", "frequency": "20 kHz"} | more
    named = [f"--{name}={value}" for name, value in settings.items() if value is not None]
    return ["predict", motion, "--propulsion", *named]


def test_the_command_line_says_the_same(capsys):
    assert cli.main([*words(EIGHT, points="3"), "--json"]) == 0
    message = json.loads(capsys.readouterr().out)
    result = microslip.predict_propulsion(EIGHT, **BALL, amplitude=U_LIM, frequency=20e3, points=3)
    assert message["force_N"] == pytest.approx(result.force_N.tolist())
    assert cli.main(words(EIGHT, points="3")) == 0
    assert capsys.readouterr().out.split("\n\n")[1] == f"{result}\n".split("\n\n")[1]
    stall = number_text(result.stall_force_N, result.stall_force_error_N, "N")
    assert f"\nstall force       {stall}\n" in str(result)
    rows = [row for row in str(result).splitlines() if " +- " in row and row.startswith("  ")]
    assert number_text(result.force_N[1], result.force_error_N[1]) in rows[1]
