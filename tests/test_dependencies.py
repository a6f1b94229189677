"""Declared dependencies: each has a lower bound, and Snakemake an upper one."""

import re
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement

TOP = Path(__file__).parents[1]
PROJECT = tomllib.loads((TOP / "pyproject.toml").read_text(encoding="utf-8"))["project"]
LISTS = {"dependencies": PROJECT["dependencies"], **PROJECT["optional-dependencies"]}
DEPENDENCIES = {r.name: r.specifier for r in map(Requirement, PROJECT["dependencies"])}


@pytest.mark.parametrize("name", LISTS)
def test_every_requirement_has_a_lower_bound(name):
    """.ci/lowest installs these lower bounds."""
    for requirement in LISTS[name]:
        if not requirement.startswith("microslip["):
            operators = {bound.operator for bound in Requirement(requirement).specifier}
            assert ">=" in operators and operators <= {">=", "<"}, requirement


@pytest.mark.parametrize(
    ("name", "version"),
    [
        ("pint", "0.24.3"),  # cannot be imported with current versions of flexparser
        ("matplotlib", "3.9.4"),
        ("xarray", "2024.11.0"),  # interp of a dataset along two axes fails
        ("netCDF4", "1.7.0"),  # withdrawn
        ("snakemake", "9.3.5"),  # prints "Waiting for more resources" for every job
        ("snakemake", "10.0.0"),  # changes the interfaces of plug-ins
    ],
)
def test_releases_that_fail_are_excluded(name, version):
    assert not DEPENDENCIES[name].contains(version)


def test_the_workflow_requires_the_snakemake_that_is_declared():
    needed = re.search(r'min_version\("([^"]+)"\)', (TOP / "Snakefile").read_text())[1]
    assert DEPENDENCIES["snakemake"].contains(needed)
    assert f">={needed}" in map(str, DEPENDENCIES["snakemake"])
