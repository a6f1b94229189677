"""The documentation: its code runs and prints the text of the pages, and its links exist.

Blocks of a page run in their order, in a folder that contains the files of a clone and results.
Python blocks and the cells of notebooks share one namespace, sh blocks are run by bash, and yaml
blocks are checked as a configuration or a part of one. A bash block is only parsed: it installs
packages, computes for minutes or needs a cluster. A block whose first line is a comment with a
file name is written to this file. A text block is the output of the block before it: equal words,
and numbers equal to the printed digits.

`pytest -n 0 tests/docs/test_docs.py --rewrite` replaces the text blocks that differ; check the
changes with `git diff docs`.
"""

import contextlib
import io
import json
import math
import os
import re
import shutil
import subprocess
import sys
import sysconfig
from collections import namedtuple
from importlib.util import find_spec
from pathlib import Path

import pytest
import yaml
from stubs import certified_stub

import microslip
from microslip.config import load
from microslip.contact.registry import MODELS
from microslip.datasets import netcdf, sweep_dataset
from microslip.sweeps import batch, request

ROOT = Path(__file__).parents[2]
DOCS = (str(path.relative_to(ROOT)) for path in (ROOT / "docs").rglob("*.md"))
PAGES = sorted(["README.md", "CONTRIBUTING.md", "config/README.md", *DOCS])
LONG = (
    *("motions_and_pressures", "drives", "certified_maps", "contacts", "export", "extend", "fit"),
    *("force_and_spring", "measured_strokes", "rough_contacts", "sweeps", "datasets"),
    "real_contact",
)
"""Pages whose code takes several seconds, except those for newcomers."""
SHARED = ("Snakefile", "README.md", "pyproject.toml")
SHARED_FOLDERS = ("benchmarks", "config", "docs", "profiles", "tests", "workflow")

PEERS = ("ContactMechanics", "tamaas")
"""Packages of the extra `peers`.  A block that imports a missing one is not run."""
SKIPPED = object()
"""Output of a block that is not run."""

Block = namedtuple("Block", "kind text line")


def text_of(page):
    return (ROOT / page).read_text(encoding="utf-8")


FENCED = re.compile(r"^ {0,3}(`{3,})(.*)\n((?:.*\n)*?) {0,3}\1 *$", re.M)


def blocks(page):
    """Fenced blocks of a page, in their order."""
    text = text_of(page)
    return [
        Block(found[2].strip(), found[3], text.count("\n", 0, found.start()) + 1)
        for found in FENCED.finditer(text)
    ]


def file_of(block):
    """Name of the file of a block, if its first line contains one."""
    named = re.match(r"# ([\w./-]+\.(?:py|yaml|smk|csv))\n", block.text)
    return named and named[1]


# The folder that pages run in


def tutorial_configuration():
    (block,) = (b for b in blocks("docs/tutorials/datasets.md") if "write_text" in b.text)
    return load.from_mapping(yaml.safe_load(block.text.split('"""')[1]))


def write_sweeps(folder, names):
    """Compute sweeps of the tutorial and write their datasets to a folder `results`.

    The datasets also replace those of the full sweeps, such as results/transverse.nc.
    """
    configuration = tutorial_configuration()
    place = folder / Path(configuration.results).relative_to("results")
    for name in names:
        points = request.points_of(configuration.sweeps[name]).requests
        records = [batch.computed(point)[0] for point in points]
        root, groups = sweep_dataset.build(configuration, name, records)
        netcdf.write(place / f"{name}.nc", root, groups)
        shutil.copy(place / f"{name}.nc", folder)


@pytest.fixture(scope="session")
def with_a_sweep(tmp_path_factory):
    """A folder `results` with the sweep `transverse`."""
    folder = tmp_path_factory.mktemp("docs") / "results"
    write_sweeps(folder, ["transverse"])
    return folder


@pytest.fixture(scope="session")
def computed(tmp_path_factory):
    """A folder `results` with all datasets of the pages."""
    folder = tmp_path_factory.mktemp("docs") / "results"
    write_sweeps(folder, tutorial_configuration().sweeps)
    # coarse, so that it takes seconds
    axes = {"velocity": [0.001, 10], "amplitude": [0, 3], "error": 0.1}
    map_ = certified_stub.configured("transverse", **axes)
    data = certified_stub.built(map_, lambda point: batch.computed(point)[0])
    netcdf.write(folder / "certified" / "transverse.nc", data)
    return folder


