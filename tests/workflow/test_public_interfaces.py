"""The source uses only public interfaces of other packages."""

import ast
import re
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
LISTED = {"numba", "pint", "xarray"}
"""Packages whose names in `__all__` are public."""
MODULES = {f"snakemake.{name}" for name in ("cli", "exceptions", "utils")}
MODULES |= {"numba.extending", "numba.types"}
"""Modules whose names without an underscore are public."""
EXCEPTIONS = {"numba.config", "numba.core.caching", "numba.core.event", "numba.np.arraymath"}
"""Settings, cache locators and events of Numba, and an import that it would do more slowly, in one
file."""
STANDARD = {"_asdict", "_exit", "_fields", "_replace"}
"""Public names of the standard library that begin with an underscore."""
ARGPARSE = {"_actions", "_option_string_actions", "_AppendAction"}
"""Names of argparse, which has no public list of its options."""
WORKFLOW = {"source_path", "basedir", "current_basedir", "cores", "configfiles"}
"""Attributes of the object `workflow` that rules may use: paths, cores, configuration files."""
RULES = [ROOT / "Snakefile", ROOT / "workflow/Snakefile", *(ROOT / "workflow").rglob("*.smk")]
NODES = [
    (path.relative_to(ROOT), node)
    for folder in ("src", "workflow")
    for path in sorted((ROOT / folder).rglob("*.py"))
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
]


def used(node):
    """Full names that a node of a syntax tree imports, or the attribute of a package."""
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    if isinstance(node, ast.ImportFrom):
        return [f"{node.module}.{alias.name}" for alias in node.names]
    if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
        package = {"xr": "xarray"}.get(node.value.id, node.value.id)
        return [f"{package}.{node.attr}"] if package in LISTED else []
    return []


def is_public(name):
    module, _, last = name.rpartition(".")
    if module in LISTED:
        return name in MODULES or last in import_module(module).__all__
    return name in LISTED | MODULES or (module in MODULES and not last.startswith("_"))


def test_modules_use_public_names_of_other_packages():
    packages = LISTED | {"snakemake"}
    names = [(path, name) for path, node in NODES for name in used(node)]
    others = [one for one in names if one[1].partition(".")[0] in packages]
    hidden = {(path, name) for path, name in others if not is_public(name)}
    assert hidden <= {(Path("src/microslip/foundation/compiled.py"), one) for one in EXCEPTIONS}
    assert len(others) > 20


def defined(node):
    """Names that a node of a syntax tree defines."""
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        return {node.name}
    if isinstance(node, ast.Import | ast.ImportFrom):
        return {part for alias in node.names for part in alias.name.split(".")}
    if isinstance(node, ast.Attribute | ast.Name) and isinstance(node.ctx, ast.Store):
        return {node.attr if isinstance(node, ast.Attribute) else node.id}
    return set()


def test_private_attributes_are_those_of_the_source():
    """Also of objects, such as a dataset, whose class is that of another package."""
    own = (STANDARD | ARGPARSE).union(*(defined(node) for _, node in NODES))
    names = [(path, node.attr) for path, node in NODES if isinstance(node, ast.Attribute)]
    assert [one for one in names if re.match("_(?!_)", one[1]) and one[1] not in own] == []


@pytest.mark.parametrize("path", RULES, ids=lambda path: path.name)
def test_rules_use_public_attributes_of_snakemake(path):
    text = re.sub("#.*", "", path.read_text("utf-8"))
    assert set(re.findall(r"(?<![/\w])workflow\.(\w+)", text)) <= WORKFLOW
    assert set(re.findall(r"\.(_\w+)", text)) <= STANDARD
    assert set(re.findall(r"\b(?:from|import) (snakemake[.\w]*)", text)) <= MODULES
