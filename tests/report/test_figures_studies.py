"""Figures of the studies: they draw what `accuracy_cost.nc`, `stability.nc`, `claims.nc` hold."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import to_hex, to_rgb
from matplotlib.legend import Legend
from matplotlib.text import Text
from stubs import claims_stub

from microslip.report.figures import drawing
from microslip.report.figures import style as look
from microslip.studies import registry

pytestmark = pytest.mark.slow  # for drawing takes a second or two

MODELS = ("rigid", "slider", "dahl", "mdr", "radial", "polar", "cartesian")
RESOLVED = ("radial", "polar", "cartesian")
METHODS = (
    "shipped",
    "paper",
    "full-newton",
    "gauss-seidel",
    "projected-gradient",
    "accelerated-gradient",
    "admm:penalty=0.1",
    "semismooth-newton",
    "active-set",
    "penalty",
    "marching",
    "anderson",
    "jacobi",
    "spectral-gradient",
    "residual-alone",
    "equal-means",
)
LEVELS = 6
MOTIONS = (
    ("transverse", 0.1, 1.0, 0.0, "middle of the transverse map"),
    ("transverse", 0.001, 0.5, 0.0, "almost static"),
    ("transverse", 0.1, 1.0, 0.3, "as before, with coupled directions"),
    ("transverse", 3.0, 2.5, 0.0, "almost rigid"),
    ("bore", 0.1, 1.0, 0.0, "middle of the bore map"),
    ("bore", 0.01, 4.0, 0.0, "bore, slow and large"),
    ("bore", 0.1, 1.0, 0.3, "bore with coupled directions"),
    ("continuous-bore", 0.5, np.nan, 0.0, "steady bore"),
    ("continuous-bore", 0.05, np.nan, 0.3, "steady bore, slow"),
    ("transverse", 0.02, 0.1, 0.0, "small amplitude, nothing slips but the edge"),
    ("zigzag", 0.1, 2.0, 0.0, "abrupt reversal"),
)


def applies(model: str, motion: str, poisson: float) -> bool:
    """Whether a model can run in a motion, roughly as the package has it."""
    if motion == "transverse":
        return model != "radial" or poisson == 0
    return model in ("rigid", "polar", "cartesian")


def fake_trials(points: int = 11, methods: tuple[str, ...] = METHODS) -> dict:
    """The flat table of trials, by column, and the points' own variables."""
    random = np.random.default_rng(5)
    rows = []

    def add(point, model, method, level, error, seconds, effort, converged=True, tolerance=np.nan):
        rows.append(
            (f"p{point}", model, method, level, error, seconds, effort, converged, tolerance)
        )

    for point, (motion, _, _, poisson, _) in enumerate(MOTIONS[:points]):
        for model in MODELS:
            if not applies(model, motion, poisson):
                continue
            if model == "rigid":
                add(point, model, "shipped", 0, 0.2 / (point + 1), 2e-5, 0)
                continue
            for level in range(LEVELS):
                unknowns = 8 * 2.0 ** (level * (1 if model not in RESOLVED[1:] else 2))
                base = 3e-2 * 4.0**-level
                for method in methods if model in RESOLVED else ("shipped",):
                    if method == "paper":
                        continue
                    slow = 1 + 3 * methods.index(method) ** 1.3
                    error = base * random.lognormal(0, 0.3)
                    if model not in RESOLVED:
                        error += 0.03 / (1 + MODELS.index(model))
                    done = not (method == "penalty" and level > 3)
                    error = np.nan if method == "marching" and level == 5 else error
                    seconds = 1e-4 * slow * unknowns**1.2 * random.lognormal(0, 0.2)
                    add(point, model, method, level, error, seconds, slow * unknowns * 40, done)
        add(point, "cartesian", "paper", 0, 8e-3, 40.0 + point, 4e7)
        for k, tolerance in enumerate((1e-2, 1e-3, 1e-4)):
            error = tolerance * 0.2 if point else 0.0
            add(point, "auto", "shipped", k, error, 2e-3 * 10**k, 3e3 * 8**k, True, tolerance)
    names = ("point", "model", "method", "level", "error", "seconds", "effort", "converged")
    names += ("tolerance",)
    return dict(zip(names, map(np.array, zip(*rows, strict=True)), strict=True))


def on_front(cost: np.ndarray, error: np.ndarray, group: np.ndarray) -> np.ndarray:
    """Whether no other of the same point is both cheaper and better."""
    front = np.zeros(cost.size, bool)
    for i in np.flatnonzero(np.isfinite(error)):
        same = (group == group[i]) & np.isfinite(error)
        front[i] = not np.any(same & (cost <= cost[i]) & (error < error[i]))
    return front


