"""Declared dependencies: each has a lower bound, and Snakemake an upper one."""

import re
import tomllib
from pathlib import Path

import pytest
import yaml
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from stubs import new_process

TOP = Path(__file__).parents[1]
PROJECT = tomllib.loads((TOP / "pyproject.toml").read_text(encoding="utf-8"))["project"]
LISTS = {"dependencies": PROJECT["dependencies"], **PROJECT["optional-dependencies"]}
USED = [*LISTS["dependencies"], *LISTS["plot"], *LISTS["workflow"][1:]]
DEPENDENCIES = {one.name: one.specifier for one in map(Requirement, USED)}
OPTIONAL = {"matplotlib": "plot", "plotly": "plot", "snakemake": "workflow", "jinja2": "workflow"}


@pytest.mark.parametrize("name", LISTS)
def test_every_requirement_has_a_lower_bound(name):
    """.ci/lowest installs these lower bounds."""
    for requirement in LISTS[name]:
        if not requirement.startswith("microslip["):
            operators = {bound.operator for bound in Requirement(requirement).specifier}
            assert ">=" in operators and operators <= {">=", "<"}, requirement


def test_the_conda_recipe_requires_the_same_versions():
    names = {"netCDF4": "netcdf4", "PyYAML": "pyyaml", "dask": "dask-core"}
    names |= {"matplotlib": "matplotlib-base", "snakemake": "snakemake-minimal"}
    recipe = yaml.safe_load((TOP / "containers" / "recipe.yaml").read_text())
    needed = {names.get(name, name): bounds for name, bounds in DEPENDENCIES.items()}
    listed = dict(one.split(" ", 1) for one in recipe["requirements"]["run"][1:])
    assert {name: SpecifierSet(bounds) for name, bounds in listed.items()} == needed


BLOCKED = (
    "import sys\n"
    f"sys.modules.update(dict.fromkeys({[*OPTIONAL]}))\n"
    "from microslip.app import cli\n"
    "sys.exit(cli.main(sys.argv[1:]))"
)
"""Runs a command without the packages of the extras, which cannot be imported then."""


def test_a_point_needs_no_extra():
    words = ("point", "transverse", "--velocity", "0.1", "--amplitude", "0")
    assert "mu_macro" in new_process.output(BLOCKED, *words)


@pytest.mark.parametrize(
    ("words", "extra"),
    [
        (("sweep", "-n"), "workflow"),
        (("fit", "transverse", "rows.csv", "--figure", "fit.png"), "plot"),
    ],
)
def test_a_command_that_needs_an_extra_names_it(words, extra):
    process = new_process.run(BLOCKED, *words)
    assert process.returncode == 2
    (line,) = process.stderr.splitlines()
    assert f"microslip[{extra}]" in line


def test_the_workflow_requires_the_snakemake_that_is_declared():
    needed = re.search(r'min_version\("([^"]+)"\)', (TOP / "Snakefile").read_text())[1]
    assert DEPENDENCIES["snakemake"].contains(needed)
    assert f">={needed}" in map(str, DEPENDENCIES["snakemake"])
