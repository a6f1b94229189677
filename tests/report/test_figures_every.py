"""Every figure: it saves whole and reproducibly; its letters and labels are as in the others."""

from __future__ import annotations

import re
import warnings
from functools import cache

import numpy as np
import pytest
import test_figures
import test_figures_groups as groups
import test_figures_studies as of_studies
from matplotlib.axes import Axes
from matplotlib.backends.backend_pdf import PdfFile
from matplotlib.text import Text
from PIL import Image
from stubs import certified_stub, drives_stub, fit_stub, propulsion_stub, studies_stub

from microslip.report.figures import drawing
from microslip.report.figures import style as look
from microslip.studies import registry

pytestmark = pytest.mark.slow  # for drawing takes a second or two


def given() -> dict[str, tuple[str, dict]]:
    """Every figure there is, by a name of its own: what it is called, and small datasets for it."""
    motions = {"transverse": test_figures.fake_transverse(5), "bore": test_figures.fake_bore(5)}
    two = {name: test_figures.at_ratios(dataset, 0.0, 0.5) for name, dataset in motions.items()}
    for dataset in two.values():
        dataset["velocity"].attrs["formula"] = "v0 / (omega u_lim)"
        dataset["amplitude"].attrs["formula"] = "y0 / u_lim"
    motions |= {"continuous_bore": test_figures.fake_continuous_bore()} | of_studies.few()
    found = {name: (name, motions) for name in drawing.FIGURES} | {"poisson": ("poisson", two)}
    found |= {f"two {name}": (name, two) for name in ("fig2_transverse_map", "fig6_bore_map")}
    maps = {f"drift_{motion}": drives_stub.drift(motion) for motion in ("transverse", "bore")}
    found |= {"drift_maps": ("drift_maps", maps), "drives": ("drives", drives_stub.pulled())}
    found["pairs"] = "pairs", drives_stub.pairs()
    answer, _ = studies_stub.answered(propulsion_stub.propulsion_result)
    propulsion = registry.build("propulsion", propulsion_stub.configured(), answer)
    found["propulsion"] = "propulsion", {"propulsion": propulsion}
    found["fit"] = "fit", {"fit": fit_stub.fitted()}
    found["certified"] = "certified_bore", {"certified_bore": certified_stub.bore()}
    found["deep"] = "certified_bore", {"certified_bore": certified_stub.bore(poisson=[0.1, 0.4])}
    static = certified_stub.bore(velocity=[0], poisson=[0.1, 0.4])
    found["certified drift"] = "certified_weights", {"certified_weights": certified_stub.drifting()}
    found["certified static"] = "certified_bore", {"certified_bore": static}
    found["maps"] = "extended_motions", groups.motions(3)
    found["lines"] = "extended_static", {"a": groups.static("a"), "b": groups.static("b")}
    return found


GIVEN = given()
ALIKE = ("two fig2_transverse_map", "two fig6_bore_map", "fig6_bore_map", "accuracy_vs_work")
NAMES = [name for name in GIVEN if name not in ALIKE]
"""One figure of every module that draws; those left out differ in labels and in what is shown."""
SOME = ("fig1_force_history", "fig3_traction_field", "fig5_transients", "pairs", "certified static")
"""Figures that every run looks at: curves, a field, panels, drives, a map. Others take long."""


def each(names):
    """Names of figures as parameters, with the mark of those that take long."""
    marks = {name: () if name in SOME else pytest.mark.long for name in names}
    return pytest.mark.parametrize("name", [pytest.param(n, marks=m) for n, m in marks.items()])


@pytest.fixture(scope="module")
def drawn():
    """A function of a figure's name: that figure, drawn once, without complaint."""

    @cache
    def draw(name):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            return drawing.draw(*GIVEN[name])

    return draw


def test_what_every_run_looks_at_is_there():
    assert set(SOME) < set(NAMES)


