"""Declared dependencies: each has a lower bound that works, and the workflow tool an upper one."""

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
    """.ci/lowest derives the versions that it installs from them."""
    for requirement in LISTS[name]:
        if not requirement.startswith("microslip["):
            operators = {bound.operator for bound in Requirement(requirement).specifier}
            assert ">=" in operators and operators <= {">=", "<"}, requirement


@pytest.mark.parametrize(
    ("name", "version"),
    [
        ("pint", "0.24.3"),  # cannot be imported beside the flexparser of today
        ("matplotlib", "3.9.4"),
        ("xarray", "2024.11.0"),  # interp fails along two axes of a dataset
        ("netCDF4", "1.7.0"),  # withdrawn
        ("snakemake", "9.3.5"),  # prints "Waiting for more resources" once a job
        ("snakemake", "10.0.0"),  # interfaces of plug-ins change with it
    ],
)
def test_releases_that_fail_are_excluded(name, version):
    assert not DEPENDENCIES[name].contains(version)


def test_the_workflow_requires_the_snakemake_that_is_declared():
    needed = re.search(r'min_version\("([^"]+)"\)', (TOP / "Snakefile").read_text())[1]
    assert DEPENDENCIES["snakemake"].contains(needed)
    assert f">={needed}" in map(str, DEPENDENCIES["snakemake"])
