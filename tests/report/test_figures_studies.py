"""Figures of the studies show the values of their datasets."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_hex
from matplotlib.legend import Legend
from matplotlib.text import Text
from stubs import figures_stub as stub
from stubs.figures_stub import artists

from microslip.report.figures import drawing, studies

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("without_layout")]


@pytest.fixture(scope="module")
def accuracy() -> xr.Dataset:
    return stub.studies()["accuracy"]


@pytest.fixture(scope="module")
def stability() -> xr.Dataset:
    return stub.studies()["stability"]


def panels_of(name, dataset) -> list:
    """Panels of an accuracy figure with the trials of their points."""
    panels = [axes for axes in drawing.draw(name, {"accuracy": dataset}).axes if axes.axison]
    return [
        (axes, dataset.isel(trial=dataset["trial_point"].values == str(point)))
        for axes, point in zip(panels, dataset["point"].values, strict=True)
    ]


@pytest.mark.parametrize(
    ("name", "cost"), [("accuracy_vs_cost", "seconds"), ("accuracy_vs_work", "effort")]
)
def test_every_trial_and_the_front_are_drawn_and_no_failure_is_hidden(name, cost, accuracy):
    for axes, trials in panels_of(name, accuracy):
        costs, errors = trials[cost].values, trials["error"].values
        sizes = []
        models, methods = (trials[f"trial_{n}"].values for n in ("model", "method"))
        for model, method in set(zip(models, methods, strict=True)):
            own = (models == model) & (methods == method) & np.isfinite(errors)
            (line,) = artists(axes, f"{model} {method}")
            sizes.append(line.get_xdata().size)
            plain = own & (costs > 0) & np.isfinite(costs)
            assert set(costs[plain]) <= set(line.get_xdata())
            above = errors[own & (errors > 1e-3)]  # above the bottom of the axis
            assert set(above) <= set(line.get_ydata())
        assert sum(sizes) == np.isfinite(errors).sum()
        (front,) = artists(axes, "front")
        flagged = trials[f"front_{cost}"].values != 0
        assert front.get_xdata().size == flagged.sum()
        assert np.all(np.diff(front.get_ydata()) <= 0)
        failed = ~(np.isfinite(errors) & (trials["converged"].values != 0))
        (crosses,) = artists(axes, "not converged")
        assert crosses.get_xdata().size == failed.sum()
        in_row = crosses.get_ydata() > np.nanmax(errors)
        assert in_row.sum() == (~np.isfinite(errors)).sum()
        for line in (line for line in axes.get_lines() if line.get_gid() and len(line.get_xdata())):
            for ends, values in zip(
                (axes.get_xlim(), axes.get_ylim()), line.get_data(), strict=True
            ):
                assert np.all((ends[0] <= values) & (values <= ends[1]))
    data = accuracy.copy(deep=True)
    data[cost][0], data["error"][1] = 0.0, 0.0
    first = panels_of(name, data)[0][0]
    (beyond,) = artists(first, "beyond")
    (before,) = artists(panels_of(name, accuracy)[0][0], "beyond")
    assert len(beyond.get_xdata()) == len(before.get_xdata()) + 2


def test_a_profile_shows_the_share_of_points_within_a_ratio_of_the_best(accuracy):
    figure = drawing.draw("accuracy_profile", {"accuracy": accuracy})
    tightest = accuracy.isel(map_tolerance=int(np.argmin(accuracy["map_tolerance"].values)))
    looks = set()
    for name, ratios in zip(
        tightest["competitor"].values, tightest["profile_ratio"].values, strict=True
    ):
        for line in artists(figure, f"profile {name}"):
            x, y = line.get_xdata(), line.get_ydata()
            for ratio in (1.0, 2.0, 10.0):
                within = y[np.flatnonzero(x <= ratio)[-1]]
                if np.count_nonzero(tightest["competitor"].values == name) == 1:
                    assert within == pytest.approx(np.mean(ratios <= ratio))
            looks.add((str(line.axes), line.get_color(), line.get_linestyle(), str(name)))
    assert len(looks) == tightest.sizes["competitor"]
    assert any("never" in text.get_text() for text in figure.findobj(Text))


def cheapest(names: np.ndarray, amplitude: np.ndarray) -> xr.Dataset:
    """A map of the cheapest models, equal for both motions.

    names: shape (amplitudes, velocities).
    """
    velocity = np.geomspace(1e-3, 10, names.shape[1])
    data = {"map_tolerance": ("map_tolerance", [1e-2])}
    for motion in ("transverse", "bore"):
        dims = ("map_tolerance", f"{motion}_amplitude", f"{motion}_velocity")
        data |= {f"{motion}_cheapest": (dims, names[None]), dims[1]: (dims[1], amplitude)}
        data[dims[2]] = dims[2], velocity
    return xr.Dataset(data)


def test_the_map_colours_and_names_every_region_of_the_cheapest_model():
    names = np.full((9, 13), "polar", "<U9")
    names[2:4, 1:3] = names[6:8, 9:12] = names[0, 12] = "mdr"
    names[8, 0] = ""
    data = cheapest(names, np.geomspace(0.1, 5, 9))
    figure = drawing.draw("model_map", {"accuracy": data})
    (legend,) = figure.findobj(Legend)
    handles = zip(legend.get_texts(), legend.legend_handles, strict=True)
    colours = {text.get_text().split()[-1]: to_hex(one.get_facecolor()) for text, one in handles}
    axes = figure.axes[0]
    assert axes.get_yscale() == "log"
    for name in ("polar", "mdr"):
        cells = artists(axes, f"cheapest {name}")
        assert {to_hex(cell.get_facecolor()) for cell in cells} == {colours[name]}
        centres = [cell.get_extents().get_points().mean(axis=0) for cell in cells]
        column, row = axes.transAxes.inverted().transform(centres).T * np.array([[13], [9]])
        at = set(zip(row.astype(int), column.astype(int), strict=True))
        assert at == set(map(tuple, np.argwhere(names == name)))
    assert len(artists(axes, "none")) == 1
    regions = [(text.get_text(), text.get_position()) for text in artists(axes, "region")]
    assert sorted(text for text, _ in regions) == ["Md", "Md", "Md", "Po"]
    for text, (velocity, amplitude) in regions:
        j = np.argmin(abs(np.log(data["bore_velocity"].values / velocity)))
        i = np.argmin(abs(np.log(data["bore_amplitude"].values / amplitude)))
        assert names[i, j][:2].capitalize() == text
    even = cheapest(names[:1, :1], np.array([0.5]))
    axes = drawing.draw("model_map", {"accuracy": even}).axes[0]
    assert axes.get_yscale() == "linear" and len(artists(axes, "region")) == 1


def test_the_atlas_shows_every_outcome(stability):
    data = stability.copy(deep=True)
    data["outcome"][:] = np.arange(data["outcome"].size).reshape(data["outcome"].shape) % 5
    data["outcome"].loc[{"method": "midpoint"}] = 0  # the method applies to no case
    figure = drawing.draw("stability_atlas", {"stability": data})
    (axes,) = figure.axes
    methods = [label.get_text() for label in axes.get_xticklabels()]
    assert methods[0] == "shipped" and "midpoint" not in methods
    rows = {
        tick: text.get_text()
        for tick, text in zip(axes.get_yticks(), axes.get_yticklabels(), strict=True)
    }
    assert list(rows.values()) == list(data["case_label"].values)
    # As a dict, because sel has another keyword `method`.
    expected = data["outcome"].sel({"method": methods}).transpose("case", "method").values
    signs = {text.get_position(): text.get_text() for text in axes.texts}
    for row, codes in zip(rows, expected, strict=True):
        for column, code in enumerate(codes):
            sign = studies.OUTCOMES[code][2] if code else None
            assert signs.get((column + 0.5, row)) == sign
    squares = [p for p in axes.patches if (p.get_gid() or "").startswith("outcome")]
    assert len(squares) == np.count_nonzero(expected)
    notes = {" ".join(text.get_text().split()) for text in axes.texts}
    assert {*data["axis_label"].values, *data["axis_note"].values} <= notes
    (legend,) = figure.legends
    names = [text.get_text().partition(":")[0] for text in legend.get_texts()]
    assert names == ["converged", "slow", "wrong", "diverged", "blank"]
