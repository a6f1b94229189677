"""Figures of groups of sweeps: a map of each with one scale, or a line of each."""

from __future__ import annotations

import re

import numpy as np
import pytest
import xarray as xr
from matplotlib.collections import PolyCollection
from matplotlib.legend import Legend
from matplotlib.text import Text
from test_figures import artists, check_nothing_cut_off, fake_map

from microslip.motions.by_name import MOTIONS, motion_named
from microslip.report.figures import drawing, lines, small_maps
from microslip.report.figures.formulas import mathtext
from microslip.theory import paper

pytestmark = pytest.mark.slow  # for drawing takes a second or two

VELOCITY = "v0 / (omega u_lim)"


def spanning(title="", shift=0.0, amplitude_label="x0 / u_lim", group="motions") -> xr.Dataset:
    """A map that falls from 1 to `shift`."""
    amplitude, velocity = np.linspace(0, 2, 7), np.geomspace(1e-3, 10, 9)
    mu = paper.large_amplitude_transverse(velocity, amplitude[:, None])
    return labelled(
        xr.Dataset(
            fake_map(shift + (1 - shift) * mu),
            coords={"amplitude": amplitude, "velocity": velocity, "poisson": 0.0},
            attrs={"title": title, "group": group},
        ),
        amplitude_label,
    )


def static(title="", velocity=(0.0, 1e-3), power=1.0, **more) -> xr.Dataset:
    """Static friction against amplitude, and friction at a small velocity."""
    amplitude, velocity = np.linspace(0, 1.2, 7), np.array(velocity)
    mu = np.maximum(1 - amplitude[:, None], 0) ** power + 10 * velocity * (amplitude[:, None] > 0)
    dataset = xr.Dataset(
        fake_map(mu) | more,
        coords={"amplitude": amplitude, "velocity": velocity, "poisson": 0.0},
        attrs={"title": title, "group": "static"},
    )
    return labelled(dataset, "y0 / u_lim")


def labelled(dataset, amplitude_label):
    dataset["velocity"].attrs["formula"] = VELOCITY
    if "amplitude" in dataset:
        dataset["amplitude"].attrs["formula"] = amplitude_label
    return dataset


def words(figure) -> str:
    return " ".join(text.get_text() for text in figure.findobj(Text))


def panels(figure) -> list:
    return [axes for axes in figure.axes if axes.get_label() != "<colorbar>"]


def motions(count=3):
    return {f"m{i}": spanning(f"motion {i}") for i in range(count)}


# Which datasets a figure is drawn from


@pytest.mark.usefixtures("unplaced")
def test_a_group_is_drawn_from_its_own_datasets_in_their_order():
    given = {"s": static("still"), "b": spanning("second"), "a": spanning("first")}
    figure = drawing.draw("extended_motions", given)
    titles = [axes.get_title(loc="left") for axes in panels(figure)]
    assert [title.split()[-1] for title in titles] == ["second", "first"]


def test_a_group_that_is_not_there_or_is_mixed_is_refused():
    with pytest.raises(ValueError, match="unknown figure 'extended_loops'; known figures: fig1"):
        drawing.draw("extended_loops", motions())
    odd = {"a": spanning("a"), "b": spanning("flat").isel(amplitude=[1])}
    with pytest.raises(ValueError, match="'flat' spans no map"):
        drawing.draw("extended_motions", odd)
    lacking = {"a": spanning("a").drop_vars("converged")}
    with pytest.raises(ValueError, match="'a' has no variable 'converged'"):
        drawing.draw("extended_motions", lacking)
    with pytest.raises(ValueError, match="allowed: up to 12"):
        drawing.draw("extended_motions", motions(13))
    many = {f"s{i}": static(f"s{i}") for i in range(9)}
    with pytest.raises(ValueError, match="allowed: up to 8"):
        drawing.draw("extended_static", many)


# Maps


