"""Figures do not depend on the backend that the environment names."""

import os
import subprocess
import sys

import pytest

CODE = """
import sys
import numpy as np
import xarray as xr
from microslip.report.figures import drawing
drawing.import_matplotlib()
from stubs import figures_stub

dataset = figures_stub.spanning("a map")
drawing.save(drawing.draw("map", {"a": dataset}), sys.argv[1])
import matplotlib
print(matplotlib.rcParams._get("backend"))
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("backend", "later"),
    [(None, None), ("Qt4Agg", None), ("module://no_such_module", "module://no_such_module")]
    + [("svg", "svg")],
)
def test_figures_have_equal_bytes_with_any_backend_in_the_environment(backend, later, tmp_path):
    """Other figures of the same process use the backend of the environment."""
    files = []
    for name, value in (("plain", None), ("chosen", backend)):
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
        environment.pop("MPLBACKEND", None)
        environment |= {"MPLBACKEND": value} if value else {}
        files.append(tmp_path / f"{name}.png")
        done = subprocess.run(
            [sys.executable, "-c", CODE, files[-1]],
            env=environment, capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
    assert files[0].read_bytes() == files[1].read_bytes()
    if later:
        assert done.stdout.strip() == later
