"""Maps: colours, the interpolated surface, contours with their numbers, and titles."""

from __future__ import annotations

import re

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.legend import Legend
from matplotlib.mathtext import MathTextParser
from matplotlib.text import Text
from stubs import figures_stub as stub
from stubs.figures_stub import artists, draw, words

from microslip.report.figures import maps
from microslip.report.figures import style as look
from microslip.scene.by_name import MOTIONS, motion_named
from microslip.theory import paper

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("without_layout")]


def contours_of(dataset):
    """The panel of a map, and its contours."""
    axes = artists(draw("map", dataset), "map")[0]
    (lines,) = artists(axes, "contours")
    return axes, lines


def test_a_coarse_map_shows_its_points_and_no_contours_that_they_cannot_support():
    axes, lines = contours_of(stub.spanning(size=(5, 5), low=1e-2))
    assert len(artists(axes, "points")[0].get_xdata()) == 25
    for level, path in zip(lines.levels, lines.get_paths(), strict=True):
        true = paper.large_amplitude_transverse(*path.vertices.T)
        assert np.all(abs(true - level) < 0.05)  # half the difference of two levels
    steep = stub.spanning(size=(5, 5), low=1e-2)
    steep["mu_macro"][:] = np.where(np.add.outer(np.arange(5), np.arange(5)) > 4, 1.0, 0.0)
    assert not any(len(path.vertices) for path in contours_of(steep)[1].get_paths())


def test_a_number_is_on_its_contour_apart_from_the_others_inside_the_frame():
    axes, lines = contours_of(stub.spanning(size=(25, 25), low=1e-2))
    assert not artists(axes, "points")
    assert all(len(path.vertices) for path in lines.get_paths())
    axes.get_figure(root=True).draw_without_rendering()
    numbers = [text for text in axes.texts if re.fullmatch(r"-?\d\.\d", text.get_text())]
    assert len(numbers) >= 3
    frame = axes.get_window_extent()
    for text in numbers:
        value, place = float(text.get_text()), text.get_position()
        assert float(paper.large_amplitude_transverse(*place)) == pytest.approx(value, abs=0.01)
        assert frame.count_contains(text.get_window_extent().corners()) == 4
        height = text.get_fontsize() * axes.get_figure(root=True).dpi / 72
        for level, path in zip(lines.levels, lines.get_paths(), strict=True):
            away = axes.transData.transform(path.vertices) - axes.transData.transform(place)
            if abs(level - value) > 0.05:
                assert np.hypot(*away.T).min() > 0.7 * height
            else:  # apart from the ends of its own contour
                assert np.hypot(*away[[0, -1]].T).min() > 4.0 * height


def test_a_group_is_drawn_with_one_scale_and_shared_labels():
    data = [stub.spanning("second"), stub.spanning("first")]
    figure = draw("map", *data)
    titles = [axes.get_title(loc="left") for axes in artists(figure, "map")]
    assert [title.split()[-1] for title in titles] == ["second", "first"]
    (bar,) = [axes for axes in figure.axes if axes.get_label() == "<colorbar>"]
    assert bar.get_ylim() == (0, 1)
    assert words(figure).count(r"$x_{0}/u_{\mathrm{lim}}$") == 1
    figure = draw("map", *data, stub.spanning("c", formula="phi0 / phi_lk(a/2)"))
    labels = [axes.get_ylabel() for axes in artists(figure, "map")]
    formulas = r"$x_{0}/u_{\mathrm{lim}}$", r"$\varphi_{0}/\varphi_{\mathrm{lk}}(a/2)$"
    assert all(one in label for one, label in zip(formulas, labels[::2], strict=True))


def test_friction_below_zero_widens_the_scale_of_all():
    negative = stub.spanning("a", shift=-0.234)
    scale = maps.friction([stub.spanning(), negative])
    assert scale.fills[[0, -1]] == pytest.approx((-0.3, 1.0)) and 0 in scale.lines
    rounded = maps.friction([stub.spanning(shift=-0.004)])  # within the error of the points
    assert tuple(rounded.fills[[0, -1]]) == (0.0, 1.0)
    axes = draw("map", negative, stub.spanning("b")).axes[0]
    (bands,) = [one for one in axes.collections if len(getattr(one, "levels", ())) > 20]
    middles = (bands.levels[1:] + bands.levels[:-1]) / 2
    expected = scale.colours(scale.norm(middles))[:, :3]
    np.testing.assert_allclose(bands.get_facecolor()[:, :3], expected, atol=0.03)
    (lines,) = artists(axes, "contours")
    dashes = [style[1] is not None for style in lines.get_linestyle()]
    assert dashes == [level < 0 for level in lines.levels]