def fake_accuracy(points: int = 11, methods: tuple[str, ...] = METHODS) -> xr.Dataset:
    """All of `accuracy_cost.nc`, with points, trials, scaling and maps of realistic size."""
    table = fake_trials(points, methods)
    known = [2e-6, 1e-5, 3e-5, 2e-6, 3e-5, 1e-4, 1e-4, 1e-6, 0.0, 1e-5, 1e-5]
    motions, velocity, amplitude, poisson, titles = zip(*MOTIONS[:points], strict=True)
    trials = {f"trial_{n}": ("trial", table[n]) for n in ("point", "model", "method", "level")}
    trials["trial_tolerance"] = ("trial", table["tolerance"])
    trials |= {n: ("trial", table[n]) for n in ("error", "seconds", "effort", "converged")}
    for cost in ("seconds", "effort"):
        front = on_front(table[cost], table["error"], table["point"])
        trials[f"front_{cost}"] = ("trial", front)
    of_points = {
        "point_title": ("point", list(titles)),
        "point_motion": ("point", list(motions)),
        "point_velocity": ("point", list(velocity)),
        "point_amplitude": ("point", list(amplitude)),
        "point_poisson": ("point", list(poisson)),
        "reference_error": ("point", known[:points]),
    }
    coords = {"point": [f"p{i}" for i in range(points)]}
    dataset = xr.Dataset(trials | of_points, coords).merge(fake_profile(points, methods))
    return dataset.merge(fake_scaling()).merge(fake_maps())


def fake_profile(points: int, methods: tuple[str, ...]) -> xr.Dataset:
    """Ratios to the best in two contests; the slider never does."""
    random = np.random.default_rng(9)
    names = [*MODELS, "auto", *(name for name in methods if name != "paper")]
    contests = ["models"] * (len(MODELS) + 1) + ["searches"] * (len(names) - len(MODELS) - 1)
    ratio = random.lognormal(1, 1, (len(names), 2, points)).clip(1)
    ratio[random.random(ratio.shape) < 0.2] = np.inf
    ratio[names.index("slider")] = np.inf
    return xr.Dataset(
        {"profile_ratio": (("competitor", "map_tolerance", "point"), ratio)},
        {"competitor": names, "competitor_contest": ("competitor", contests)},
    )


def fake_scaling() -> xr.Dataset:
    """Power laws for three models, one of them with fewer sizes."""
    n = np.array([2.0**k for k in range(5, 15, 2)])
    unknowns = np.stack([n[:5], 4 * n, 10 * n])
    unknowns[0, 4] = np.nan
    powers = {"iterations": (0.0, 0.3, 0.5), "seconds": (1.0, 1.6, 1.4), "memory": (2.0, 1.9, 1.0)}
    unit = {"iterations": 12.0, "seconds": 1e-6, "memory": 8.0}
    both = ("scaling_model", "scaling_size")
    data = {
        f"scaling_{what}": (both, unit[what] * unknowns ** np.array(power)[:, None])
        for what, power in powers.items()
    }
    data |= {f"scaling_exponent_{what}": (both[:1], list(p)) for what, p in powers.items()}
    labels = [[f"{2**k} x {2**k}" for k in range(3, 8)] for _ in RESOLVED]
    data |= {"scaling_unknowns": (both, unknowns), "scaling_label": (both, labels)}
    return xr.Dataset(data, {"scaling_model": list(RESOLVED)})


def fake_maps(velocities: int = 13, amplitudes: int = 9) -> xr.Dataset:
    """Regions of the cheapest model, with one where none is accurate enough."""
    data, coords = {}, {"map_tolerance": [1e-2, 1e-3]}
    for motion, top in (("transverse", 3.0), ("bore", 5.0)):
        velocity = np.geomspace(1e-3, 10, velocities)
        even = np.linspace if motion == "transverse" else np.geomspace
        amplitude = even(0.0 if motion == "transverse" else 0.1, top, amplitudes)
        v, a = np.meshgrid(velocity, amplitude)
        maps = []
        for tolerance in coords["map_tolerance"]:
            names = np.full(v.shape, "radial" if motion == "transverse" else "polar", object)
            names[(v > 1) & (a > 0.4 * top)] = "rigid"
            names[(v > 0.05) & (v < 1) & (a > 0.6 * top)] = "mdr" if tolerance > 5e-3 else "polar"
            names[(v < 0.01) & (a < 0.3 * top)] = "dahl" if motion == "transverse" else "cartesian"
            names[a == amplitude[0]] = "slider" if motion == "transverse" else "rigid"
            names[(v < 0.003) & (a > 0.8 * top)] = ""
            maps.append(names.astype(str))
        dims = ("map_tolerance", f"{motion}_amplitude", f"{motion}_velocity")
        data[f"{motion}_cheapest"] = (dims, np.array(maps))
        coords |= {dims[1]: amplitude, dims[2]: velocity}
    return xr.Dataset(data, coords)


