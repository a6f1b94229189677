"""Files of figures: provenance, settings and backends of the user, images of the documentation."""

import json
import os
import subprocess
import sys
from pathlib import Path

import matplotlib
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
