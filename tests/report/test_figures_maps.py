"""Maps: their colours, the surface between the points, and the numbers on contours."""

from __future__ import annotations

import re

import matplotlib
import numpy as np
import pytest
import test_figures
import test_figures_groups as groups
import xarray as xr
from matplotlib.colors import to_rgb

from microslip.datasets.query import accessor
from microslip.report.figures import drawing, map_panel, signed, small_maps, ticks
from microslip.report.figures import style as look
from microslip.report.figures.surface import refined
from microslip.theory import paper

pytestmark = pytest.mark.slow  # for drawing takes a second or two

# Colours

# Machado, Oliveira, Fernandes, IEEE TVCG 15 (2009) 1291, severity 1: linear RGB as it is seen.
SEEN = {
    "protan": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216]]
    + [[-0.003882, -0.048116, 1.051998]],
    "deutan": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413]]
    + [[-0.011820, 0.042940, 0.968881]],
    "tritan": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602]]
    + [[0.004733, 0.691367, 0.303900]],
    "normal": np.eye(3),
}
XYZ = np.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750]])
XYZ = np.vstack([XYZ, [0.0193339, 0.1191920, 0.9503041]])


def lab(colours, seen="normal"):
    """CIELAB of sRGB colours, shape (n, 3), as someone sees them; D65."""
    c = np.asarray(colours, float)
    linear = np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
    linear = np.clip(linear @ np.transpose(SEEN[seen]), 0, 1)
    x = linear @ XYZ.T / XYZ.sum(axis=1)
    f = np.where(x > (6 / 29) ** 3, np.cbrt(x), x / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.stack([116 * f[:, 1] - 16, 500 * (f[:, 0] - f[:, 1]), 200 * (f[:, 1] - f[:, 2])], -1)


def shown(values, levels=(-1.0, 1.0)):
    """The colours of values in a figure with these levels."""
    colours, norm = signed.scale(levels)
    return colours(norm(np.asarray(values, float)))[:, :3]


def test_friction_has_the_colours_of_figure_2_wherever_it_may_be_negative():
    values = np.linspace(0, 1, 21)
    ours = matplotlib.colormaps[look.COLOURMAP](values)[:, :3]
    for lowest in (0.0, -0.3, -1.0):
        np.testing.assert_allclose(shown(values, (lowest, 1.0)), ours, atol=0.02)


def test_negative_friction_is_even_and_another_hue_for_all_kinds_of_colour_vision():
    below = shown(-np.linspace(0, 1, 21))
    steps = np.linalg.norm(np.diff(lab(below), axis=0), axis=1)
    assert steps.max() < 1.3 * steps.min()
    assert np.all(np.diff(lab(below)[:, 0]) > 0)  # away from 0 it gets lighter, as above 0
    above = shown(np.linspace(0.1, 1, 91))
    for seen in SEEN:
        clear = lab(shown([-0.1, -0.2, -0.3, -0.4, -0.5]), seen)
        away = np.linalg.norm(clear[:, None] - lab(above, seen), axis=-1)
        assert away.min() > 10, seen  # 2 or 3 can just be told apart


def test_a_map_with_negative_friction_is_drawn_in_these_colours():
    given = {"a": groups.spanning("a", shift=-0.234), "b": groups.spanning("b")}
    figure = drawing.draw("extended_motions", given)
    (bands,) = [c for c in figure.axes[0].collections if len(getattr(c, "levels", ())) > 20]
    middles = (bands.levels[1:] + bands.levels[:-1]) / 2
    drawn = bands.get_facecolor()[:, :3]
    np.testing.assert_allclose(drawn, shown(middles), atol=0.03)
    (lines,) = test_figures.artists(figure.axes[0], "contours")
    assert lines.get_linestyle()[0][1] is not None  # dashed below 0 ...
    assert lines.get_linestyle()[-1][1] is None  # ... and not above


# The surface between the points


def mapped(velocities=9, amplitudes=7):
    """A map that query can be asked about, far from any limit on its values."""
    velocity, amplitude = np.geomspace(1e-2, 10, velocities), np.linspace(0.2, 3, amplitudes)
    mu = paper.large_amplitude_transverse(velocity, amplitude[:, None])
    return xr.Dataset(
        test_figures.fake_map(mu),
        coords={"amplitude": amplitude, "velocity": velocity, "poisson": 0.0},
        attrs={"motion": "longitudinal"},
    )


def test_the_surface_is_that_of_friction_at():
    dataset = mapped()
    x, y, fine = refined(*(dataset[n].values for n in ("velocity", "amplitude", "mu_macro")))
    assert min(fine.shape) > 150
    said = accessor.Friction(dataset).at(x, np.clip(y, 0.2, 3))
    away = np.abs(fine.filled(np.inf) - said["mu_macro"].values)
    assert np.all(away <= said["mu_macro_error"].values)
    assert np.median(away) < 1e-12  # it differs where a cubic would leave the points' values alone
    nodes = np.searchsorted(y, dataset.amplitude.values), np.searchsorted(x, dataset.velocity)
    np.testing.assert_allclose(fine[np.ix_(*nodes)], dataset.mu_macro, atol=1e-12)


def test_no_island_is_drawn_that_nobody_computed():
    steep = np.array([[1.0, 1, 1, 1], [0.9, 1, 1, 1], [0, 0, 1, 1], [0, 0, 0, 1]])
    x, y = np.geomspace(0.01, 10, 4), np.arange(4.0)
    _, _, fine = refined(x, y, steep)
    assert fine.min() >= 0 and fine.max() <= 1
    rising = np.diff(fine, axis=1)
    assert rising.min() >= -1e-12  # as the points do


def test_what_is_not_known_stays_open_and_its_neighbours_do_not():
    values = np.add.outer(np.arange(6.0), np.arange(7.0))
    values[2, 3] = np.nan
    x, y = np.geomspace(1, 64, 7), np.arange(6.0)
    fine_x, fine_y, fine = refined(x, y, values)
    hole = np.ma.getmaskarray(fine)
    inside = (fine_y > 1)[:, None] & (fine_y < 3)[:, None]
    inside = inside & (fine_x > x[2]) & (fine_x < x[4])
    assert np.array_equal(hole, inside)
    plane = np.add.outer(fine_y, np.log2(fine_x))
    np.testing.assert_allclose(fine[~hole], plane[~hole], atol=1e-9)


# What the points support


def drawn(dataset):
    """The panel of a map that is drawn alone, and its contours."""
    dataset.attrs = {"title": "m", "group": "motions"}
    figure = drawing.draw("extended_motions", {"m": dataset})
    (axes,) = test_figures.artists(figure, "map")
    (lines,) = test_figures.artists(axes, "contours")
    return axes, lines


def test_a_coarse_map_shows_its_points_and_no_contours_that_they_cannot_support():
    axes, lines = drawn(mapped(5, 5))
    (points,) = test_figures.artists(axes, "points")
    assert len(points.get_xdata()) == 25
    for level, path in zip(lines.levels, lines.get_paths(), strict=True):
        for velocity, amplitude in path.vertices:
            true = float(paper.large_amplitude_transverse(velocity, amplitude))
            assert abs(true - level) < 0.1  # half the distance of two contours
    axes, lines = drawn(mapped(25, 25))
    assert not test_figures.artists(axes, "points")
    assert all(len(path.vertices) for path in lines.get_paths())


def test_contours_of_a_steep_map_of_few_points_are_left_out():
    dataset = mapped(5, 5)
    dataset["mu_macro"][:] = np.where(np.add.outer(np.arange(5), np.arange(5)) > 4, 1.0, 0.0)
    _, lines = drawn(dataset)
    assert not any(len(path.vertices) for path in lines.get_paths())


# Ticks of short ranges


@pytest.mark.parametrize(
    ("low", "high"), [(0.1, 0.13), (0.05, 0.2), (0.02, 0.6), (1e-3, 10), (2e-5, 3e-5), (1.0, 1.002)]
)
@pytest.mark.parametrize("width", [1.2, 3.0])
def test_labels_of_a_logarithmic_axis_do_not_collide(low, high, width):
    with look.style():
        figure = look.new_figure(width, 1.5)
        axes = figure.subplots()
        axes.set(xscale="log", xlim=(low, high))
        ticks.logarithmic(axes.xaxis)
        figure.draw_without_rendering()
        drawn = (*axes.xaxis.get_major_ticks(), *axes.xaxis.get_minor_ticks())
        shown = [
            tick.label1.get_window_extent()
            for tick in drawn
            if tick.label1.get_text() and low * 0.9999 <= tick.get_loc() <= high * 1.0001
        ]
        assert len(shown) >= 2
        shown.sort(key=lambda box: box.x0)
        assert all(a.x1 < b.x0 for a, b in zip(shown, shown[1:], strict=False))


# Numbers on contours


@pytest.mark.parametrize(
    ("velocities", "amplitudes", "least"),
    [
        # too coarse for contours: dots, without numbers
        *(pytest.param(n, n, 0, marks=pytest.mark.long) for n in (3, 4)),
        (13, 9, 6),  # one on each map at least
    ],
)
def test_numbers_are_inside_the_frame_and_off_other_lines(velocities, amplitudes, least):
    given = {f"m{k}": mapped(velocities, amplitudes) for k in range(6)}
    for key, dataset in given.items():
        dataset.attrs = {"title": key, "group": "motions"}
    figure = drawing.draw("extended_motions", given)
    figure.draw_without_rendering()
    found = 0
    for axes in test_figures.artists(figure, "map"):
        (lines,) = test_figures.artists(axes, "contours")
        frame = axes.get_window_extent()
        numbers = [text for text in axes.texts if re.fullmatch(r"-?\d\.\d", text.get_text())]
        found += len(numbers)
        for text in numbers:
            box = text.get_window_extent()
            assert frame.x0 <= box.x0 and box.x1 <= frame.x1
            assert frame.y0 <= box.y0 and box.y1 <= frame.y1
            for level, path in zip(lines.levels, lines.get_paths(), strict=True):
                if f"{level:.1f}" == text.get_text():
                    continue
                pixels = axes.transData.transform(path.vertices)
                turn = np.radians(text.get_rotation())
                c, s = np.cos(turn), np.sin(turn)
                middle = axes.transData.transform(text.get_position())
                beside = (pixels - middle) @ np.array([[c, -s], [s, c]])
                width = look.measurer(text.get_fontsize())(text.get_text()) * figure.dpi
                height = text.get_fontsize() * figure.dpi / 72
                over = (np.abs(beside) < [0.5 * width, 0.4 * height]).all(axis=1)
                assert not over.any(), (level, text.get_text())
    assert found >= least


def test_a_number_stands_on_the_contour_of_its_level():
    """On lines of many points, too."""
    axes, lines = drawn(mapped(25, 25))
    axes.figure.draw_without_rendering()
    numbers = [text for text in axes.texts if re.fullmatch(r"-?\d\.\d", text.get_text())]
    assert len(numbers) >= 3
    for text in numbers:
        velocity, amplitude = text.get_position()
        there = float(paper.large_amplitude_transverse(velocity, amplitude))
        assert there == pytest.approx(float(text.get_text()), abs=0.01)


def test_lines_stand_out_from_their_bands():
    for levels in (map_panel.FILL_LEVELS, small_maps.levels_of([groups.spanning(shift=-0.9)])[0]):
        lines = np.arange(levels[0] + 0.1, 0.95, 0.1)
        for level, ink in zip(lines, signed.inks(lines, levels), strict=True):
            behind, line = (lab([c])[0, 0] for c in (shown([level], levels)[0], to_rgb(ink)))
            assert abs(behind - line) > 25, level