@pytest.mark.parametrize(
    "count", [1, 3, *(pytest.param(n, marks=pytest.mark.long) for n in (2, 5, 12))]
)
def test_any_number_of_maps_has_room(count):
    figure = drawing.draw("extended_motions", motions(count))
    size, edges = figure.get_size_inches(), figure.get_tightbbox().extents
    assert np.all(edges[:2] > -0.02) and np.all(edges[2:] < size + 0.02)
    assert len(artists(figure, "map")) == count
    boxes = [axes.get_tightbbox() for axes in panels(figure)]
    assert not any(
        one.padded(-2).overlaps(other.padded(-2))
        for i, one in enumerate(boxes)
        for other in boxes[:i]
    )
    widths = [axes.get_position().width * size[0] for axes in panels(figure)]
    assert min(widths) > 1.3 and size[1] < 8.5  # a page
    small = [t.get_fontsize() for t in figure.findobj(Text) if t.get_text()]
    assert min(small) >= 7.0


@pytest.mark.usefixtures("unplaced")
def test_maps_share_one_scale_and_their_labels():
    figure = drawing.draw("extended_motions", motions(3))
    (bar,) = [axes for axes in figure.axes if axes.get_label() == "<colorbar>"]
    assert bar.get_ylim() == (0, 1)
    said = words(figure)
    assert said.count(r"$v_{0}/(\omega\,u_{\mathrm{lim}})$") == 1
    assert said.count(r"$x_{0}/u_{\mathrm{lim}}$") == 1
    other = motions(2) | {"c": spanning("c", amplitude_label="phi0 / phi_lk(a/2)")}
    labels = [axes.get_ylabel() for axes in panels(drawing.draw("extended_motions", other))]
    assert labels[2] == r"$\varphi_{0}/\varphi_{\mathrm{lk}}(a/2)$"
    assert labels[0] == r"$x_{0}/u_{\mathrm{lim}}$"


@pytest.mark.long
def test_friction_below_zero_widens_the_scale_of_all():
    fills, contours, labels = small_maps.levels_of([spanning(), spanning(shift=-0.234)])
    assert (fills[0], fills[-1]) == pytest.approx((-0.3, 1.0))
    assert np.diff(fills) == pytest.approx(0.05)
    assert 0 in contours and 0 in labels
    fills, *_ = small_maps.levels_of([spanning(shift=-0.004)])  # an error, no more
    assert (fills[0], fills[-1]) == (0.0, 1.0)
    given = {"a": spanning("a"), "b": spanning("b", shift=-0.234)}
    check_nothing_cut_off(drawing.draw("extended_motions", given))


@pytest.mark.usefixtures("unplaced")
def test_what_did_not_converge_is_hatched_and_said_once():
    given = motions(2)
    for dataset in given.values():
        dataset["converged"][2:4, 1] = 0
        dataset["mu_macro"][2, 1] = np.nan
    figure = drawing.draw("extended_motions", given)
    hatched = [a for a in artists(figure, "unconverged") if isinstance(a, PolyCollection)]
    assert [len(cells.get_paths()) for cells in hatched] == [2, 2]
    assert words(figure).count("not converged") == 1


def at_two_ratios(first):
    other = first.assign(mu_macro=first.mu_macro - 0.01).assign_coords(poisson=0.3)
    return xr.concat([first, other], "poisson", data_vars="all", combine_attrs="override")


@pytest.mark.long
@pytest.mark.usefixtures("unplaced")
def test_all_of_poissons_ratios_are_drawn_whatever_else_is_in_the_group():
    figure = drawing.draw(
        "extended_motions", {"a": at_two_ratios(spanning("a")), "b": spanning("b")}
    )
    heads = [axes.get_title(loc="left") for axes in panels(figure)]
    assert len(heads) == 3
    assert [r"$\nu = 0.3$" in head for head in heads] == [False, True, False]
    given = {"a": at_two_ratios(static("a")), "b": static("b")}
    (legend,) = drawing.draw("extended_static", given).findobj(Legend)
    said = [text.get_text() for text in legend.get_texts()]
    assert said == [r"a, $\nu = 0$", r"a, $\nu = 0.3$", "b"]
    # what they change has a figure for three maps, and more have a map of each
    changed = at_two_ratios(spanning()).assign_attrs(tolerance=1e-3, group="motions")
    changed["mu_macro_change"] = changed.mu_macro - changed.mu_macro.isel(poisson=0)
    given = {f"m{k}": changed.assign_attrs(title=f"m{k}") for k in range(4)}
    assert len(panels(drawing.draw("extended_motions", given))) == 8


