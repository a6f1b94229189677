"""Figures of what pulls the contact, from datasets whose numbers are known."""

import numpy as np
import pytest
import xarray as xr

from microslip.report.figures import drawing
from microslip.theory.catalogue import CREEP_FORMS, FORMS

pytestmark = pytest.mark.slow  # for drawing takes a second or two

FORCES = np.linspace(0.1, 0.9, 9)


def creep(scene):
    """A map of the velocity that a rigid contact has above the threshold, 0 below it."""
    amplitude = np.linspace(0.25, 3.0, 6)
    force, across = np.meshgrid(FORCES, amplitude)
    rigid = CREEP_FORMS[scene].function(force, across)
    held = FORMS[scene]["mu_static"].function(amplitude)
    fine = np.linspace(0.25, 3.0, 50)
    moves = force > held[:, None]
    dims = ("amplitude", "force")
    return xr.Dataset(
        {
            "velocity": (dims, np.where(moves, rigid, 0.0)),
            "velocity_error": (dims, np.full(force.shape, 1e-3)),
            "converged": (dims, np.ones(force.shape, np.int8)),
            "velocity_large_amplitude": (dims, rigid),
            "mu_static": ("amplitude", held),
            "mu_static_curve": ("amplitude_curve", FORMS[scene]["mu_static"].function(fine)),
        },
        {"amplitude": amplitude, "force": FORCES, "amplitude_curve": fine, "poisson": 0.0},
        {"scene": scene, "title": scene},
    )


def pulled():
    """Datasets of the figure of drives: friction v / (1 + v), less 0.1 on the softest spring."""
    velocity, stiffness, mass = np.geomspace(1e-3, 10, 7), np.array([0.1, 10.0]), [0.1, 1.0, 10.0]
    mu = velocity / (1 + velocity)
    both = np.stack([mu - 0.1, mu])[:, None]
    dims = ("stiffness", "amplitude", "velocity")
    body = np.full((3, 2, 1, 1), 0.5)
    marks = {"mu_macro_error": 1e-3, "converged": 1}

    def dataset(dims, values, coords):
        every = {key: (dims, np.full(values.shape, value)) for key, value in marks.items()}
        return xr.Dataset({"mu_macro": (dims, values)} | every, coords | {"poisson": 0.0})

    one = {"amplitude": [1.0]}
    return {
        "transverse": dataset(("amplitude", "velocity"), mu[None], one | {"velocity": velocity}),
        "drive_force": xr.Dataset(
            {
                "velocity": (("amplitude", "force"), FORCES[None] / (1 - FORCES[None])),
                "velocity_error": (("amplitude", "force"), np.full((1, 9), 1e-3)),
                "converged": (("amplitude", "force"), np.ones((1, 9))),
            },
            one | {"force": FORCES, "poisson": 0.0},
        ),
        "drive_spring": dataset(dims, both, one | {"stiffness": stiffness, "velocity": velocity}),
        "drive_body": dataset(
            ("mass", *dims),
            body,
            one | {"mass": mass, "stiffness": stiffness, "velocity": [0.1]},
        ),
    }


def by_gid(axes, gid):
    return [artist for artist in axes.get_children() if artist.get_gid() == gid]


def test_maps_of_creep_show_threshold_rest_and_the_rigid_contact():
    datasets = {"creep_transverse": creep("transverse"), "creep_bore": creep("bore")}
    figure = drawing.draw("creep_maps", datasets)
    for axes, dataset in zip(figure.axes, datasets.values(), strict=False):
        (line,) = by_gid(axes, "mu_static")
        held, across = line.get_data()
        assert np.array_equal(held, dataset["mu_static_curve"])
        assert np.array_equal(across, dataset["amplitude_curve"])
        assert by_gid(axes, "stays")
        computed, rigid = by_gid(axes, "contours")[0], by_gid(axes, "velocity_large_amplitude")[0]
        # away from the threshold the two were made equal, and so are the lines
        lines = (levels.get_paths()[1].vertices for levels in (computed, rigid))
        tops = [line[line[:, 1].argmax()] for line in lines]
        assert tops[0] == pytest.approx(tops[1], abs=1e-9)


def test_points_of_a_map_that_did_not_converge_are_marked():
    broken = creep("bore")
    broken["converged"][2, 3] = 0
    figure = drawing.draw(
        "creep_maps", {"creep_transverse": creep("transverse"), "creep_bore": broken}
    )
    plain, marked = (by_gid(axes, "unconverged")[0].get_xydata() for axes in figure.axes[:2])
    assert len(plain) == 0
    assert marked.tolist() == [[FORCES[3], float(broken["amplitude"][2])]]


def test_drives_are_laid_over_each_other():
    datasets = pulled()
    figure = drawing.draw("drives", datasets)
    left, right = figure.axes
    (line,) = by_gid(left, "velocity")
    assert np.array_equal(line.get_ydata(), datasets["transverse"]["mu_macro"][0])
    soft, stiff, force = by_gid(left, "computed")
    assert soft.get_ydata() == pytest.approx(stiff.get_ydata() - 0.1)
    # a force has its mean velocity along the axis: here it lies on the curve
    assert force.get_ydata() == pytest.approx(force.get_xdata() / (1 + force.get_xdata()))
    (level,) = by_gid(right, "velocity")
    assert level.get_ydata()[0] == pytest.approx(0.1 / 1.1)


@pytest.mark.parametrize("name", ["creep_maps", "drives"])
def test_what_is_missing_is_named(name):
    datasets = {"creep_transverse": creep("transverse"), "creep_bore": creep("bore")} | pulled()
    last = drawing.FIGURES[name][-1]
    lacking = datasets | {last: datasets[last].drop_vars("converged")}
    with pytest.raises(ValueError, match="converged"):
        drawing.draw(name, lacking)
