"""Files of figures: provenance, settings and backends of the user, images of the documentation."""

import json
import os
import runpy
import subprocess
import sys
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from PIL import Image
from stubs import figures_stub as stub

from microslip.foundation.files import CacheError
from microslip.report.figures import drawing

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("without_layout")]
STEADY = {"continuous_bore": stub.fake_continuous_bore()}


def test_a_file_contains_its_provenance(tmp_path):
    attributes = {"title": "friction", "source_digest": "f00d", "author": "nobody"}
    made = {name: one.assign_attrs(attributes) for name, one in STEADY.items()}
    figure = drawing.draw("curves", made)
    with Image.open(drawing.save(figure, tmp_path / "figure.png")) as image:
        (provenance,) = json.loads(image.info["Description"])
        assert image.size[0] == pytest.approx(300 * figure.get_size_inches()[0], abs=1)
    assert provenance["source_digest"] == "f00d" and "author" not in provenance
    assert b"f00d" in drawing.save(figure, tmp_path / "figure.pdf").read_bytes()


def test_a_failed_save_leaves_the_old_file(tmp_path, monkeypatch):
    figure, path = drawing.draw("transients", STEADY), tmp_path / "figure.png"
    path.write_text("old")

    def fail(target, **_):
        Path(target).write_text("half")
        raise OSError("disk full")

    monkeypatch.setattr(figure, "savefig", fail)
    with pytest.raises(CacheError, match="disk full"):
        drawing.save(figure, path)
    assert [file.read_text() for file in tmp_path.iterdir()] == ["old"]


def test_the_users_matplotlib_settings_are_ignored_and_restored(tmp_path):
    expected = drawing.save(drawing.draw("transients", STEADY), tmp_path / "a.png").read_bytes()
    with matplotlib.rc_context({"font.size": 20, "savefig.dpi": 50, "lines.linewidth": 9}):
        result = drawing.save(drawing.draw("transients", STEADY), tmp_path / "b.png").read_bytes()
        assert matplotlib.rcParams["font.size"] == 20
    assert result == expected


CODE = """
import sys
from microslip.report.figures import drawing
drawing.import_matplotlib()
import matplotlib
print(matplotlib.rcParams._get("backend"))
from stubs import figures_stub
drawing.save(drawing.draw("map", {"a": figures_stub.spanning("a map")}), sys.argv[1])
"""


@pytest.mark.parametrize("backend", ["Qt4Agg", "module://no_such_module", "svg"])
def test_a_figure_can_be_drawn_with_any_backend_in_the_environment(backend, tmp_path):
    """Other figures of the same process use the backend if it is known."""
    environment = {"PYTHONPATH": os.pathsep.join(sys.path), "MPLBACKEND": backend}
    command = [sys.executable, "-c", CODE, tmp_path / "a.png"]
    done = subprocess.run(command, env=os.environ | environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    if backend != "Qt4Agg":
        assert done.stdout.strip() == backend
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


def test_images_of_the_pages_are_made_from_figures_and_are_smaller(tmp_path, monkeypatch):
    root = Path(__file__).parents[2]
    make = runpy.run_path(str(root / "docs" / "make_images.py"))
    figure = drawing.draw("map", {"transverse": stub.fake_transverse()})
    path = drawing.save(figure, tmp_path / "figures" / "fig2.png")
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