AXES = {
    "velocity": (r"forward velocity $\tilde{v}_0$", r"transverse, $\tilde{y}_0 = 1$, $\nu = 0$"),
    "amplitude": (r"amplitude $\tilde{y}_0$", r"transverse, $\tilde{v}_0 = 0.1$, $\nu = 0$"),
    "bore_velocity": (r"forward velocity $\tilde{v}$", r"bore, $\tilde{\varphi}_0 = 1$"),
    "bore_amplitude": (r"amplitude $\tilde{\varphi}_0$", r"bore, $\tilde{v} = 0.1$"),
    "poisson": (r"Poisson's ratio $\nu$", r"bore, $\tilde{v} = 0.1$, $\tilde{\varphi}_0 = 1$"),
    "cells": ("cells across the contact", r"cartesian, $\tilde{v}_0 = 0.1$, $\tilde{y}_0 = 1$"),
    "rings": ("rings", r"radial, $\tilde{v}_0 = 0.1$, $\tilde{y}_0 = 1$"),
    "angles": ("angular points", r"polar bore, $\tilde{v} = 0.1$"),
    "steps": ("steps a period", r"transverse, $\tilde{v}_0 = 0.1$, $\tilde{y}_0 = 1$"),
    "model": ("contact model", r"transverse, $\tilde{v}_0 = 0.1$, $\tilde{y}_0 = 1$"),
    "tolerance": ("tolerance", r"transverse, $\tilde{v}_0 = 0.1$, $\tilde{y}_0 = 1$"),
    "start": ("first state", "continuous bore, half way to the steady state"),
    "penalty": ("penalty of the splitting", "transverse, cartesian, all else as shipped"),
}
STABLE = (*METHODS, "uzawa", "regularised")


def fake_stability(axes: int = 13, cases: int = 7, methods: tuple[str, ...] = STABLE) -> xr.Dataset:
    """All of `stability.nc` that the atlas draws."""
    random = np.random.default_rng(7)
    names = list(AXES)[:axes]
    labels = {
        "model": list(MODELS),
        "tolerance": [f"$10^{{-{k}}}$" for k in range(7)],
        "start": ["rest", "slip", "full"],
    }
    case_axis, case_value, case_label = [], [], []
    for name in names:
        mine = labels.get(name, [f"{0.01 * 2**k:.2g}" for k in range(cases)])[:cases]
        case_axis += [name] * len(mine)
        case_value += range(len(mine))
        case_label += mine
    weights = [0.0, 0.62, 0.18, 0.08, 0.12]
    outcome = random.choice(5, p=weights, size=(len(methods), len(case_axis)))
    outcome[0] = 1
    for index, name in enumerate(names):  # not every method applies everywhere
        away = np.array([m % 3 == index % 3 and m > 3 for m in range(len(methods))])
        outcome[np.ix_(away, np.array(case_axis) == name)] = 0
    return xr.Dataset(
        {
            "outcome": (("method", "case"), outcome.astype(np.int8)),
            "axis_label": ("axis", [AXES[name][0] for name in names]),
            "axis_note": ("axis", [AXES[name][1] for name in names]),
        },
        {
            "method": list(methods),
            "case_axis": ("case", case_axis),
            "case_value": ("case", np.array(case_value, float)),
            "case_label": ("case", case_label),
            "axis": names,
        },
    )


FIGURES = ("accuracy_vs_cost", "accuracy_vs_work", "model_map", "scaling", "stability_atlas")
ALL = [*FIGURES, "accuracy_profile", "claims_static", "claims_patches"]
LONG = ("model_map", "stability_atlas")
"""As large as the real ones these take seconds to lay out; every run looks at smaller ones."""
EACH = [pytest.param(name, marks=pytest.mark.long if name in LONG else ()) for name in ALL]


@pytest.fixture(scope="module")
def datasets() -> dict[str, xr.Dataset]:
    """The datasets, as large as the real ones."""
    return {"accuracy_cost": fake_accuracy(), "stability": fake_stability(), "claims": claims()}


def few() -> dict[str, xr.Dataset]:
    """The datasets with few points, methods and axes."""
    methods = ("shipped", "full-newton")
    stability = fake_stability(axes=2, cases=3, methods=("shipped", "paper"))
    least = claims(amplitude_bore=[1], amplitude_transverse=[0.5])
    return {"accuracy_cost": fake_accuracy(2, methods), "stability": stability, "claims": least}


@pytest.fixture(scope="module")
def small() -> dict[str, xr.Dataset]:
    return few()


class Drawn(dict):
    """Figures by their names, each drawn once, when it is first looked at."""

    def __init__(self, datasets):
        self.datasets = datasets

    def __missing__(self, name):
        self[name] = drawing.draw(name, self.datasets)
        self[name].draw_without_rendering()  # so that all texts have their places
        return self[name]


@pytest.fixture(scope="module")
def figures(datasets):
    """The figures of the studies."""
    return Drawn(datasets)


def claims(**changes) -> xr.Dataset:
    """The dataset of the claims, of made-up answers."""
    return registry.build("claims", claims_stub.configured(**changes), claims_stub.answered()[0])


def artists(where, gid: str) -> list:
    """The artists of a figure or a panel with that id."""
    return where.findobj(lambda artist: artist.get_gid() == gid)


def one_panel_each(figure, dataset: xr.Dataset) -> list[tuple[Axes, xr.Dataset]]:
    """The panels of an accuracy figure, each with the trials of its point."""
    panels = figure.axes[: dataset.sizes["point"]]
    return [
        (axes, dataset.isel(trial=dataset["trial_point"].values == str(name)))
        for axes, name in zip(panels, dataset["point"].values, strict=True)
    ]


