"""The source uses only public interfaces of other packages."""

import ast
import io
import re
import tokenize
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
MODULES = {
    "snakemake.cli",
    "snakemake.exceptions",
    "snakemake.utils",
    "numba",
    "numba.extending",
    "numba.types",
    "pint",
    "xarray",
}
"""Modules that the source may use.  In those of a package, the names in `__all__` are public."""
OTHERS = {module.partition(".")[0] for module in MODULES}
EXCEPTIONS = {
    ROOT / "src/microslip/foundation/compiled.py": {
        "numba.config",
        "numba.core.caching",
        "numba.core.event",
        "numba.np.arraymath",
    },
}
"""Other modules: settings, cache locators and events of Numba, and an import that it would do more
slowly."""
STANDARD = {"_asdict", "_exit", "_fields", "_replace"}
"""Public names of the standard library that begin with an underscore."""
ARGPARSE = {"_actions", "_option_string_actions", "_AppendAction"}
"""Names of argparse, which has no public list of its options."""
WORKFLOW = {"source_path", "basedir", "current_basedir", "cores", "configfiles"}
"""Attributes of the object `workflow` that rules may use: paths, cores, configuration files."""
PYTHON = sorted([*(ROOT / "src").rglob("*.py"), *(ROOT / "workflow").rglob("*.py")])
RULES = [
    ROOT / "Snakefile",
    *sorted((ROOT / "workflow").rglob("*.smk")),
    ROOT / "workflow/Snakefile",
]


def parsed(path):
    return ast.parse(path.read_text(encoding="utf-8"))


def uses(tree):
    """Full names of all that a file imports from these packages, and of the attributes of what it
    imports."""
    names = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
            names |= {a.asname or a.name.partition(".")[0]: a.name for a in node.names if a.asname}
            names |= {a.name.partition(".")[0]: a.name.partition(".")[0] for a in node.names}
        elif isinstance(node, ast.ImportFrom):
            yield from (f"{node.module}.{alias.name}" for alias in node.names)
            names |= {a.asname or a.name: f"{node.module}.{a.name}" for a in node.names}
    for node in ast.walk(tree):
        inner, parts = node, []
        while isinstance(inner, ast.Attribute):
            parts.append(inner.attr)
            inner = inner.value
        if parts and isinstance(inner, ast.Name) and inner.id in names:
            yield ".".join([names[inner.id], *reversed(parts)])


def is_public(name, exceptions=()):
    """True for a module of the list, and for its names without an underscore.  A package must list
    them in `__all__`."""
    for module in sorted({*MODULES, *exceptions}, reverse=True):  # submodules first
        if name == module:
            return True
        if name.startswith(f"{module}."):
            first, *rest = name.removeprefix(f"{module}.").split(".")
            listed = "." in module or first in import_module(module).__all__
            return listed and not any(part.startswith("_") for part in (first, *rest))
    return False


@pytest.mark.parametrize("path", PYTHON, ids=lambda path: str(path.relative_to(ROOT)))
def test_a_module_uses_public_names_of_other_packages(path):
    names = {name for name in uses(parsed(path)) if name.partition(".")[0] in OTHERS}
    assert {name for name in names if not is_public(name, EXCEPTIONS.get(path, ()))} == set()


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
    nodes = [(path, node) for path in PYTHON for node in ast.walk(parsed(path))]
    own = (STANDARD | ARGPARSE).union(*(defined(node) for _, node in nodes))
    private = re.compile(r"_(?!_)")
    assert [
        f"{path.relative_to(ROOT)}: {node.attr}"
        for path, node in nodes
        if isinstance(node, ast.Attribute) and private.match(node.attr) and node.attr not in own
    ] == []


@pytest.mark.parametrize("path", RULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_rules_use_public_attributes_of_snakemake(path):
    tokens = tokenize.generate_tokens(io.StringIO(path.read_text("utf-8")).readline)
    text = " ".join(token.string for token in tokens if token.type != tokenize.COMMENT)
    assert set(re.findall(r"\bworkflow \. (\w+)", text)) <= WORKFLOW
    assert set(re.findall(r"\. (_\w+)", text)) <= STANDARD
    modules = set(re.findall(r"\b(?:from|import) (snakemake(?: \. \w+)*)", text))
    assert {module.replace(" ", "") for module in modules} <= MODULES