def make_place(page, folder, results):
    """Fill a folder like a clone with results, and return its environment."""
    for name in SHARED:
        shutil.copy(ROOT / name, folder)
    for name in SHARED_FOLDERS:
        (folder / name).symlink_to(ROOT / name)
    changes_sources = any((file_of(b) or "").startswith("src/") for b in blocks(page))
    if changes_sources:
        # The copy keeps the time stamps, so that the compiled code of Numba is valid.
        shutil.copytree(ROOT / "src", folder / "src")
    else:
        (folder / "src").symlink_to(ROOT / "src")
    (folder / ".venv").symlink_to(Path(sysconfig.get_path("scripts")).parent)
    (folder / "path" / "to").mkdir(parents=True)
    (folder / "path" / "to" / "microslip").symlink_to(ROOT)
    shutil.copytree(results, folder / "results")
    path = f"{folder}/.venv/bin:/usr/local/bin:/usr/bin:/bin"
    return os.environ | {"PATH": path} | ({"PYTHONPATH": "src"} if changes_sources else {})


# Running a block


def run_python(block, page, namespace, environment):
    # This process has not imported the copy of the package in src.
    if environment.get("PYTHONPATH") == "src":
        command = [sys.executable, "-c", block.text]
        return run_command(command, f"{page}:{block.line}", environment)
    message = io.StringIO()
    code = compile("\n" * block.line + block.text, page, "exec")
    try:
        with contextlib.redirect_stdout(message):
            exec(code, namespace)
    except ModuleNotFoundError as missing:
        if missing.name not in PEERS:
            raise
        return SKIPPED
    return message.getvalue()


def run_command(command, where, environment):
    process = subprocess.run(command, capture_output=True, text=True, timeout=300, env=environment)
    assert process.returncode == 0, f"{where}: {process.stdout}{process.stderr}"
    return process.stdout


def run_snakefile(block, where, environment):
    """Plan a workflow that uses ours as a module, with the configurations of the page."""
    Path("Snakefile").unlink()
    Path("Snakefile").write_text(block.text)
    command = ["snakemake", "--dry-run", "--quiet", "--cores", "1", "--configfile", "outer.yaml"]
    return run_command(command, where, environment)


def check_yaml(block):
    """Check a configuration, or a part of one that replaces keys of the default configuration."""
    part = yaml.safe_load(block.text)
    part = part.get("friction", part)  # the key of a module
    whole = yaml.safe_load((ROOT / "config" / "config.yaml").read_text())
    try:
        load.from_mapping(part, folders=[ROOT / "config"])
    except load.ConfigError:
        for name, section in part.items():
            sweeps = name == "sweeps"
            for key, value in section.items() if isinstance(section, dict) else ():
                whole[name][key] = {**whole[name][key], **value} if sweeps else value
            if not isinstance(section, dict):
                whole[name] = section
        load.from_mapping(whole, folders=[ROOT / "config"])


NUMBER = re.compile(r"[-+]?\d+\.?\d*(?:e[-+]?\d+)?")


def assert_said(message, expected, where):
    """Assert equal words, and numbers within 1 % or 1.5 units of the last printed digit."""
    words = [NUMBER.sub("#", text).split() for text in (message, expected)]
    assert words[0] == words[1], f"{where}: {message}"
    for new, old in zip(NUMBER.findall(message), NUMBER.findall(expected), strict=True):
        digits = re.sub(r"e.*", "", old)
        scale = 10.0 ** float(old.split("e")[1]) if "e" in old else 1.0
        last = scale * 10.0 ** -len(digits.partition(".")[2])
        near = max(0.01 * abs(float(old)), 1.5 * last if "." in digits else 0.0)
        assert math.isclose(float(new), float(old), rel_tol=0, abs_tol=near), f"{where}: {message}"


def rewrite(page, printed):
    """Replace blocks of a page; printed: new texts by the lines of the blocks."""
    lines = text_of(page).split("\n")
    for block in reversed(blocks(page)):
        if block.line in printed:
            end = block.line + block.text.count("\n")
            lines[block.line : end] = printed[block.line].rstrip("\n").split("\n")
    (ROOT / page).write_text("\n".join(lines), encoding="utf-8")


RUNS = [
    pytest.param(page, "computed", marks=pytest.mark.long, id=page)
    if Path(page).stem in LONG
    else pytest.param(page, "with_a_sweep", id=page)
    for page in PAGES
    if blocks(page)
]
"""Each page with code, and its fixture with results."""