def test_all_of_poissons_ratios_are_drawn():
    figure = draw("map", stub.at_ratios(stub.spanning("a"), 0.0, 0.3), stub.spanning("b"))
    heads = [axes.get_title(loc="left") for axes in artists(figure, "map")]
    assert ["to 0.3$" in head for head in heads] == [False, True, False]
    bars = [axes.get_ylabel() for axes in figure.axes if axes.get_label() == "<colorbar>"]
    assert ["change of" in label for label in bars] == [False, True]
    static = stub.at_ratios(stub.static("a"), 0.0, 0.3).drop_vars("mu_macro_change")
    (legend,) = draw("curves", static, stub.static("b")).findobj(Legend)
    labels = [text.get_text() for text in legend.get_texts()]
    limit = "limit for velocity to 0"  # one line, because the limits are equal
    assert labels == [limit, r"a, $\nu = 0$", r"a, $\nu = 0.3$", "b"]
    figure = draw("map", stub.at_ratios(stub.fake_bore(), *np.linspace(0, 0.5, 11)))
    assert len(artists(figure, "map")) == 11 and len(artists(figure, "computed")) == 22


def test_a_change_within_twice_the_tolerance_has_the_palest_colour():
    two = stub.at_ratios(stub.fake_bore(), 0.0, 0.5).assign_attrs(tolerance=0.01)
    scale = maps.change([two.isel(poisson=1)])
    levels = np.sort(np.abs(scale.fills))
    assert levels[:2] == pytest.approx([0.02, 0.02]) and levels[-1] >= 0.05
    assert scale.colours(scale.norm(0.0))[:3] == pytest.approx((0.97, 0.97, 0.97), abs=0.01)


COARSE = stub.spanning(size=(5, 7), low=1e-2)
FINER = COARSE.interp(velocity=np.geomspace(0.011, 9, 20), amplitude=np.linspace(0.25, 2.9, 20))


@pytest.mark.parametrize("ratios", [(0.0,), (0.0, 0.3)])
@pytest.mark.parametrize(
    ("dataset", "values", "note"),
    [
        *((stub.holed(*size), stub.holed(*size), "computed points") for size in ((7, 5), (15, 13))),
        (COARSE, FINER, "no contour is certain"),
    ],
)
def test_every_value_of_a_map_is_visible_as_colour_or_marker(dataset, values, note, ratios):
    """Half of the points of some maps have no value, so that no cell of them has a colour."""
    figure = draw("map", stub.at_ratios(dataset, *ratios) if len(ratios) > 1 else dataset)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    image = np.asarray(canvas.buffer_rgba())[::-1, :, :3].min(axis=2)
    points = values.mu_macro.to_series().dropna().reset_index()[["velocity", "amplitude"]]
    at = figure.axes[0].transData.transform(points.values).round().astype(int)
    assert len(at) and max(image[y - 3 : y + 4, x - 3 : x + 4].min() for x, y in at) <= 240
    assert note in words(figure)
    (bare,) = artists(figure.axes[0], "bare-points")
    assert len(bare.get_offsets()) == (len(points) if dataset is not COARSE else 0)


@pytest.mark.parametrize("velocity", [0.1, 1e-3])
def test_figure_2_names_the_velocities_of_the_markers_and_of_the_limits(velocity):
    dataset = stub.fake_transverse(5).assign_coords(velocity=velocity * np.geomspace(1, 100, 5))
    text = words(draw("map", dataset))
    assert f"markers: $\\tilde v_0 = {look.number(velocity)}$" in text.replace("{v}", " v")
    assert "\\to 0$" in text


def test_all_computed_values_of_a_cut_are_inside_its_panel():
    """Values can exceed 1, and static friction can vanish well before the largest amplitude."""
    markers = artists(
        draw("map", stub.at_ratios(stub.fake_transverse(9), 0.0, 0.2, 0.5)), "computed"
    )
    assert len(markers) == 6
    for line in markers:
        box = line.axes.get_window_extent().padded(1)
        assert box.count_contains(line.axes.transData.transform(line.get_xydata())) == 9
    assert len({line.get_markersize() for line in markers}) == 3  # all at one place can be seen


TITLES = ["costs $5", r"$\frac{", r"\frac{1}{2} $x$", "a_b^c {} % # & ~", "_first", "$$"]
TITLES += ["it ends in \\", r"\$ and $"]


@pytest.mark.parametrize(("kind", "made"), [("map", stub.spanning), ("curves", stub.static)])
def test_titles_are_drawn_verbatim(kind, made):
    figure = draw(kind, *map(made, TITLES))
    figure.draw_without_rendering()  # parses them
    texts = [text.get_text() for text in figure.findobj(Text)]
    plain = [re.sub(r"(?<!\\)\$(?:\\\$|[^$])*(?<!\\)\$", "", text) for text in texts]
    assert set(TITLES) <= {" ".join(text.replace(r"\$", "$").split()) for text in plain}


@pytest.mark.parametrize("name", [*MOTIONS])
def test_labels_of_every_motion_can_be_set(name):
    motion = motion_named(name)
    for label in (motion.velocity_label, motion.amplitude_label):
        MathTextParser("path").parse(look.mathtext(label))
