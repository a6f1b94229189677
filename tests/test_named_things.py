"""Names of modules, classes, constants and files in comments, docstrings and pages exist."""

import ast
import io
import re
import sys
import tokenize
from collections import defaultdict
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "src" / "microslip"
PYTHON = sorted(
    path
    for folder in ("src", "workflow", "benchmarks", "tests")
    for path in (ROOT / folder).rglob("*.py")
)
PAGES = sorted(
    [*ROOT.glob("*.md"), *(ROOT / "config").glob("*.md"), *(ROOT / "docs").rglob("*.md")]
)
FOREIGN = {"microslip", "np", "numpy", "numba", "pint", "xarray", "xr", "yaml", "snakemake"}
"""Packages whose names are not checked."""
DOTTED = re.compile(r"(?<![\w./])(?:[a-z_]+\.)*([a-z_]+)\.([A-Za-z_]+)\b(?![\w./])")
A_FILE = re.compile(r"`((?:src|tests|workflow|config|docs|benchmarks|profiles)/[\w./-]+)`")


def names_in(path):
    """Names of definitions, imports, arguments and fields in a module."""
    for node in ast.walk(ast.parse(path.read_text())):
        match node:
            case ast.FunctionDef(name=name) | ast.ClassDef(name=name) | ast.arg(arg=name):
                yield name
            case ast.Name(id=name, ctx=ast.Store()) | ast.Attribute(attr=name, ctx=ast.Store()):
                yield name
            case ast.alias(name=name, asname=other):
                yield other or name


@pytest.fixture(scope="module")
def modules():
    """Names in the modules by the name of a module, and modules by the name of a package."""
    result = defaultdict(set)
    for path in PACKAGE.rglob("*.py"):
        own = path.parent.name if path.stem == "__init__" else path.stem
        result[own] |= set(names_in(path))
        result[path.parent.name].add(path.stem)
        result[path.parent.parent.name].add(path.parent.name)
    return result


def prose(path):
    """Comments and docstrings of a Python file, as (line, text)."""
    text = path.read_text()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            yield token.start[0], token.string
    for node in ast.walk(ast.parse(text)):
        match node:
            case ast.Expr(value=ast.Constant(value=str(words))):
                yield node.lineno, words


def is_there(owner, name, modules):
    """True if owner.name exists in the package, or may belong to a library or a variable."""
    if owner in FOREIGN or owner in sys.stdlib_module_names:
        return True
    if owner in modules:
        return name in modules[owner] or not name[0].isupper()
    return not name[0].isupper()


@pytest.mark.slow
def test_classes_and_constants_named_in_prose_exist(modules):

    def unknown(words):
        result = DOTTED.finditer(words)
        return [match[0] for match in result if not is_there(match[1], match[2], modules)]

    gone = [
        f"{path.relative_to(ROOT)}: line {line}: {name}"
        for path in PYTHON
        if unknown(path.read_text())  # fast test of the whole file before its prose is extracted
        for line, words in prose(path)
        for name in unknown(words)
    ]
    assert not gone, "\n".join(gone)


def test_files_named_on_pages_exist():
    named = ((page, file) for page in PAGES for file in A_FILE.findall(page.read_text()))
    gone = [
        f"{page.relative_to(ROOT)}: {file}" for page, file in named if not (ROOT / file).exists()
    ]
    assert not gone, "\n".join(gone)
