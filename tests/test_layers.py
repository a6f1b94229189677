"""Imports between packages: only from those to the left in RULE.  Rules of Snakemake, which ruff
cannot read: only public names."""

import ast
import re
from functools import cache
from pathlib import Path

import microslip
from microslip.foundation.source_digest import NUMBERS

PACKAGE = Path(microslip.__file__).parent
RULE = (
    "foundation < theory < scene < contact < periodic "
    "< answer < si < config < sweeps < datasets < studies < report < app"
)
ROOMS = RULE.split(" < ")
PHYSICS = ROOMS[1 : ROOMS.index("si")]
FROM_FILES = Path("scene", "files.py")
"""Module of motions and pressures from files, the only physics with paths."""
LISTS_FILES = Path("periodic", "methods", "__init__.py")
"""Module that lists the files of methods without importing them."""
MODULES = sorted(path.relative_to(PACKAGE) for path in PACKAGE.rglob("*.py"))


@cache
def imported(path):
    """Imported modules of the package, as tuples of names, and names of all other imported
    packages."""
    inside, outside = set(), set()
    for node in ast.walk(ast.parse((PACKAGE / path).read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom):
            assert not node.level, f"{path}: line {node.lineno} is no absolute import"
            names = [f"{node.module}.{alias.name}" for alias in node.names]
        elif isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        else:
            continue
        for name in names:
            package, *rest = name.split(".")
            if package == "microslip" and rest and rest[0] in ROOMS:
                inside.add(tuple(rest))
            elif package != "microslip":
                outside.add(package)
    return inside, outside


def test_every_module_is_in_a_room():
    assert {path.parts[0] for path in MODULES} == {*ROOMS, "__init__.py", "__main__.py"}


def test_imports_follow_the_rule():
    against = set()
    for path in MODULES:
        if path.parts[0] in ROOMS:  # all except the modules at the top of the package
            right = ROOMS[ROOMS.index(path.parts[0]) + 1 :]
            against |= {(str(path), *name) for name in imported(path)[0] if name[0] in right}
    assert not against


def test_a_request_loads_no_room_outside_the_digest_of_its_result():
    names = {name[0] for file in NUMBERS for name in imported(file)[0]}
    assert names <= {*PHYSICS, "foundation", "config", "sweeps"}


def test_no_modules_import_each_other_in_a_circle():
    names = {tuple(path.with_suffix("").parts): path for path in MODULES}
    waits = {}
    for name, path in names.items():
        targets = {n[:end] for n in imported(path)[0] for end in (2, 3, 4)}
        waits[name] = (targets & names.keys()) - {name}
    while free := {name for name, targets in waits.items() if not targets}:
        waits = {n: targets - free for n, targets in waits.items() if n not in free}
    assert not waits


def test_physics_knows_no_files_workflow_or_plots():
    forbidden = {"xarray", "netCDF4", "matplotlib", "snakemake", "yaml", "json", "os", "pathlib"}
    names = set()
    for path in MODULES:
        if path.parts[0] in PHYSICS and path not in (LISTS_FILES, FROM_FILES):
            names |= {(str(path), name) for name in imported(path)[1] & forbidden}
    assert not names


TOP = Path(__file__).parents[1]
RULES = [TOP / "Snakefile", TOP / "workflow" / "Snakefile", *(TOP / "workflow").rglob("*.smk")]
WORKFLOW = {"source_path", "basedir", "current_basedir", "cores", "configfiles"}
"""Attributes of the object `workflow` that rules may use: paths, cores, configuration files."""


def test_rules_use_public_names_of_snakemake():
    text = "".join(re.sub("#.*", "", path.read_text("utf-8")) for path in RULES)
    assert set(re.findall(r"(?<![/\w])workflow\.(\w+)", text)) <= WORKFLOW
    assert not re.findall(r"\._(?!asdict)\w+", text)
    assert set(re.findall(r"\b(?:from|import) (snakemake[.\w]*)", text)) == {"snakemake.utils"}


def test_type_checkers_find_the_type_hints():
    assert (PACKAGE / "py.typed").is_file()