def texts(where) -> list[str]:
    """All texts that are shown."""
    return [text.get_text() for text in where.findobj(Text) if text.get_visible()]


def out_of_view(axes: Axes) -> list[Text]:
    """Labels of ticks beyond the ends of the axes, which are not drawn."""
    ends = ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim()))
    return [
        label
        for axis, (low, high) in ends
        for tick in (*axis.get_major_ticks(), *axis.get_minor_ticks())
        for label in (tick.label1, tick.label2)
        if not min(low, high) <= tick.get_loc() <= max(low, high)
    ]


def grey(color) -> float:
    """Luminance of a colour in a grey print, from 0 to 1."""
    return float(np.dot((0.299, 0.587, 0.114), to_rgb(color)))


# Every figure


def test_figures_name_their_datasets():
    assert set(FIGURES) <= set(drawing.FIGURES)
    assert drawing.FIGURES["stability_atlas"] == ("stability",)
    assert {drawing.FIGURES[name] for name in FIGURES[:-1]} == {("accuracy_cost",)}


@pytest.mark.parametrize("name", EACH)
def test_fits_the_page_and_no_texts_meet(name, figures):
    figure = figures[name]
    width, height = figure.get_size_inches()
    assert width <= 7.1
    assert height * 25.4 <= 250.1
    edges = figure.get_tightbbox().extents
    assert np.all(edges[:2] > -0.02)
    assert np.all(edges[2:] < (width + 0.02, height + 0.02))

    absent = {label for axes in figure.axes for label in out_of_view(axes)}
    texts = [t for t in figure.findobj(Text) if t.get_visible() and t.get_text().strip()]
    drawn = [text for text in texts if text not in absent]
    assert min(text.get_fontsize() for text in drawn) >= 7.0
    boxes = [text.get_window_extent() for text in drawn]
    low, high = (np.array([getattr(box, end) for box in boxes]) for end in ("min", "max"))
    shared = np.minimum(high[:, None], high) - np.maximum(low[:, None], low)
    meet = np.triu((shared > 0.02 * figure.dpi).all(axis=2), 1)
    assert not [(drawn[i].get_text(), drawn[j].get_text()) for i, j in np.argwhere(meet)]


@pytest.mark.parametrize("name", EACH)
def test_legends_hide_no_panel_and_no_other_legend(name, figures):
    figure = figures[name]
    panels = [axes.get_window_extent().padded(-2) for axes in figure.axes if axes.axison]
    legends = [legend.get_window_extent() for legend in figure.findobj(Legend)]
    for index, box in enumerate(legends):
        assert not any(box.overlaps(other) for other in [*panels, *legends[index + 1 :]])


@pytest.mark.parametrize(
    ("name", "variable"),
    [
        *(("accuracy_vs_cost", n) for n in ("seconds", "front_seconds", "error", "trial_level")),
        *(("accuracy_vs_work", n) for n in ("effort", "front_effort", "reference_error")),
        *(("model_map", n) for n in ("bore_cheapest", "map_tolerance", "transverse_velocity")),
        *(("accuracy_profile", n) for n in ("profile_ratio", "competitor_contest")),
        *(("scaling", n) for n in ("scaling_memory", "scaling_exponent_seconds")),
        *(("stability_atlas", n) for n in ("outcome", "case_axis", "axis_note", "method")),
        *(("claims_static", n) for n in ("bore_curve_limit", "transverse_paper", "share_radius")),
        *(("claims_patches", n) for n in ("patch_share", "patch_edge_forward", "patch_stick")),
    ],
)
def test_a_missing_variable_is_named(name, variable, small):
    (key,) = drawing.FIGURES[name]
    with pytest.raises(ValueError, match=f"figure {name}: dataset '{key}' has no .*'{variable}'"):
        drawing.draw(name, {key: small[key].drop_vars(variable)})


# Accuracy against cost and effort


@pytest.mark.parametrize(("name", "cost"), [(FIGURES[0], "seconds"), (FIGURES[1], "effort")])
def test_curves_hold_every_trial(name, cost, datasets, figures):
    dataset = datasets["accuracy_cost"]
    for axes, trials in one_panel_each(figures[name], dataset):
        bottom, top = axes.get_ylim()
        found = 0
        trials = trials.sortby("trial_level")
        models, methods = (trials[f"trial_{n}"].values for n in ("model", "method"))
        costs, errors = (trials[n].values for n in (cost, "error"))
        for model, method in set(zip(models, methods, strict=True)):
            mine = (models == model) & (methods == method) & np.isfinite(errors)
            (line,) = artists(axes, f"{model} {method}")
            assert (line.get_linestyle() == "None") == (method != "shipped")
            found += line.get_xdata().size
            above_zero = costs[mine] > 0
            x, y = line.get_xdata()[above_zero], line.get_ydata()[above_zero]
            np.testing.assert_array_equal(x, costs[mine][above_zero])
            inside = errors[mine][above_zero] > 1e-4  # surely above the bottom strip
            np.testing.assert_array_equal(y[inside], errors[mine][above_zero][inside])
            assert np.all((bottom < y) & (y < top))
        assert found == np.isfinite(errors).sum()