# Texts from outside

TITLES = ["costs $5", r"$\frac{", r"\frac{1}{2} $x$", "a_b^c {} % # & ~", "_first", "$$"]
TITLES += [
    "it ends in \\",
    r"\$ and $",
    "\N{GREEK SMALL LETTER MU}\N{LATIN SMALL LETTER E WITH ACUTE}",
]


def drawn_words(figure):
    """All texts as they stand on the page: without escapes and formulas, on one line."""
    texts = [text.get_text() for text in figure.findobj(Text)]
    plain = [re.sub(r"(?<!\\)\$(?:\\\$|[^$])*(?<!\\)\$", "", text) for text in texts]
    return [" ".join(text.replace(r"\$", "$").split()) for text in plain]


@pytest.mark.long
@pytest.mark.usefixtures("unplaced")
def test_titles_are_drawn_as_they_stand(tmp_path):
    given = {f"m{k}": spanning(title) for k, title in enumerate(TITLES)}
    figure = drawing.draw("extended_motions", given)
    assert set(TITLES) <= set(drawn_words(figure))
    drawing.save(figure, tmp_path / "maps.pdf")
    given = {f"s{k}": static(title) for k, title in enumerate(TITLES[:8])}
    figure = drawing.draw("extended_static", given)
    (legend,) = figure.findobj(Legend)
    shown = [text.get_text() for text in legend.get_texts()]
    assert len(shown) == 8  # one that begins with an underscore, too
    assert r"$\_$first" in shown
    for kind in ("png", "pdf"):
        drawing.save(figure, tmp_path / f"lines.{kind}")


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:Glyph")
def test_a_sign_that_the_font_lacks_and_a_word_without_end_do_no_harm(tmp_path):
    given = {"a": spanning("\u4e2d\u6587"), "b": spanning("x" * 100), "c": spanning("c")}
    figure = drawing.draw("extended_motions", given)
    drawing.save(figure, tmp_path / "maps.pdf")
    heads = [axes.title for axes in panels(figure)] + [axes._left_title for axes in panels(figure)]
    right = max(head.get_window_extent().x1 for head in heads)
    assert right <= figure.bbox.x1
    boxes = [axes._left_title.get_window_extent() for axes in panels(figure)]
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])
    lines = drawing.draw(
        "extended_static", {"a": static("\u4e2d \U0001f600"), "b": static("y" * 100)}
    )
    for kind in ("png", "pdf"):
        drawing.save(lines, tmp_path / f"lines.{kind}")


# Lines


def test_lines_show_the_limit_and_marks_the_smallest_velocity():
    slow, loop = static("line", velocity=(0.0, 1e-3, 0.5)), static("loop", velocity=(1e-3,))
    slow = slow.isel(velocity=[0, 1])
    figure = drawing.draw("extended_static", {"a": slow, "b": loop})
    check_nothing_cut_off(figure)
    (line,) = artists(figure, "limit")  # a loop has none
    np.testing.assert_array_equal(line.get_ydata(), slow["mu_macro"].sel(velocity=0))
    marks = figure.axes[0].containers
    for container, dataset in zip(marks, (slow, loop), strict=True):
        np.testing.assert_array_equal(
            container.lines[0].get_ydata(), dataset["mu_macro"].sel(velocity=1e-3)
        )
    (legend,) = figure.findobj(Legend)
    assert [text.get_text() for text in legend.get_texts()] == ["line", "loop"]
    assert "marks: velocity $0.001$" in words(figure)


