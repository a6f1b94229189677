"""Every figure: reproducible files, layout without overlaps, complete labels."""

from __future__ import annotations

import re
import warnings
from functools import cache

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_pdf import PdfFile
from matplotlib.legend import Legend
from matplotlib.text import Text
from stubs import figures_stub as stub

from microslip.report.figures import drawing
from microslip.report.figures import style as look

pytestmark = pytest.mark.slow  # drawing takes one to two seconds


FIGURES = stub.every_figure()
SOME = ("history", "transients", "drives", "certified static", "lines", "coarse", "coarse motion")
"""Figures that are drawn in every run."""
each = pytest.mark.parametrize(
    "name", [pytest.param(n, marks=() if n in SOME else pytest.mark.long) for n in FIGURES]
)


@cache
def drawn(name):
    """A figure, which is drawn once and without a warning."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        kind, datasets = FIGURES[name]
        figure = stub.draw(kind, *datasets)
    figure.draw_without_rendering()  # places the titles
    return figure


@each
def test_its_files_are_complete_and_reproducible(name, tmp_path, monkeypatch):
    """Two drawings have the same pixels. The PDF is complete and has no date."""
    monkeypatch.setattr(PdfFile, "writeFonts", lambda f: f.writeObject(f.fontObject, {}))
    figures = drawn(name), drawn.__wrapped__(name)
    pictures = [drawing.save(f, tmp_path / f"{k}.png").read_bytes() for k, f in enumerate(figures)]
    assert pictures[0] == pictures[1]
    page = drawing.save(figures[1], tmp_path / "page.pdf").read_bytes()
    assert pictures[0].startswith(b"\x89PNG") and page.startswith(b"%PDF") and b"%%EOF" in page[-8:]
    assert b"Date" not in pictures[0] + page
    assert len(list(tmp_path.glob("[!.]*"))) == 3


def out_of_view(axes) -> set[Text]:
    """Labels of ticks outside the axes, which are not drawn."""
    return {
        label
        for axis in (axes.xaxis, axes.yaxis)
        for tick in (*axis.get_major_ticks(), *axis.get_minor_ticks())
        for label in (tick.label1, tick.label2)
        if not np.prod(np.sort(axis.get_view_interval()) - tick.get_loc()) <= 0
    }


@each
def test_it_fits_a_page_and_no_texts_or_legends_overlap(name):
    figure = drawn(name)
    size, edges = figure.get_size_inches(), figure.get_tightbbox().extents
    assert size[0] <= 7.1 and size[1] <= 9.85
    assert np.all(edges[:2] > -0.02) and np.all(edges[2:] < size + 0.02)
    absent = set().union(*map(out_of_view, figure.findobj(Axes)))
    shown = [t for t in figure.findobj(Text) if t.get_visible() and t.get_text().strip()]
    shown = [text for text in shown if text not in absent]
    assert min(text.get_fontsize() for text in shown) >= 7.0
    boxes = [text.get_window_extent() for text in shown]
    low, high = (np.array([getattr(box, end) for box in boxes]) for end in ("min", "max"))
    shared = np.minimum(high[:, None], high) - np.maximum(low[:, None], low)
    meet = np.triu((shared > 0.02 * figure.dpi).all(axis=2), 1)
    assert not [(shown[i].get_text(), shown[j].get_text()) for i, j in np.argwhere(meet)]
    frames = [axes.get_window_extent().padded(-2) for axes in figure.findobj(Axes) if axes.axison]
    legends = [legend for legend in figure.findobj(Legend) if name != "fit"]  # inside
    boxes = [legend.get_window_extent() for legend in legends]
    for index, box in enumerate(boxes):
        assert not any(box.overlaps(other) for other in [*frames, *boxes[index + 1 :]])


LETTER = re.compile(r"^\$\\bf\{\((\w+)\)\}\$")


@each
def test_its_panels_have_letters_and_its_axes_quantities_with_units(name):
    figure = drawn(name)
    heads = [text for text in figure.findobj(Text) if r"\bf{(" in text.get_text()]
    letters = [LETTER.match(text.get_text())[1] for text in heads if text.get_visible()]
    frames = [a for a in figure.findobj(Axes) if a.axison and a.get_label() != "<colorbar>"]
    assert sorted(letters) == [look.letter(k) for k in range(len(letters))]
    assert len(letters) == len(frames) or (len(frames) == 1 and not letters)
    for label in filter(None, (f() for a in frames for f in (a.get_xlabel, a.get_ylabel))):
        has_unit = re.search(r"\((s|bytes|dimensionless|degrees|m?N|mm/s)\)", label)
        assert has_unit or re.search(r"\$[^$]*/[^$]*\$|tilde|motion$", label), label


@pytest.mark.parametrize(("low", "high"), [(0.1, 0.13), (0.02, 0.6), (1e-3, 10), (1e-6, 1e6)])
@pytest.mark.parametrize("width", [1.6, 3.0])
def test_labels_of_a_logarithmic_axis_do_not_collide(low, high, width):
    with look.style():
        figure = look.new_figure(width, 1.5)
        axes = figure.subplots()
        look.logarithmic(axes, (low, high))
        figure.draw_without_rendering()
        shown = [
            tick.label1.get_window_extent()
            for tick in (*axes.xaxis.get_major_ticks(), *axes.xaxis.get_minor_ticks())
            if tick.label1.get_text() and low * 0.9999 <= tick.get_loc() <= high * 1.0001
        ]
        assert len(shown) >= 2
        shown.sort(key=lambda box: box.x0)
        assert all(a.x1 < b.x0 for a, b in zip(shown, shown[1:], strict=False))