def test_panels_share_their_axes_and_show_all_that_is_drawn(figures, datasets):
    for name in FIGURES[:2]:
        panels = figures[name].axes[:11]
        assert len({axes.get_xlim() for axes in panels}) == 1
        assert len({axes.get_ylim() for axes in panels}) == 1
        for axes in panels:
            for line in axes.get_lines():
                if line.get_gid() is None or not line.get_xdata(orig=True).size:
                    continue
                x, y = line.get_data()
                assert np.all((axes.get_xlim()[0] <= x) & (x <= axes.get_xlim()[1]))
                assert np.all((axes.get_ylim()[0] <= y) & (y <= axes.get_ylim()[1]))


@pytest.mark.parametrize(("name", "cost"), [(FIGURES[0], "seconds"), (FIGURES[1], "effort")])
def test_the_front_is_the_datasets(name, cost, datasets, figures):
    dataset = datasets["accuracy_cost"]
    for axes, trials in one_panel_each(figures[name], dataset):
        (front,) = artists(axes, "front")
        flagged = trials.isel(trial=trials[f"front_{cost}"].values).sortby(cost)
        shown = flagged[cost].values > 0
        assert front.get_xdata().size == shown.size
        np.testing.assert_array_equal(
            front.get_xdata()[shown], np.sort(flagged[cost].values)[shown]
        )
        assert np.all(np.diff(front.get_ydata()) <= 0)  # it only falls, or lies in the strip
        assert front.get_zorder() < min(
            line.get_zorder() for line in artists(axes, "polar shipped")
        )


def test_trials_that_failed_are_marked_and_not_hidden(datasets, figures):
    dataset = datasets["accuracy_cost"]
    figure = figures["accuracy_vs_cost"]
    for axes, trials in one_panel_each(figure, dataset):
        no_result = ~np.isfinite(trials["error"].values)
        failed = no_result | ~trials["converged"].values
        assert failed.any()
        (crosses,) = artists(axes, "not converged")
        assert sorted(crosses.get_xdata()) == sorted(trials["seconds"].values[failed])
        # Those without a result stand in a row of their own, above all errors.
        in_row = crosses.get_ydata() > np.nanmax(trials["error"].values)
        assert in_row.sum() == no_result.sum()
        assert len(set(crosses.get_ydata()[in_row])) == 1
        assert crosses.get_ydata()[in_row][0] in axes.get_yticks()
        hollow = artists(axes, "hollow")
        own = np.isin(trials["trial_method"].values, ["shipped", "paper"])
        assert sum(line.get_xdata().size for line in hollow) == (failed & own).sum()
        assert {line.get_markerfacecolor() for line in hollow} == {"white"}
    assert "none" in [label.get_text() for label in figure.axes[0].get_yticklabels()]


def test_errors_too_small_and_costs_of_zero_get_an_arrow_at_the_edge(datasets, figures):
    dataset = datasets["accuracy_cost"]
    (first, trials), (second, _), *_ = one_panel_each(figures["accuracy_vs_work"], dataset)
    zero = trials["error"].values == 0
    (arrows,) = artists(first, "low")
    assert sorted(arrows.get_xdata()) == sorted(trials["effort"].values[zero])
    assert set(arrows.get_ydata()) == {first.get_ylim()[0]}
    assert not artists(second, "low")
    (free,) = artists(first, "left")
    assert (
        free.get_ydata().tolist() == trials["error"].values[trials["effort"].values == 0].tolist()
    )
    assert free.get_xdata()[0] == first.get_xlim()[0]
    assert not artists(figures["accuracy_vs_cost"].axes[0], "left")


@pytest.mark.usefixtures("unplaced")
def test_an_exact_trial_does_not_stretch_the_axis(small):
    dataset = small["accuracy_cost"].copy(deep=True)
    dataset["reference_error"][:] = 0.0
    dataset["error"][0] = 1e-17
    axes = drawing.draw("accuracy_vs_cost", {"accuracy_cost": dataset}).axes[0]
    assert axes.get_ylim()[1] / axes.get_ylim()[0] < 1e8
    (arrows,) = artists(axes, "low")
    assert float(dataset["seconds"][0]) in arrows.get_xdata()


def test_the_references_error_is_hatched_from_the_bottom_up(datasets, figures):
    dataset = datasets["accuracy_cost"]
    panels = figures["accuracy_vs_cost"].axes[:11]
    assert sum(len(artists(axes, "reference")) for axes in panels) == 7  # those of 1e-5 and above
    for index, axes in enumerate(panels):
        known = float(dataset["reference_error"][index])
        bands = artists(axes, "reference")
        assert len(bands) == (known > axes.get_ylim()[0])
        for band in bands:
            assert band.get_hatch()
            assert band.get_y() == axes.get_ylim()[0]
            assert band.get_y() + band.get_height() == pytest.approx(known)


