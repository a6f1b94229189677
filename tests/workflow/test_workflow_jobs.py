"""Imports of the scripts of jobs: solving imports nothing for drawing or collecting."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from stubs.workflow_project import ENVIRONMENT

ROOT = Path(__file__).parents[2]
SCRIPTS = ROOT / "workflow" / "scripts"
HEAVY = {"matplotlib", "xarray", "netCDF4", "pandas", "plotly", "pint", "dask", "jsonschema"}
LOADED = "import sys; {imports}; {more}; print(*{{n.partition('.')[0] for n in sys.modules}})"


def loaded(script, more="pass"):
    """Names of the packages in a process after the imports of a script."""
    text = (SCRIPTS / f"{script}.py").read_text()
    imports = "; ".join(re.findall(r"^(?:from \S+ )?import .+$", text, re.MULTILINE))
    process = subprocess.run(
        [sys.executable, "-c", LOADED.format(imports=imports, more=more)],
        env={**ENVIRONMENT, "PYTHONPATH": str(ROOT / "src")},
        capture_output=True,
        text=True,
        check=True,
    )
    return set(process.stdout.split())


def test_a_job_loads_no_library_before_it_has_something_to_solve():
    assert not (HEAVY | {"numpy", "scipy", "numba"}) & loaded("solve")


@pytest.mark.slow
def test_a_job_that_solves_loads_nothing_that_draws_or_collects():
    solve = "import microslip; microslip.solve('bore', 0.5, 1.0, model='rigid', tolerance=0.01)"
    result = loaded("solve", solve)
    assert "numba" in result
    assert not HEAVY & result


@pytest.mark.long
def test_making_products_loads_nothing_that_draws_or_solves_before_it_is_needed():
    assert not {"matplotlib", "plotly", "numba"} & loaded("make")
