"""Numbers of the claims against quadrature, other models and the solver."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from stubs import studies_stub
from stubs.claims_stub import configured, result

import microslip
from microslip.answer.period import patches
from microslip.studies import static_limits
from microslip.sweeps import batch
from microslip.theory import hertz
from microslip.theory import paper as theory


def integral(share, stick_radius):
    """Integral of share times friction bound over the area inside a radius."""
    value, _ = quad(
        lambda r: 2 * math.pi * r * float(hertz.friction_bound(r)) * share(r),
        0,
        stick_radius,
        limit=400,
        epsabs=1e-10,
    )
    return value


@pytest.mark.parametrize(
    ("motion", "amplitude"),
    [("transverse", 0.25), ("transverse", 0.75)] + [("bore", a) for a in (0.5, 1.0, 2.0)],
)
def test_what_is_left_of_the_bound_adds_up_to_the_limit_on_rings(motion, amplitude):
    """The remaining shares of the figure agree with a run that uses no closed form."""
    radius = {"transverse": theory.stick_radius_transverse, "bore": theory.bore_stick_radius}[
        motion
    ]
    left = integral(
        lambda r: float(static_limits.left_share(motion, r, amplitude)), float(radius(amplitude))
    )
    model = "radial" if motion == "transverse" else "polar"
    rings = microslip.solve(motion, 0.0, amplitude, model=model)
    assert left == pytest.approx(rings.mu_macro, abs=rings.mu_macro_error)


@pytest.mark.parametrize("amplitude", [4.0, 6.0, 9.0])
def test_the_asymptote_is_what_the_limit_tends_to(amplitude):
    radius = float(theory.bore_stick_radius(amplitude))
    share = integral(lambda r: 2 / math.pi * math.acos(hertz.lubkin_share(r, radius)), radius)
    # the neglected terms are of the order c^2 ln c
    allowed = 3 * radius**2 * abs(math.log(radius))
    assert float(static_limits.asymptote(amplitude)) == pytest.approx(share, rel=allowed + 1e-6)


@pytest.fixture(scope="module")
def data():
    """Dataset of the claims with invented results."""
    return studies_stub.dataset(configured(), "claims", result)


def test_eq_33_tends_to_the_excess_over_the_asymptote_in_the_dataset(data):
    ratio = float(theory.static_bore(9.0)) / float(static_limits.asymptote(9.0)) - 1
    assert float(data["static_asymptote_excess"]) == pytest.approx(ratio, rel=1e-4)


def test_gaps_are_the_largest_on_the_curves(data):
    amplitude = np.linspace(0, 1, 5001)
    gap = theory.static_transverse(amplitude) - theory.static_limit_transverse(amplitude)
    assert float(data["transverse_gap_zone"]) == pytest.approx(gap.max(), abs=1e-5)
    at = float(data["transverse_gap_zone_at"])
    assert at == pytest.approx(amplitude[gap.argmax()], abs=2e-3)


# Single runs and periods


def test_a_single_run_is_what_the_command_line_has_and_is_timed_by_nobody():
    place = {"motion": "transverse", "velocity": "0.1", "amplitude": "0.5", "poisson": "0"}
    sizes = {"cells": 8, "angles": 1, "steps": 32, "tolerance": "0.0001"}
    request = {"kind": "run", "model": "radial", "method": "euler"} | place | sizes
    record, _ = batch.computed(request)
    answer = microslip.solve("transverse", 0.1, 0.5)
    assert record["result"]["converged"]
    assert record["result"]["mu_macro"] == pytest.approx(answer.mu_macro, abs=0.03)
    assert "seconds" not in record["result"]
    assert batch.computed(request)[0] == record


@pytest.mark.parametrize("motion", ["bore", "transverse"])
def test_patches_are_shares_of_a_period(motion):
    sizes = {"cells": 12, "angles": 8, "steps": 32}
    result = patches(motion, 0.01, 0.7, **sizes)
    whole = microslip.period(motion, 0.01, 0.7, **sizes)
    assert result["area"].sum() == pytest.approx(math.pi)
    # areas times pressure is the load, areas times traction the force
    assert (result["area"] * whole.bound).sum() == pytest.approx(1.0, abs=2e-3)
    force = whole.traction_forward @ result["area"]
    assert force == pytest.approx(whole.force_forward, abs=2e-3)
    sticking = (~whole.slips * result["area"]).sum(axis=1) / math.pi
    assert result["stick_right"] + result["stick_left"] == pytest.approx(sticking)
    assert result["least_stick"] == pytest.approx(sticking[1:].min())
    assert result["moment_share"].shape == (4, whole.bound.size)
    least = result["moment_phase"][0]
    assert sticking[np.argmin(np.abs(whole.phase - least))] == result["least_stick"]
    assert result["moment_phase"][2] - least == pytest.approx(math.pi)


@pytest.mark.slow
def test_patches_of_the_slow_bore_lie_where_theory_has_them():
    """At the moment of least stick one side sticks, where |cos angle| exceeds the used share."""
    result = patches("bore", 1e-3, 1.0, cells=24, angles=24, steps=64)
    radius = np.hypot(result["forward_position"], result["lateral_position"])
    stick = float(theory.bore_stick_radius(1.0))
    used = hertz.lubkin_share(np.minimum(radius, stick), stick)
    cosine = result["lateral_position"] / radius
    for moment, side in ((0, -1.0), (2, 1.0)):
        inside = (radius < stick) & (side * cosine > used)
        sticks = result["moment_share"][moment] < 1.0
        wrong = (inside != sticks) * result["area"]
        assert wrong.sum() < 0.15 * (inside * result["area"]).sum()