@pytest.mark.usefixtures("unplaced")
def test_an_unknown_error_of_the_reference_draws_no_band(small):
    dataset = small["accuracy_cost"].copy(deep=True)
    dataset["reference_error"][0] = np.nan
    first, second = drawing.draw("accuracy_vs_cost", {"accuracy_cost": dataset}).axes[:2]
    assert not artists(first, "reference")
    assert artists(second, "reference")


def test_tolerances_are_named_and_the_papers_run_is_a_star(datasets, figures):
    for axes in figures["accuracy_vs_cost"].axes[: datasets["accuracy_cost"].sizes["point"]]:
        (star,) = artists(axes, "cartesian paper")
        assert star.get_marker() == "*"
        named = {label.get_text() for label in artists(axes, "label")}
        assert named <= {"$10^{-2}$", "$10^{-3}$", "$10^{-4}$"}
        (diamonds,) = artists(axes, "auto shipped")
        assert diamonds.get_marker() == "D"
        assert to_hex(diamonds.get_markerfacecolor()) == look.BLACK
        assert len(diamonds.get_xdata()) == 3
    assert all(f"$10^{{-{k}}}$" in texts(axes) for k in (2, 3, 4))


def test_names_of_tolerances_hide_no_trial(figures):
    for name in FIGURES[:2]:
        for axes in figures[name].axes[:11]:
            lines = [line for line in axes.get_lines() if " " in (line.get_gid() or "")]
            marks = np.concatenate([line.get_xydata() for line in lines])
            pixels = axes.transData.transform(marks)
            for label in artists(axes, "label"):
                assert label.get_window_extent().count_contains(pixels) == 0


def test_the_legends_name_every_model_and_mark_and_no_method_alone(datasets, figures):
    for name in FIGURES[:2]:
        models, marks = figures[name].findobj(Legend)
        assert [text.get_text() for text in models.get_texts()] == list(MODELS)
        names = [text.get_text() for text in marks.get_texts()]
        assert {"Pareto front", "paper's run", "not converged, or none"} <= set(names)
        assert "any other method" in names  # the profile tells them apart
        for handle, model in zip(models.legend_handles, MODELS, strict=True):
            (line, *_) = artists(figures[name], f"{model} shipped")
            assert (handle.get_color(), handle.get_marker()) == (
                line.get_color(),
                line.get_marker(),
            )
        assert len({handle.get_marker() for handle in models.legend_handles}) == len(MODELS)


# Profiles


def test_a_profile_shows_the_share_of_points_within_a_ratio_of_the_best(datasets, figures):
    dataset, figure = datasets["accuracy_cost"], figures["accuracy_profile"]
    tightest = dataset.isel(map_tolerance=int(np.argmin(dataset["map_tolerance"].values)))
    for axes, contest in zip(figure.axes, ("models", "searches"), strict=True):
        mine = tightest.isel(competitor=tightest["competitor_contest"].values == contest)
        looks = set()
        for name, ratios in zip(
            mine["competitor"].values, mine["profile_ratio"].values, strict=True
        ):
            (line,) = artists(axes, f"profile {name}")
            x, y = line.get_xdata(), line.get_ydata()
            assert line.get_drawstyle() == "steps-post"
            for ratio in (1.0, 2.0, 10.0, 100.0):
                if ratio <= axes.get_xlim()[1]:
                    within = y[np.flatnonzero(x <= ratio)[-1]]
                    assert within == pytest.approx(np.mean(ratios <= ratio))
            looks.add((line.get_color(), str(line._unscaled_dash_pattern)))
        assert len(looks) == mine.sizes["competitor"]
        names = [text.get_text() for text in axes.get_legend().get_texts()]
        assert len(names) == mine.sizes["competitor"]
    assert "slider: never" in [t.get_text() for t in figure.axes[0].get_legend().get_texts()]


def test_every_panel_is_headed_by_its_point(datasets, figures):
    for axes, (_, velocity, amplitude, poisson, title) in zip(
        figures["accuracy_vs_cost"].axes, MOTIONS, strict=False
    ):
        head = axes.get_title(loc="left")
        assert title in head.replace("\n", " ")
        assert f"= {velocity:g}$" in head
        assert rf"\nu = {poisson:g}$" in head
        assert head.count("=") == (2 if np.isnan(amplitude) else 3)


@pytest.mark.parametrize("points", [1, 2, 3, 4])
def test_any_number_of_points_finds_room_for_panels_and_legends(points):
    dataset = fake_accuracy(points, (*METHODS, "admm:penalty=0.1,relaxation=1.5"))
    figure = drawing.draw("accuracy_vs_work", {"accuracy_cost": dataset})
    assert sum(axes.axison for axes in figure.axes) == points
    panels = [axes.get_window_extent() for axes in figure.axes if axes.axison]
    legends = [legend.get_window_extent() for legend in figure.findobj(Legend)]
    for index, box in enumerate(legends):
        assert not any(box.overlaps(other) for other in [*panels, *legends[index + 1 :]])
        assert figure.bbox.x0 <= box.x0 < box.x1 <= figure.bbox.x1
        assert figure.bbox.y0 <= box.y0 < box.y1 <= figure.bbox.y1


