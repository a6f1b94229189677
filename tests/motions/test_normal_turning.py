"""Oscillating normal load with a rotation or at nu > 0: modes against rings, and limits."""

import numpy as np
import pytest
from stubs.agreement import assert_agree

import microslip
from microslip.contact.path import make_path
from microslip.motions.by_name import motion_named
from microslip.motions.problem import Problem
from microslip.pressures.hertz import HERTZ
from microslip.solver.discretise import Resolution, contact_of
from microslip.solver.simulate import simulate
from microslip.theory import hertz, paper

TURNING = "normal:angle=1"


def run(motion, velocity, amplitude, model="polar", poisson=0.0, resolution=(24, 8, 96)):
    problem = Problem(motion_named(motion), velocity, amplitude, poisson)
    return simulate(problem, model, Resolution(*resolution), 1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("motion", ["normal", "normal:lateral=1", "normal:forward=1,phase=60"])
def test_modes_find_what_rings_find(motion):
    """At nu = 0, both models are equal at the same resolution, up to the tolerance of the steps."""
    for amplitude in (0.6, 1.3):
        rings, modes = (run(motion, 0.1, amplitude, model) for model in ("radial", "polar"))
        assert rings.converged and modes.converged
        assert modes.mu == pytest.approx(rings.mu, abs=2e-6)


@pytest.mark.long
def test_the_static_limit_is_that_of_rings_too():
    motion = "normal:lateral=1"
    rings = microslip.solve(motion, 0.0, 0.4, model="radial", tolerance=1e-3)
    assert_agree(microslip.solve(motion, 0.0, 0.4, model="polar", tolerance=2e-2), rings)


@pytest.mark.long
def test_a_small_part_changes_little():
    """With almost no oscillation of the load it is the bore, and with almost no rotation the load
    alone."""
    bore = microslip.solve("transverse-bore:lateral=0", 0.1, 0.7)
    assert_agree(microslip.solve("normal:load=0.0001,angle=1", 0.1, 0.7), bore, 1e-4)
    load = microslip.solve("normal", 0.1, 0.7)
    assert_agree(microslip.solve("normal:angle=0.0001", 0.1, 0.7), load, 1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("velocity", [0.5, 5.0, 40.0])
def test_where_all_slides_every_moment_is_a_steady_bore(velocity):
    """The mean is Eq 21 at the current contact radius and rotation rate, weighted with the load."""
    amplitude, share = 60.0, 0.5 / 60.0
    result = microslip.solve(
        f"normal:load={share!r},angle=1,phase=90", velocity, amplitude, tolerance=5e-3
    )
    phase = (np.arange(4000) + 0.5) * np.pi / 2000.0
    load = 1.0 + 0.5 * np.sin(phase)
    rate = np.abs(float(hertz.bore_angle(amplitude)) * np.sin(phase))
    radius = HERTZ.radius(HERTZ.of_load(load))
    steady = paper.bore_forward(velocity / (rate * radius))
    assert result.converged
    # the force follows with a delay of about u_lim, which is a small part of this path
    assert result.mu_macro == pytest.approx(np.mean(load * steady), abs=0.015)


@pytest.mark.long
def test_which_way_it_turns_does_not_matter():
    one, other = (
        microslip.solve(f"normal:angle=1,phase={p}", 0.1, 0.6, tolerance=3e-3) for p in (40, 220)
    )
    assert_agree(one, other)


@pytest.mark.slow
@pytest.mark.parametrize("poisson", [0.0, 0.4])
def test_the_least_load_is_what_is_left_at_any_nu(poisson):
    result = microslip.solve("normal", 0.0, 0.6, poisson=poisson, model="polar")
    assert result.converged
    assert result.mu_macro == pytest.approx(0.4, abs=result.mu_macro_error)


@pytest.mark.slow
def test_a_turning_contact_that_lifts_off_has_no_static_friction():
    result = microslip.solve(TURNING, 0.0, 1.2, tolerance=1e-2)
    assert result.converged and result.mu_macro <= result.mu_macro_error


@pytest.mark.long
def test_slow_marches_end_in_the_limit():
    """Limit and marches use the same contact and steps, so that a coarse resolution is
    sufficient."""
    still = Problem(motion_named(TURNING), 0.0, 0.5, 0.0)
    limit = simulate(still, "polar", Resolution(16, 4, 64), 1e-5)
    above = [run(TURNING, v, 0.5, resolution=(16, 4, 64)).mu - limit.mu for v in (2e-2, 2.5e-3)]
    assert limit.converged and 0.0 < above[1] < 0.36 * above[0]


@pytest.mark.long
def test_another_indenter_may_turn_under_its_load():
    cone = {"pressure": "power:exponent=1", "tolerance": 5e-3}
    bore = microslip.solve("transverse-bore:lateral=0", 0.1, 0.7, **cone)
    assert_agree(microslip.solve("normal:load=0.0001,angle=1", 0.1, 0.7, **cone), bore, 1e-4)


def test_squares_do_not_know_such_a_load():
    with pytest.raises(ValueError, match="pressure = 'ellipse.*: only cartesian .* load"):
        microslip.solve("normal:angle=1,lateral=1", 0.1, 0.5, pressure="ellipse:ratio=0.5")
    with pytest.raises(ValueError, match="angle = 2: allowed is a share in 0..1"):
        microslip.solve("normal:angle=2", 0.1, 0.5)


@pytest.mark.long
def test_half_a_period_suffices_where_it_is_mirrored():
    name = motion_named("normal:angle=1,normal_cycles=2")
    assert name.half_period_mirror and name.half_disc
    assert not motion_named(TURNING).half_period_mirror
    motion = Problem(name, 0.1, 0.8, 0.2)
    contact = contact_of(motion, "polar", Resolution(12, 8, 64))
    path = make_path(motion.displacement, np.linspace(-0.25, 1.75, 257) * np.pi, depth=motion.depth)
    state = np.zeros((2, 8, 12))
    for _ in range(12):
        march = contact.march(path, state, 1e-8)
        state = march.state
    half = run(name.name, 0.1, 0.8, poisson=0.2, resolution=(12, 8, 128))
    assert path.mean(march.forces[:, 0]) == pytest.approx(half.mu, abs=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("motion", "finer"),
    [
        ("normal", 1e-3),
        *(
            pytest.param(*p, marks=pytest.mark.long)
            for p in (("normal:lateral=1", 1e-3), (TURNING, 3e-3))
        ),
    ],
)
def test_errors_are_within_their_estimates_by_finer_runs(motion, finer):
    loose, tight = (
        microslip.solve(motion, 0.08, 0.7, poisson=0.4, tolerance=t) for t in (1e-2, finer)
    )
    assert loose.model == "polar"
    assert_agree(loose, tight)
    assert loose.mu_macro_error <= 1e-2 and tight.mu_macro_error <= finer
