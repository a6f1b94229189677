"""Studies: cost of accuracy, failures of methods, claims of the paper, and propulsion.

Each study has a package with two modules. The module of its requests (`accuracy_cost`, `stability`,
`claims`, `propulsion`) is plain data and imports nothing heavy, because the workflow reads it at
every start. The module `dataset` builds a dataset from the results. `ladders` holds the resolutions
of the models, `requests` the forms of the requests.
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
    "propulsion": "propulsion",
}
"""Studies, named as in the configuration, and the names of their datasets and request modules."""


def pieces(study: str, configuration: Configuration) -> tuple[list, list]:
    """Requests grouped by job: two lists of lists of requests, the slow jobs and the fast ones."""
    return _module(study, DATASETS[study]).pieces(getattr(configuration, study))


def settings(study: str, configuration: Configuration) -> dict:
    """All settings that the dataset of a study depends on, as a dict for JSON."""
    return getattr(configuration, study).model_dump()


def build(study: str, configuration: Configuration, answer: Callable) -> object:
    """Assemble the xarray.Dataset of a study.

    configuration: records.Configuration. answer(request) -> record, see microslip.sweeps.batches.
    """
    return _module(study, "dataset").build(getattr(configuration, study), answer)


def groups(study: str) -> dict:
    """Groups in the file of a dataset, as for netcdf.divide: title and dims by name."""
    return _module(study, "dataset").GROUPS


def report(study: str, dataset: xr.Dataset) -> Iterator[str]:
    """Lines of text that summarise the dataset of a study."""
    return _module(study, "dataset").report(dataset)


def _module(study: str, name: str) -> ModuleType:
    return import_module(f"microslip.studies.{study}.{name}")
