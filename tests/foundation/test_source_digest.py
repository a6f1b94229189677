"""Digests of sources: which edits change which names, and which files are read."""

import ast

import pytest

from microslip.foundation import source_digest
from microslip.foundation.source_digest import Sources

MODULE = '''
"""Docstring."""
import numpy as np

LIMIT = 3  # a comment
"""What it limits."""


def double(x, *, factor=2.0):
    """Docstring."""
    if x > LIMIT:
        raise ValueError(f"{x} is too large")
    return factor * x, "a b".split()
'''
EDITS = [
    ("  # a comment", "", False),
    ('"""Docstring."""', '"""Another one."""', False),
    ('"""What it limits."""\n', "", False),
    ("factor * x", "(factor*x)", False),
    ("is too large", "is much too large", "message"),
    ("LIMIT = 3", "LIMIT = 4", True),
    ('"a b"', '"a c"', True),
    ("def double", "def (", True),
]
"""Old text, new text, and whether the edit changes digests: a message changes those of products."""


@pytest.mark.parametrize(("old", "new", "is_code"), EDITS)
@pytest.mark.parametrize("room", ["periodic", "report"])
def test_code_changes_the_digest_but_layout_comments_and_docstrings_do_not(
    old, new, is_code, room, tmp_path
):
    assert old in MODULE
    digests = []
    for text in (MODULE, MODULE.replace(old, new)):
        (tmp_path / room).mkdir(exist_ok=True)
        (tmp_path / room / "module.py").write_text(text)
        digests.append(Sources(tmp_path).digest([f"{room}/module.py"]))
    assert (digests[0] != digests[1]) == (room == "report" if is_code == "message" else is_code)


FILES = {
    "__init__.py": "A = 1",
    "foundation/errors.py": "",
    "foundation/compiled.py": "",
    "sweeps/evaluate.py": "import toy.config.axes",
    "sweeps/period_codec.py": "",
    "sweeps/batch.py": "",
    "config/axes.py": "",
    "periodic/run.py": "from toy.foundation.compiled import kernel\nimport toy.scene.turns",
    "periodic/shapes.js": "",
    "periodic/methods/_shared.py": "from toy.periodic.methods import _deeper",
    "periodic/methods/_deeper.py": "",
    "periodic/methods/one.py": "from toy.periodic.methods._shared import D",
    "report/figures/maps.py": "from toy.periodic import run\nfrom toy.datasets import query",
    "report/page.html": "",
    "datasets/query.py": "from toy.foundation import errors",
}
SOLVER = {"foundation/compiled.py", "sweeps/evaluate.py", "sweeps/period_codec.py"}
PHYSICS = ("scene/turns.py", "theory/paper.py", "contact/rings.py", "answer/point.py")
SOLVER |= {"periodic/run.py", "periodic/shapes.js", *PHYSICS}
FILES |= dict.fromkeys(PHYSICS, "")


@pytest.fixture
def package(tmp_path):
    """A small package for tests."""
    for name, text in FILES.items():
        (tmp_path / "toy" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "toy" / name).write_text(text)
    return tmp_path / "toy"


def test_results_depend_on_the_rooms_that_make_numbers(package):
    assert Sources(package).solver == SOLVER
    kernels = {"periodic/run.py", "scene/turns.py", "foundation/compiled.py"}
    assert Sources(package).kernels == kernels  # for compiled code


def test_a_result_of_a_method_depends_on_its_file_and_the_imports_of_this_file(
    package, monkeypatch
):
    monkeypatch.setattr(source_digest, "LOADED", Sources(package))
    digest = source_digest.of_solver.__wrapped__  # without the cache
    sources, methods = Sources(package), ("one", "_shared", "_deeper")
    files = SOLVER | {f"periodic/methods/{name}.py" for name in methods}
    assert digest("one") == sources.digest(files)
    assert digest("") == digest("unknown") == sources.digest(SOLVER)


def test_a_product_depends_on_its_modules_and_on_their_imports_from_outer_rooms(package):
    files = {"report/figures/maps.py", "report/page.html", "datasets/query.py"}
    assert Sources(package).builder("report") == files
    assert Sources(package).builder("datasets/query.py") == {"datasets/query.py"}


def test_scratch_and_hidden_files_do_not_count(package):
    names = Sources(package).names
    (package / ".#run.py").symlink_to("nobody@nowhere.1:2")  # lock file of an editor
    (package / ".ipynb_checkpoints").mkdir()
    (package / ".ipynb_checkpoints" / "run-checkpoint.py").write_text("not Python at all (")
    (package / "periodic" / "run copy.py").write_text("neither (")
    assert Sources(package).names == names == sorted(FILES)


# Files are read once, and parse results are stored


def test_a_second_process_parses_only_edited_files(package, monkeypatch):
    before = Sources(package).digest(SOLVER)
    (package / "periodic/run.py").write_text("A = 2")
    parsed = []
    monkeypatch.setattr(
        "ast.parse", lambda content, parse=ast.parse: parsed.append(content) or parse(content)
    )
    after = Sources(package).digest(SOLVER)
    assert after != before and parsed == [b"A = 2"]
    assert Sources(package).digest(SOLVER) == after and len(parsed) == 1


def test_damaged_parse_results_are_replaced(package):
    first = Sources(package).digest(SOLVER)
    (cache,) = (package / "__pycache__").glob("sources.*.json")
    whole = cache.read_bytes()
    cache.write_bytes(whole[:-9])
    assert (Sources(package).digest(SOLVER), cache.read_bytes()) == (first, whole)
