"""Grading of the rings of slow motions towards the stick zone, and its effect on the error."""

import numpy as np
import pytest

import microslip
from microslip.contact.rings import Focus, make_rings
from microslip.periodic.run import Budget, Spent
from microslip.periodic.static_limit import (
    FINE_RESOLUTION,
    FINE_TOLERANCE,
    LINE_RESOLUTION,
    SWEPT_RESOLUTION,
    TOLERANCE,
    edge_focus,
    stick_edges,
)
from microslip.scene.by_name import motion_named, pressure_named
from microslip.scene.problem import Problem
from microslip.theory import hertz, indenters

RING = "ring:inner=0.5"


def focus_of(motion, velocity, amplitude, model, pressure="hertz"):
    return edge_focus(
        Problem(motion_named(motion), velocity, amplitude, 0.0, pressure_named(pressure)), model
    )


@pytest.mark.parametrize("name", ["power:exponent=1", "power:exponent=8", "punch"])
@pytest.mark.parametrize("amplitude", [0.3, 1.0])
def test_a_bore_sticks_inside_the_radius_of_its_closed_form(name, amplitude):
    (radius,) = focus_of("bore", 0.0, amplitude, "polar", name).radii
    angle = float(hertz.bore_angle(amplitude))
    assert radius == pytest.approx(
        indenters.torsion_stick_radius(pressure_named(name), angle), abs=0.01
    )


@pytest.mark.slow
@pytest.mark.parametrize("amplitude", [0.1, 0.4, 0.8])
def test_finer_rings_find_the_stick_radius_of_mindlin_from_what_coarse_ones_say(amplitude):
    motion = motion_named("transverse")
    limit, exact = Problem(motion, 0.0, amplitude, 0.0), np.sqrt(1.0 - amplitude)
    near = stick_edges(limit, "radial", LINE_RESOLUTION, TOLERANCE)[1]
    assert near == pytest.approx([exact], abs=5e-3)
    _, result = stick_edges(limit, "radial", FINE_RESOLUTION, FINE_TOLERANCE, radii=near)
    assert result == pytest.approx([exact], abs=5e-4)


@pytest.mark.parametrize("count", [4, 48])
@pytest.mark.parametrize("pressure", ["hertz", RING])
def test_an_edge_lies_on_every_radius_and_widths_grow_away_from_it(count, pressure):
    focus = Focus((0.6, 0.9), 0.8)
    psi = make_rings(count, focus, pressure_named(pressure)).psi
    edges = np.sin(psi)
    places = [int(np.argmin(np.abs(edges - radius))) for radius in focus.radii]
    assert len(edges) == count + 1 and np.all(np.diff(edges) > 0.0)
    assert edges[places] == pytest.approx(focus.radii, abs=1e-14)
    widths = np.diff(psi)
    for at in places if count > 4 and pressure == "hertz" else ():
        assert widths[at] < widths[at + 1] and widths[at - 1] < widths[at - 2]


@pytest.mark.parametrize("radii", [(), (0.9, 0.6), (0.5, 0.5), (-0.1,), (0.5, 1.1)])
def test_radii_without_order_or_outside_are_refused(radii):
    with pytest.raises(ValueError, match="allowed are radii in 0..1, increasing"):
        make_rings(8, Focus(radii, 0.5))


@pytest.mark.parametrize(
    ("spent", "bound"), [("work", {"most_work": 1.0}), ("time", {"time_limit": 1e-9})]
)
def test_bounds_of_a_point_hold_for_the_search_of_its_edges(spent, bound):
    calls, place = [], ("normal:lateral=1,angle=1", 0.0, 0.4375)  # it starts with a search
    result = microslip.solve(*place, progress=calls.append, **bound)
    assert calls == [SWEPT_RESOLUTION]  # no other run has started
    assert not result.converged and np.isnan(result.mu_macro)
    assert result.exhausted == spent and "there is no error estimate yet" in result.reason


def test_the_work_of_a_search_counts_whether_it_was_done_before_or_not():
    problem = Problem(motion_named("elliptic"), 0.0, 0.4321, 0.0)
    first, later = Budget(), Budget()
    assert edge_focus(problem, "radial", first) == edge_focus(problem, "radial", later)
    assert first.taken == later.taken and first.taken.work > 0
    with pytest.raises(Spent, match="the work that the point may take"):
        edge_focus(problem, "radial", Budget(most_work=first.taken.work - 1))