@pytest.mark.usefixtures("unplaced")
def test_a_limit_from_theory_is_drawn_on_its_finer_axis():
    fine = np.linspace(0, 1.2, 50)
    curve = ("amplitude_curve", np.maximum(1 - fine, 0))
    dataset = static("a", mu_static=("amplitude", np.zeros(7)), mu_static_curve=curve)
    dataset = dataset.assign_coords(amplitude_curve=fine)
    (line,) = artists(drawing.draw("extended_static", {"a": dataset}), "limit")
    assert len(line.get_xdata()) == 50
    # It holds for Poisson's ratio 0 alone.
    other = dataset.assign_coords(poisson=0.3)
    (line,) = artists(drawing.draw("extended_static", {"a": other}), "limit")
    assert len(line.get_xdata()) == 7


@pytest.mark.usefixtures("unplaced")
def test_marks_that_did_not_converge_are_hollow():
    dataset = static("a")
    dataset["converged"][3, 1] = 0
    figure = drawing.draw("extended_static", {"a": dataset})
    faces = [c.lines[0].get_markerfacecolor() for c in figure.axes[0].containers]
    assert faces == [lines.LOOKS[0][0], "white"]


@pytest.mark.usefixtures("unplaced")
def test_a_steady_motion_is_drawn_over_its_velocity():
    velocity = np.geomspace(0.01, 100, 9)
    force = paper.bore_forward(velocity)
    steady = {name: ("velocity", part[1][0]) for name, part in fake_map(force[None]).items()}
    dataset = labelled(
        xr.Dataset(
            steady | {"mu_forward_theory": ("velocity", force)},
            coords={"velocity": velocity, "poisson": 0.0},
            attrs={"title": "spin", "group": "steady"},
        ),
        "",
    )
    figure = drawing.draw("extended_steady", {"spin": dataset})
    assert figure.axes[0].get_xscale() == "log"
    (line,) = artists(figure, "limit")
    np.testing.assert_array_equal(line.get_ydata(), force)


def test_every_look_differs_from_the_others_in_colour_and_in_marker():
    colours, markers, _ = zip(*lines.LOOKS, strict=True)
    assert len(set(colours)) == len(set(markers)) == len(lines.LOOKS)


# Formulas


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        (VELOCITY, r"$v_{0}/(\omega\,u_{\mathrm{lim}})$"),
        ("v0 / (Omega phi0 a)", r"$v_{0}/(\Omega\,\varphi_{0}\,a)$"),
        ("phi0 / phi_lk(a/2)", r"$\varphi_{0}/\varphi_{\mathrm{lk}}(a/2)$"),
        ("", ""),
        ("largest amplitude / u_lim, if a", r"largest amplitude / $u_{\mathrm{lim}}$, if a"),
    ],
)
def test_formulas_become_math(formula, expected):
    assert mathtext(formula) == expected


@pytest.mark.parametrize("name", [*MOTIONS])
def test_labels_of_every_motion_can_be_set(name):
    from matplotlib.mathtext import MathTextParser

    motion = motion_named(name)
    for label in (motion.velocity_label, motion.amplitude_label):
        MathTextParser("path").parse(mathtext(label))


@pytest.mark.long
def test_maps_at_several_of_poissons_ratios_show_what_these_change():
    def at_ratios(title):
        first = spanning(title)
        other = first.assign(mu_macro=first.mu_macro - 0.01).assign_coords(poisson=0.5)
        both = xr.concat([first, other], "poisson", data_vars="all", combine_attrs="override")
        both["mu_macro_change"] = both.mu_macro - both.mu_macro.isel(poisson=0)
        return both.assign_attrs(tolerance=1e-3)

    given = {"one": at_ratios("along"), "other": at_ratios("across")}
    figure = drawing.draw("extended_motions", given)
    check_nothing_cut_off(figure)
    assert sum("less that" in axes.get_ylabel() for axes in figure.axes) == 2
    said = words(figure)
    assert all(part in said for part in ("along", "across", r"$\nu = 0.5$"))
