"""All studies: cost of accuracy, failures of methods, and the paper's claims.

Each study is a package with two main modules. The first one (`accuracy_cost`, `stability`, `claims`
or `propulsion`) makes the requests. It imports only light modules, because the workflow reads it at
every start. The second one, `dataset`, builds a dataset from the results. The modules `ladders`
(resolutions of the models) and `requests` (forms of the requests) are common to the studies.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING

from microslip.config.records import Configuration

if TYPE_CHECKING:
    import xarray as xr

DATASETS = {
    "accuracy": "accuracy_cost",
    "stability": "stability",
    "claims": "claims",
}
"""Name of each study's dataset and request module. The keys are names in the configuration."""


def pieces(study: str, configuration: Configuration) -> tuple[list, list]:
    """Return the slow jobs and the fast jobs as two lists. A job is a list of requests."""
    return _module(study, DATASETS[study]).pieces(getattr(configuration, study))


def settings(study: str, configuration: Configuration) -> dict:
    """Return all settings that affect the dataset of a study, as a dict for JSON."""
    return getattr(configuration, study).model_dump()


def build(study: str, configuration: Configuration, answer: Callable) -> object:
    """Build the xarray.Dataset of a study.

    configuration: records.Configuration; answer: function that returns the record of a request, see
    microslip.sweeps.batches.
    """
    return _module(study, "dataset").build(getattr(configuration, study), answer)


def groups(study: str) -> dict:
    """Return each group's title and dimensions by group name, as for netcdf.divide."""
    return _module(study, "dataset").GROUPS


def report(study: str, dataset: xr.Dataset) -> Iterator[str]:
    """Yield lines of text that summarise the dataset of a study."""
    return _module(study, "dataset").report(dataset)


def _module(study: str, name: str) -> ModuleType:
    return import_module(f"microslip.studies.{study}.{name}")