def test_a_dataset_without_trials_is_refused(small):
    empty = small["accuracy_cost"].isel(trial=[])
    with pytest.raises(ValueError, match="no points or no trials"):
        drawing.draw("accuracy_vs_cost", {"accuracy_cost": empty})


# Map of models


@pytest.mark.long
def test_the_map_colours_and_names_the_cheapest_models(datasets, figures):
    dataset, figure = datasets["accuracy_cost"], figures["model_map"]
    (legend,) = figure.findobj(Legend)
    handles = zip(legend.get_texts(), legend.legend_handles, strict=True)
    colours = {text.get_text().split()[-1]: handle.get_facecolor() for text, handle in handles}
    panels = iter(figure.axes)
    for motion in ("transverse", "bore"):
        for index in range(2):
            axes = next(panels)
            names = dataset[f"{motion}_cheapest"].values[index]
            (mesh,) = artists(axes, "cheapest")
            drawn = mesh.cmap(mesh.norm(mesh.get_array()))
            for name in set(names.ravel()) - {""}:
                here = drawn[names == name]
                np.testing.assert_allclose(here, np.tile(colours[name], (len(here), 1)), atol=5e-3)
            np.testing.assert_array_equal(np.ma.getmaskarray(mesh.get_array()), names == "")
            assert len(artists(axes, "none")) == (names == "").sum()
            assert all(cell.get_hatch() for cell in artists(axes, "none"))
            named = {text.get_text() for text in artists(axes, "region")}
            assert named == {name[:2].capitalize() for name in set(names.ravel()) - {""}}
    assert set(colours) == {"slider", "rigid", "dahl", "mdr", "radial", "polar", "cartesian"} | {
        "accurate"
    }


@pytest.mark.usefixtures("unplaced")
def test_every_region_of_the_map_is_named_where_it_is():
    maps = fake_maps()
    names = np.full((9, 13), "polar", "<U9")
    names[2:4, 1:3] = names[6:8, 9:12] = names[0, 12] = "mdr"
    maps["bore_cheapest"] = (maps["bore_cheapest"].dims, np.array([names, names]))
    axes = drawing.draw("model_map", {"accuracy_cost": maps}).axes[2]
    velocity, amplitude = maps["bore_velocity"].values, maps["bore_amplitude"].values
    cells = set()
    for text in artists(axes, "region"):
        j = np.argmin(abs(np.log(velocity / text.get_position()[0])))
        i = np.argmin(abs(np.log(amplitude / text.get_position()[1])))
        assert names[i, j][:2].capitalize() == text.get_text()
        if names[i, j] == "mdr":
            cells.add("low" if i in (2, 3) else "high" if i in (6, 7) else "corner")
    assert cells == {"low", "high", "corner"}
    assert len(artists(axes, "region")) == 4


@pytest.mark.long
def test_the_amplitudes_own_spacing_decides_about_the_scale(figures):
    scales = [axes.get_yscale() for axes in figures["model_map"].axes]
    assert scales == ["linear", "linear", "log", "log"]
    assert {axes.get_xscale() for axes in figures["model_map"].axes} == {"log"}


def test_a_map_of_one_point_is_drawn():
    maps = fake_maps().isel(map_tolerance=[0])
    maps = maps.isel({f"{s}_{n}": [3] for s in ("transverse", "bore") for n in ("velocity",)})
    maps = maps.isel(transverse_amplitude=[2], bore_amplitude=[2])
    figure = drawing.draw("model_map", {"accuracy_cost": maps})
    for axes, motion in zip(figure.axes, ("transverse", "bore"), strict=True):
        low, high = axes.get_xlim()
        assert low < maps[f"{motion}_velocity"] < high
        low, high = axes.get_ylim()
        assert low < maps[f"{motion}_amplitude"] < high
        assert len(artists(axes, "region")) == 1


# Scaling


def test_scaling_shows_the_sizes_and_the_exponents(datasets, figures):
    dataset = datasets["accuracy_cost"]
    powers = {"iterations": (0.0, 0.3, 0.5), "seconds": (1.0, 1.6, 1.4), "memory": (2.0, 1.9, 1.0)}
    for axes, (what, power) in zip(figures["scaling"].axes, powers.items(), strict=True):
        for index, line in enumerate(artists(axes, what)):
            x, y = (dataset[f"scaling_{n}"].values[index] for n in ("unknowns", what))
            np.testing.assert_array_equal(line.get_xdata(), x[np.isfinite(x)])
            np.testing.assert_array_equal(line.get_ydata(), y[np.isfinite(x)])
            label = line.get_label()
            assert RESOLVED[index] in label
            assert f"{power[index]:.2f}" in label
        assert axes.get_xscale() == axes.get_yscale() == "log"
        labels = [text.get_text() for text in axes.get_legend().get_texts()]
        assert labels == [line.get_label() for line in artists(axes, what)]
    sizes = [text.get_text() for text in artists(figures["scaling"], "size")]
    assert sizes == ["64 x 64", "128 x 128", "128 x 128"]