@pytest.mark.parametrize(("page", "results"), RUNS)
def test_the_code_of_a_page_runs(page, results, request, tmp_path, monkeypatch):
    environment = make_place(page, tmp_path, request.getfixturevalue(results))
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    namespace, message, printed = {"__name__": "__main__"}, None, {}
    for block in blocks(page):
        where = f"{page}:{block.line}"
        file = file_of(block)
        if file:
            Path(file).parent.mkdir(parents=True, exist_ok=True)
            Path(file).write_text(block.text, encoding="utf-8")
        if block.kind == "yaml":
            check_yaml(block)
        elif block.kind in ("python", "{code-cell}") and not file:
            message = run_python(block, page, namespace, environment)
        elif block.kind == "sh":
            message = run_command(["bash", "-euc", block.text], where, environment)
        elif block.kind == "bash":
            run_command(["bash", "-n", "-c", block.text], where, environment)
            message = None
        elif block.kind == "snakemake":
            message = run_snakefile(block, where, environment)
        elif block.kind == "text":
            assert message is not None, f"{where}: no block before it prints text"
            if message is SKIPPED:
                continue
            try:
                assert_said(message, block.text, where)
            except AssertionError:
                if not request.config.getoption("rewrite", False):
                    raise
                printed[block.line] = message
        else:
            allowed = file or block.kind == "bibtex" or block.kind.startswith("{")
            assert allowed, f"{where}: unknown kind of block"
    if printed:
        rewrite(page, printed)


@pytest.mark.parametrize("page", PAGES)
def test_no_page_has_code_that_is_not_fenced(page):
    """No test runs indented blocks. (CONTRIBUTING.md has a diagram and a formula.)"""
    assert "```" not in prose(page), "a block without an end"
    indented = re.search(r"\n\n {4,}\S.*", prose(page))
    assert not indented or page == "CONTRIBUTING.md", indented[0].strip()


@pytest.mark.parametrize("page", PAGES)
def test_files_and_options_named_on_a_page_exist(page):
    unrun = [block for block in blocks(page) if block.kind == "bash"]
    text = "".join(block.text for block in unrun)
    names = re.findall(r"\b(?:benchmarks|config|profiles|docs)/[\w./]+", text)
    folders = "src|tests|workflow|config|docs|benchmarks|profiles"
    for name in names + re.findall(rf"`((?:{folders})/[\w./-]+)`", text_of(page)):
        assert (ROOT / name).exists(), f"{page}: {name}"
    for block in unrun:
        script = re.search(r"benchmarks/\w+\.py", block.text)
        for option in re.findall(r"--\w[\w-]*", block.text) if script else ():
            assert option in (ROOT / script[0]).read_text(), f"{page}: {option}"


# Links


def prose(page):
    """Text of a page without its blocks."""
    return FENCED.sub("", text_of(page))


def anchors(page):
    """Yield the anchors of the headings of a page."""
    for heading in re.findall(r"^#+ +(.*)$", prose(page), re.M):
        yield re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


@pytest.mark.parametrize("page", PAGES)
def test_links_lead_somewhere(page):
    for target in re.findall(r"\]\(([^)\s]+)\)", prose(page)):
        if re.match(r"[a-z]+:", target):
            assert target.startswith("https://doi.org/"), f"{page}: {target}"
            continue
        name, _, anchor = target.partition("#")
        there = ((ROOT / page).parent / name).resolve() if name else ROOT / page
        assert there.is_file(), f"{page}: {target}"
        if anchor:
            assert anchor in anchors(there.relative_to(ROOT)), f"{page}: {target}"


def test_every_model_and_every_public_name_has_its_place():
    listed = text_of("docs/explanation/physics.md").split("\n| model |")[1].split("\n\n")[0]
    assert sorted(re.findall(r"^\| `([\w-]+)` \|", listed, re.M)) == sorted(MODELS)
    api = text_of("docs/reference/api.md")
    assert [n for n in microslip.__all__ if f":: microslip.{n}\n" not in api] == []


# The pages as a site


FAR = r"(?:\w+:)?//"
LOADED = re.compile(rf'<(?!a\s)[^>]*\s(?:src|srcset|data|poster|href)="({FAR}[^"]*)"')
"""An address in another place that a browser loads to show a page."""


@pytest.mark.long
@pytest.mark.skipif(
    not all(map(find_spec, ("sphinx", "myst_nb", "furo"))),
    reason="the extra docs is not installed: pip install -e '.[docs]'",
)
def test_the_site_is_built_without_a_warning_and_without_a_network(tmp_path):
    refused = {f"{kind}_proxy": "http://127.0.0.1:9" for kind in ("http", "https", "all")}
    command = [sys.executable, "-m", "sphinx", "-W", "-n", "-q", ROOT / "docs", tmp_path / "html"]
    run_command(command, "docs", os.environ | refused)
    pages = {str(p.relative_to(tmp_path / "html")): p for p in tmp_path.rglob("*.html")}
    for page in PAGES:
        if page.startswith("docs/"):
            assert page.removeprefix("docs/").replace(".md", ".html") in pages
    for name, path in pages.items():
        assert LOADED.findall(path.read_text()) == [], name
    for path in tmp_path.rglob("*.css"):
        assert not re.search(rf"(url\(|@import)\s*['\"]?{FAR}", path.read_text()), path
    search = (tmp_path / "html" / "searchindex.js").read_text()
    assert json.loads(search[search.index("{") : search.rindex("}") + 1])["docnames"]
