"""Captions of Snakemake's report, and images of the documentation."""

from __future__ import annotations

import runpy
from pathlib import Path
from types import SimpleNamespace

import docutils.core
import jinja2
import numpy as np
import pytest
from PIL import Image
from stubs import figures_stub

from microslip.config.kinds import KINDS
from microslip.report.figures import drawing

ROOT = Path(__file__).parents[2]


def caption(name, **figure):
    """The caption of a figure as HTML."""
    text = (ROOT / "workflow" / "report" / "figure.rst").read_text(encoding="utf-8")
    wildcards = SimpleNamespace(stem=f"{name}.0123456789abcdef")
    config = SimpleNamespace(figures={name: SimpleNamespace(**{"sweep": None} | figure)})
    snakemake = SimpleNamespace(wildcards=wildcards, config=config, input=["a.nc"])
    rst = jinja2.Template(text).render(snakemake=snakemake)
    return docutils.core.publish_parts(rst, writer="html")["body"]


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "explorer"])
def test_every_kind_of_figure_has_a_caption(kind):
    shown = caption("my_figure", kind=kind)
    assert "system-message" not in shown and len(shown) > 200
    assert "the bend of" not in shown.lower()


def test_the_caption_of_figure_2_says_that_its_bend_is_in_the_solution():
    shown = " ".join(caption("fig2_transverse_map", kind="map", sweep=["a", "b"]).split())
    assert "bend of the contour 0.9" in shown and "Drawn from a, b." in shown


def test_images_of_the_pages_are_made_from_figures_and_are_smaller(tmp_path, monkeypatch):
    make = runpy.run_path(str(ROOT / "docs" / "make_images.py"))
    figures = tmp_path / "figures"
    figure = drawing.draw("map", {"transverse": figures_stub.fake_transverse()})
    path = drawing.save(figure, figures / "fig2.png")
    monkeypatch.setitem(make["main"].__globals__, "IMAGES", tmp_path)
    make["main"](tmp_path, "fig2")
    with Image.open(tmp_path / "fig2.png") as image, Image.open(path) as full:
        assert [round(1.5 * side) for side in image.size] == pytest.approx(full.size, abs=1)
        plain = full.convert("RGB").resize(image.size, Image.Resampling.LANCZOS)
        away = np.abs(np.asarray(image.convert("RGB"), int) - np.asarray(plain, int))
        assert np.percentile(away, 99) < 20  # neighbouring bands of the map differ by 12
    assert (tmp_path / "fig2.png").stat().st_size < 0.3 * path.stat().st_size
    with pytest.raises(SystemExit, match="does not exist"):
        make["main"](tmp_path, "fig9")
    pictures = list((ROOT / "docs" / "images").glob("*.png"))
    assert sum(path.stat().st_size for path in pictures) < 2.1e6