@pytest.mark.usefixtures("unplaced")
def test_an_exponent_that_could_not_be_fitted_is_left_out(small):
    dataset = small["accuracy_cost"].copy(deep=True)
    dataset["scaling_exponent_memory"][1] = np.nan
    figure = drawing.draw("scaling", {"accuracy_cost": dataset})
    labels = [line.get_label() for line in artists(figure, "memory")]
    assert labels[1] == "polar"
    assert "nan" not in " ".join(labels)


@pytest.mark.long
def test_an_axis_shorter_than_a_decade_has_labels(small):
    dataset = small["accuracy_cost"].copy(deep=True)
    dataset["scaling_iterations"][:] = np.linspace(12, 47, 15).reshape(3, 5)
    axes = drawing.draw("scaling", {"accuracy_cost": dataset}).axes[0]
    gone = out_of_view(axes)
    shown = [label.get_text() for label in axes.get_yticklabels() if label not in gone]
    assert shown == ["$10$", "$20$", "$50$"]


# Atlas of stability


@pytest.mark.long
def test_the_atlas_shows_every_outcome(datasets, figures):
    dataset, figure = datasets["stability"], figures["stability_atlas"]
    blocks = [axes for axes in figure.axes if axes.get_label() != "<legend>"]
    assert len(blocks) == dataset.sizes["axis"]
    keys = [axes for axes in figure.axes if axes.get_label() == "<legend>"][:4]
    fills = [to_hex(axes.get_facecolor()) for axes in keys]
    signs = [axes.texts[0].get_text() for axes in keys]
    assert len(set(signs)) == 4
    names: list[str] = []
    for axes, axis in zip(blocks, dataset["axis"].values, strict=True):
        cases = dataset.isel(case=dataset["case_axis"].values == axis)
        if any(label.get_text() for label in axes.get_yticklabels()):
            names = [label.get_text() for label in axes.get_yticklabels()]
            assert axes.get_yticklabels()[0].get_fontweight() == "bold"
            assert names[0] == "shipped"
        expected = cases["outcome"].sel({"method": names}).values  # sel has its own `method`
        (mesh,) = artists(axes, "outcome")
        drawn = mesh.get_array()
        np.testing.assert_array_equal(drawn.filled(0).reshape(expected.shape), expected)
        colours = mesh.cmap(mesh.norm(drawn)).reshape(*expected.shape, 4)
        signed = {(t.get_position()[1] - 0.5, t.get_position()[0] - 0.5): t for t in axes.texts}
        assert len(signed) == (expected != 0).sum()
        for place, code in np.ndenumerate(expected):
            if code:
                assert to_hex(colours[place]) == fills[code - 1]
                assert signed[place].get_text() == signs[code - 1]
        hidden = ~np.isin(dataset["method"].values, names)
        assert not cases["outcome"].values[hidden].any()
        labels = [label.get_text() for label in axes.get_xticklabels()]
        assert labels == list(cases["case_label"].values)


@pytest.mark.long
def test_the_fills_differ_in_grey_and_their_signs_stand_out(figures):
    keys = [axes for axes in figures["stability_atlas"].axes if axes.get_label() == "<legend>"]
    assert to_hex(keys.pop().get_facecolor()) == "#ffffff"
    shades = [grey(axes.get_facecolor()) for axes in keys]
    assert all(a - b > 0.1 for a, b in zip(shades, shades[1:], strict=False))
    assert shades[0] < 0.95  # unlike the white of what does not apply
    for axes, shade in zip(keys, shades, strict=True):
        assert abs(grey(axes.texts[0].get_color()) - shade) > 0.4


@pytest.mark.long
def test_the_atlas_heads_every_block_and_explains_every_outcome(datasets, figures):
    shown = [text.replace("\n", " ") for text in texts(figures["stability_atlas"])]
    dataset = datasets["stability"]
    for what in ("axis_label", "axis_note"):
        for text in dataset[what].values:
            assert any(str(text) in line for line in shown)
    for name in ("converged: ", "slow: ", "wrong: ", "diverged: ", "blank: "):
        assert sum(line.startswith(name) for line in shown) == 1


def test_methods_that_apply_to_nothing_in_a_band_are_left_out():
    dataset = fake_stability(axes=1, methods=("paper", "jacobi", "shipped"))
    dataset["outcome"].loc[{"method": "jacobi"}] = 0
    figure = drawing.draw("stability_atlas", {"stability": dataset})
    labels = [label.get_text() for label in figure.axes[0].get_yticklabels()]
    assert labels == ["shipped", "paper"]


def test_a_stability_dataset_that_contradicts_itself_is_refused(small):
    stray = small["stability"].copy(deep=True)
    stray["case_axis"] = ("case", ["nowhere", *stray["case_axis"].values[1:]])
    with pytest.raises(ValueError, match="'nowhere' is not on the dimension 'axis'"):
        drawing.draw("stability_atlas", {"stability": stray})
    odd = small["stability"].copy(deep=True)
    odd["outcome"][0, 0] = 7
    with pytest.raises(ValueError, match="outcome 7 is none of 0 to 4"):
        drawing.draw("stability_atlas", {"stability": odd})
