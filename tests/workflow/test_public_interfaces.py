"""The source uses only public interfaces of other packages."""

import ast
import io
import re
import tokenize
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
OTHERS = ("snakemake", "xarray", "pint", "numba")
NUMBA_CONFIG = ROOT / "src/microslip/foundation/compiled.py"
"""The only file that uses numba.config."""
WORKFLOW = {"source_path", "basedir", "current_basedir", "cores", "configfiles"}
"""Attributes of the object `workflow` that rules may use: paths, cores, configuration files."""
PYTHON = sorted([*(ROOT / "src").rglob("*.py"), *(ROOT / "workflow").rglob("*.py")])
RULES = [
    ROOT / "Snakefile",
    *sorted((ROOT / "workflow").rglob("*.smk")),
    ROOT / "workflow/Snakefile",
]


def is_private(name):
    return any(part.startswith("_") for part in name.split("."))


def imported(tree):
    """(bound name, full name) of each import of a file from these packages."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [(a.asname or a.name.partition(".")[0], a.name) for a in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [(a.asname or a.name, f"{node.module}.{a.name}") for a in node.names]
        else:
            continue
        yield from ((bound, name) for bound, name in names if name.partition(".")[0] in OTHERS)


def private_uses(tree):
    """Private names that a file imports from these packages, and their private attributes."""
    names = dict(imported(tree))
    yield from filter(is_private, names.values())
    for node in ast.walk(tree):
        inner, parts = node, []
        while isinstance(inner, ast.Attribute):
            parts.append(inner.attr)
            inner = inner.value
        if (
            parts
            and isinstance(inner, ast.Name)
            and inner.id in names
            and is_private(".".join(parts))
        ):
            yield f"{names[inner.id]}.{'.'.join(reversed(parts))}"


@pytest.mark.parametrize("path", PYTHON, ids=lambda path: str(path.relative_to(ROOT)))
def test_no_module_uses_private_names_of_other_packages(path):
    assert not list(private_uses(ast.parse(path.read_text(encoding="utf-8"))))


def test_one_file_uses_the_configuration_of_numba():
    setting = re.compile(r"numba\.config|import config")
    assert [path for path in PYTHON if setting.search(path.read_text("utf-8"))] == [NUMBA_CONFIG]


@pytest.mark.parametrize("path", RULES, ids=lambda path: path.name)
def test_rules_use_public_attributes_of_snakemake(path):
    tokens = tokenize.generate_tokens(io.StringIO(path.read_text("utf-8")).readline)
    text = " ".join(token.string for token in tokens if token.type != tokenize.COMMENT)
    assert set(re.findall(r"\bworkflow \. (\w+)", text)) <= WORKFLOW
    assert not re.search(r"\b(rules|checkpoints|workflow|snakemake)\b( \. \w+)* \. _", text)
    modules = set(re.findall(r"\b(?:from|import) (snakemake(?: \. \w+)*)", text))
    assert modules <= {"snakemake . utils", "snakemake . exceptions"}
