"""Data flows one way: a module imports only from layers above it."""

import ast
from pathlib import Path

import pytest

import microslip

PACKAGE = Path(microslip.__file__).parent

# From the ground up; modules on one line do not know each other.
LAYERS = [
    {"errors", "syntax_digest"},
    {"arguments", "source_digest"},
    {"compiled"},
    {"hertz", "parameters", "named_files"},
    {"pressures"},
    {"theory", "masing", "bounds", "halfspace", "friction", "path", "indenter_limits", "depth"},
    {"rings", "scene", "any_pressure", "frames", "pulsating", "budget", "result"},
    {"motions"},
    {"scenes"},
    {"models"},
    {"motion"},
    {"static", "static_loop", "cycle", "steady"},
    {"newton", "anderson"},
    {"periodic"},
    {"method"},
    {"simulate"},
    {"static_run"},
    {"methods"},
    {"chains"},
    {"accuracy", "approach"},
    {"choice"},
    {"point"},
    {"inside", "trial"},
    {"patches"},
    {"keys", "schemas", "settings", "strict_yaml"},
    {"grids"},
    {"extended"},
    {"cache", "config", "periods", "netcdf"},
    {"limits_of_pressures"},
    {"answers", "batch_files", "jobs", "watch", "limits", "columns", "summary"},
    {"sweep", "dataset"},
    {"stored", "si"},
    {"query"},
    {"studies"},
    {"plot", "terminal"},
    {"launch", "command_line"},
    {"sweep_process"},
    {"explorer"},
    {"plan"},
    {"cli_predict", "leftovers"},
    {"cli"},
    {"__main__"},
]
LEVEL = {name: level for level, names in enumerate(LAYERS) for name in names}
BELOW_ALL = {"source_digest", "syntax_digest", "compiled", "named_files"}
PHYSICS = {name for names in LAYERS[: LEVEL["keys"]] for name in names} - BELOW_ALL
FROM_FILES = {"from_file", "grid_csv", "grid_netcdf", "grid_units"}
"""The one pressure that is read from a file, found by its name like every other one: what marches
gets the record that all pressures have, and cannot tell."""
MODULES = sorted(
    path.relative_to(PACKAGE) for path in PACKAGE.rglob("*.py") if path.name != "__pycache__"
)


def top_name(path):
    """First part of a module's name inside the package."""
    return path.parts[0].removesuffix(".py")


def imported(path):
    """Top names of the package's modules that a file imports, and of everything else."""
    inside, outside = set(), set()
    for node in ast.walk(ast.parse((PACKAGE / path).read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level == 1 and len(path.parts) > 1:
            inside.add(top_name(path))  # from its own folder
        elif isinstance(node, ast.ImportFrom) and node.level:
            names = [node.module] if node.module else [alias.name for alias in node.names]
            inside |= {name.split(".")[0] for name in names}
        elif isinstance(node, ast.ImportFrom | ast.Import):
            module = getattr(node, "module", None)
            for alias in node.names:
                full = f"{module}.{alias.name}" if module else alias.name
                parts = full.split(".")
                if parts[0] == "microslip":
                    inside |= set(parts[1:2]) & LEVEL.keys()
                else:
                    outside.add(parts[0])
    return inside, outside


def test_every_module_has_a_layer():
    assert {top_name(path) for path in MODULES} - {"__init__"} == set(LEVEL)


@pytest.mark.parametrize("path", MODULES, ids=str)
def test_imports_point_upward(path):
    name = top_name(path)
    if name == "__init__":
        return
    inside, _ = imported(path)
    lower = {other for other in inside - {name} if LEVEL[other] >= LEVEL[name]}
    assert not lower, f"{path} imports {lower}, which lie below it"


@pytest.mark.parametrize("path", MODULES, ids=str)
def test_physics_knows_no_files_workflow_or_plots(path):
    if path == Path("methods", "__init__.py"):
        return  # it lists the files beside it
    if path.parts[0] == "pressures" and path.stem in FROM_FILES:
        return
    if top_name(path) in PHYSICS:
        _, outside = imported(path)
        forbidden = {
            "xarray",
            "netCDF4",
            "matplotlib",
            "snakemake",
            "yaml",
            "json",
            "os",
            "pathlib",
        }
        assert not outside & forbidden


def test_nothing_else_in_the_physics_knows_where_files_are():
    users = {path for path in MODULES if "named_files" in imported(path)[0]}
    physics = {path for path in users if top_name(path) in PHYSICS}
    assert physics == {Path("pressures", "from_file.py")}


def test_theory_and_the_solvers_meet_only_in_the_public_answer():
    users = {top_name(path) for path in MODULES if "theory" in imported(path)[0]}
    limits = {"limits", "limits_of_pressures"}
    assert users <= limits | {"any_pressure", "choice", "dataset", "studies", "query"}
