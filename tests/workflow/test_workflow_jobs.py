"""Imports of the scripts of jobs: solving imports nothing for drawing or collecting."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from stubs.workflow_project import ENVIRONMENT

ROOT = Path(__file__).parents[2]
HEAVY = {"matplotlib", "xarray", "netCDF4", "pandas", "plotly", "pint", "dask", "jsonschema"}
SOLVE = "import microslip; microslip.solve('bore', 0.5, 1.0, model='rigid', tolerance=0.01)"
LOADED = "import sys; print(*{n.partition('.')[0] for n in sys.modules})"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("script", "more", "absent"),
    [
        ("solve", "pass", HEAVY | {"numpy", "scipy", "numba"}),
        ("solve", SOLVE, HEAVY),
        ("make", "pass", {"matplotlib", "plotly", "numba"}),
    ],
)
def test_a_job_loads_no_library_before_it_needs_it(script, more, absent):
    text = (ROOT / "workflow" / "scripts" / f"{script}.py").read_text()
    imports = re.findall(r"^(?:from \S+ )?import .+$", text, re.MULTILINE)
    output = subprocess.check_output(
        [sys.executable, "-c", "; ".join([*imports, more, LOADED])],
        env=ENVIRONMENT | {"PYTHONPATH": str(ROOT / "src")},
        text=True,
    )
    assert "microslip" in output and not absent & set(output.split())
