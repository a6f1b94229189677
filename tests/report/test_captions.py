"""Images of the documentation."""

from __future__ import annotations

import runpy
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from stubs import figures_stub

from microslip.report.figures import drawing

ROOT = Path(__file__).parents[2]


def test_images_of_the_pages_are_made_from_figures_and_are_smaller(tmp_path, monkeypatch):
    make = runpy.run_path(str(ROOT / "docs" / "make_images.py"))
    figures = tmp_path / "figures"
    figure = figures_stub.draw(
        "fig2_transverse_map", {"transverse": figures_stub.fake_transverse()}
    )
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
    shown = {*figures_stub.FIGURES} - {"fit"}
    assert shown <= {path.stem for path in pictures}
    assert sum(path.stat().st_size for path in pictures) < 2.1e6