@pytest.mark.usefixtures("unplaced")
@each(NAMES)
def test_saves_whole_and_reproducibly(name, tmp_path, monkeypatch):
    """Drawn twice it gives the same pixels; as a PDF it is whole, too, and bears no date.

    Where things lie is for the test below, and so are fonts: both take longer than to draw.
    """
    monkeypatch.setattr(PdfFile, "writeFonts", lambda f: f.writeObject(f.fontObject, {}))
    twice = [drawing.draw(*GIVEN[name]) for _ in range(2)]
    for figure in twice:
        figure.set_dpi(100)  # a ninth of the pixels
    pictures = [drawing.save(f, tmp_path / f"{k}.png") for k, f in enumerate(twice)]
    first, second = (path.read_bytes() for path in pictures)
    assert first == second
    page = drawing.save(twice[1], tmp_path / "page.pdf").read_bytes()
    assert first.startswith(b"\x89PNG") and page.startswith(b"%PDF") and b"%%EOF" in page[-8:]
    assert b"Date" not in first + page
    assert len(list(tmp_path.glob("[!.]*"))) == 3


@pytest.mark.long
@each(["fig3_traction_field", "maps"])
def test_a_page_is_the_same_when_it_is_drawn_again(name, drawn, tmp_path):
    """As a PDF, with its fonts and its hatches; all figures are written by the same few lines."""
    pages = [
        drawing.save(figure, tmp_path / "new" / f"{k}.pdf").read_bytes()
        for k, figure in enumerate((drawn(name), drawing.draw(*GIVEN[name])))
    ]
    assert pages[0] == pages[1]


LETTER = re.compile(r"^\$\\bf\{\((\w+)\)\}\$")


@each(GIVEN)
def test_letters_of_panels_are_alike_in_every_figure(name, drawn):
    figure = drawn(name)
    figure.draw_without_rendering()  # which puts all titles in their places
    assert np.all(figure.get_tightbbox().extents[:2] > -0.02)
    texts = [text for text in figure.findobj(Text) if text.get_visible()]
    heads = [text for text in texts if r"\bf{(" in text.get_text()]
    letters = [LETTER.match(text.get_text())[1] for text in heads]
    assert sorted(letters) == look.letters(len(letters))
    assert {text.get_fontsize() for text in heads} <= {look.HEADING}
    panels = [a for a in figure.findobj(Axes) if a.axison and "<" not in str(a.get_label())]
    assert len(letters) in (0, len(panels))
    assert len(panels) == 1 or letters
    for text in heads:  # its left edge is that of a panel
        left = text.get_window_extent().x0
        edges = [axes.get_window_extent().x0 for axes in panels]
        assert min(abs(left - edge) for edge in edges) < 0.04 * figure.dpi


@each(GIVEN)
def test_every_axis_has_a_quantity_and_its_unit(name, drawn):
    for axes in drawn(name).findobj(Axes):
        texts = [axes.get_xlabel(), axes.get_ylabel()]
        for text in filter(None, texts):
            words = re.sub(r"\$[^$]*\$", "", text)
            assert re.search("[a-z]{3}", words) or name == "maps", text
            has_unit = re.search(r"\((s|bytes|dimensionless|degrees|m?N|mm/s)\)", text)
            ratio = re.search(r"\$[^$]*/[^$]*\$", text) or "$t/t" in text
            symbol = "two" in name and text.startswith(("forward velocity", "amplitude"))
            less = "less that at" in text  # a difference of ratios
            assert has_unit or ratio or symbol or less, text


def test_figures_3_to_5_speak_of_forward_and_lateral(drawn):
    for name in ("fig3_traction_field", "fig4_continuous_bore", "fig5_transients"):
        said = " ".join(text.get_text() for text in drawn(name).findobj(Text))
        assert "lateral slip" not in said
        assert not re.search(r"\$x/a|\$y/a|F_y|\\mu\}_y", said), name
        assert "forward" in said
    starts = [axes.get_title(loc="left") for axes in drawn("fig5_transients").axes]
    assert starts[2].endswith("full forward slip")


def test_pictures_have_300_dots_an_inch(tmp_path, drawn):
    figure = drawn("fig4_continuous_bore")
    with Image.open(drawing.save(figure, tmp_path / "figure.png")) as image:
        assert image.size[0] == pytest.approx(300 * figure.get_size_inches()[0], abs=1)
