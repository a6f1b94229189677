"""Figures of the studies show the values of their datasets."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_hex
from matplotlib.legend import Legend
from stubs import figures_stub as stub
from stubs.figures_stub import artists, draw, words

from microslip.report.figures import studies

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("without_layout")]


@pytest.fixture(scope="module")
def made():
    """Datasets of the studies by name."""
    return stub.studies()


def panels_of(kind, dataset) -> list:
    """Panels of an accuracy figure with the trials of their points."""
    panels = [axes for axes in draw(kind, dataset).axes if axes.axison]
    points = [dataset["trial_point"].values == str(point) for point in dataset["point"].values]
    return [(one, dataset.isel(trial=own)) for one, own in zip(panels, points, strict=True)]


@pytest.mark.parametrize(
    ("kind", "cost"), [("accuracy_vs_cost", "seconds"), ("accuracy_vs_work", "effort")]
)
def test_every_trial_and_the_front_are_drawn_and_no_failure_is_hidden(kind, cost, made):
    panels = panels_of(kind, made["accuracy"])
    for axes, trials in panels:
        costs, errors = trials[cost].values, trials["error"].values
        finite, sizes = np.isfinite(errors), []
        pairs = np.stack([trials[f"trial_{n}"].values.astype(str) for n in ("model", "method")])
        for pair in set(map(tuple, pairs.T)):
            own = (pair == pairs.T).all(axis=1) & finite
            (line,) = artists(axes, " ".join(pair))
            sizes.append(line.get_xdata().size)
            assert set(costs[own & (costs > 0) & np.isfinite(costs)]) <= set(line.get_xdata())
            assert set(errors[own & (errors > 1e-3)]) <= set(line.get_ydata())  # on the axis
        assert sum(sizes) == finite.sum()
        (front,) = artists(axes, "front")
        assert front.get_xdata().size == (trials[f"front_{cost}"].values != 0).sum()
        assert np.all(np.diff(front.get_ydata()) <= 0)
        (crosses,) = artists(axes, "bad")
        assert crosses.get_xdata().size == (~finite | (trials["converged"].values == 0)).sum()
        assert (crosses.get_ydata() > np.nanmax(errors)).sum() == (~finite).sum()
        lines = [line for line in axes.get_lines() if line.get_gid() and len(line.get_xdata())]
        low, high = np.transpose([axes.get_xlim(), axes.get_ylim()])
        assert all(
            np.all((low <= line.get_xydata()) & (line.get_xydata() <= high)) for line in lines
        )
    data = made["accuracy"].copy(deep=True)
    data[cost][0], data["error"][1] = 0.0, 0.0
    before, after = (
        len(artists(axes, "beyond")[0].get_xdata())
        for axes in (panels[0][0], panels_of(kind, data)[0][0])
    )
    assert after == before + 2


def test_a_profile_shows_the_share_of_points_within_a_ratio_of_the_best(made):
    figure = draw("accuracy_profile", made["accuracy"])
    data = made["accuracy"]
    tightest = data.isel(map_tolerance=int(np.argmin(data["map_tolerance"].values)))
    names, looks = tightest["competitor"].values.tolist(), set()
    for name, ratios in zip(names, tightest["profile_ratio"].values, strict=True):
        for line in artists(figure, f"profile {name}"):
            x, y = line.get_data()
            if names.count(name) == 1:
                for ratio in (1.0, 2.0, 10.0):
                    within = y[np.flatnonzero(x <= ratio)[-1]]
                    assert within == pytest.approx(np.mean(ratios <= ratio))
            looks.add((str(line.axes), line.get_color(), line.get_linestyle(), name))
    assert len(looks) == len(names)
    assert ": never" in words(figure)


def cheapest(names, velocity, amplitude):
    """A map of the cheapest models, shape (amplitudes, velocities)."""
    data = {"map_tolerance": ("map_tolerance", [1e-2])}
    for motion in ("transverse", "bore"):
        dims = ("map_tolerance", f"{motion}_amplitude", f"{motion}_velocity")
        data |= {f"{motion}_cheapest": (dims, names[None]), dims[1]: (dims[1], amplitude)}
        data[dims[2]] = dims[2], velocity
    return draw("model_map", xr.Dataset(data))


def test_the_map_colours_and_names_every_region_of_the_cheapest_model():
    velocity, amplitude = np.geomspace(1e-3, 10, 13), np.geomspace(0.1, 5, 9)
    names = np.full((9, 13), "polar", "<U9")
    names[2:4, 1:3] = names[6:8, 9:12] = names[0, 12] = "mdr"
    names[8, 0] = ""
    figure = cheapest(names, velocity, amplitude)
    axes, (legend,) = figure.axes[0], figure.findobj(Legend)
    handles = zip(legend.get_texts(), legend.legend_handles, strict=True)
    colours = {text.get_text().split()[-1]: to_hex(one.get_facecolor()) for text, one in handles}
    for name in ("polar", "mdr"):
        for cell, (i, j) in zip(
            artists(axes, f"cheapest {name}"), np.argwhere(names == name), strict=True
        ):
            (low, high), point = cell.get_corners()[[0, 2]], (velocity[j], amplitude[i])
            assert np.all(low < point) and np.all(point < high)
            assert to_hex(cell.get_facecolor()) == colours[name]
    assert axes.get_yscale() == "log" and len(artists(axes, "none")) == 1
    regions = artists(axes, "region")
    assert sorted(text.get_text() for text in regions) == ["Md", "Md", "Md", "Po"]
    for text in regions:
        x, y = text.get_position()
        i, j = np.argmin(np.abs(amplitude - y)), np.argmin(np.abs(velocity - x))
        assert names[i, j][:2].capitalize() == text.get_text()
    axes = cheapest(names[:1, :1], velocity[:1], np.array([0.5])).axes[0]
    assert axes.get_yscale() == "linear" and len(artists(axes, "region")) == 1


def test_the_atlas_shows_every_outcome(made):
    data = made["stability"].copy(deep=True)
    data["outcome"][:] = np.arange(data["outcome"].size).reshape(data["outcome"].shape) % 5
    data["outcome"].loc[{"method": "midpoint"}] = 0  # the method applies to no case
    figure = draw("stability_atlas", data)
    methods = [label.get_text() for label in figure.axes[0].get_xticklabels()]
    assert methods[0] == "shipped" and "midpoint" not in methods
    # As a dict, because sel has another keyword `method`.
    data = data.sel({"method": methods})
    for axes, name, label, note in zip(
        figure.axes, *(data[n].values for n in ("axis", "axis_label", "axis_note")), strict=True
    ):
        own = data.isel(case=data["case_axis"].values == name)
        expected = own["outcome"].transpose("case", "method").values
        assert [one.get_text() for one in axes.get_yticklabels()] == list(own["case_label"].values)
        signs = {text.get_position(): text.get_text() for text in axes.texts}
        for (row, column), code in np.ndenumerate(expected):
            sign = studies.OUTCOMES[code][2] if code else None
            assert signs.get((column + 0.5, row + 0.5)) == sign
        for code, (_, fill, *_) in studies.OUTCOMES.items():
            squares = artists(axes, f"outcome {code}")
            assert all(to_hex(one.get_facecolor()) == fill.lower() for one in squares)
            at = sorted((one.get_y(), one.get_x()) for one in squares)
            assert at == [*map(tuple, np.argwhere(expected == code))]
        assert label in axes.get_title(loc="left")
        assert note in [" ".join(text.get_text().split()) for text in axes.texts]
    names = [text.get_text().split(":")[0].split()[-1] for text in figure.legends[0].get_texts()]
    assert names == ["converged", "slow", "wrong", "diverged", "blank"]
