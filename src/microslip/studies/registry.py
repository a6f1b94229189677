"""Studies: how accuracy is paid for, where methods fail, which of the paper's claims hold, and what
motions drive.

`ladders` says in which resolutions a model is run; `accuracy_cost`, `stability`, `claims` and
`propulsion` make the requests; `fronts` picks and fits, `verdicts` judges; those with `dataset`
in their name turn the answers into datasets. What is asked is plain data that imports nothing
heavy, since the workflow reads it whenever it is parsed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING

from microslip.config.records import Configuration
from microslip.studies.accuracy import accuracy_cost
from microslip.studies.claims import claims
from microslip.studies.propulsion import propulsion
from microslip.studies.stability import stability

if TYPE_CHECKING:
    import xarray as xr

# Studies, named as in the configuration, and their datasets.
DATASETS = {
    "accuracy": "accuracy_cost",
    "stability": "stability",
    "claims": "claims",
    "propulsion": "propulsion",
}

_ASKED = {
    "accuracy": accuracy_cost,
    "stability": stability,
    "claims": claims,
    "propulsion": propulsion,
}


def pieces(study: str, configuration: Configuration) -> tuple[list, list]:
    """Requests grouped by job: two lists of lists of requests, the slow jobs and the fast ones."""
    return _ASKED[study].pieces(getattr(configuration, study))


def settings(study: str, configuration: Configuration) -> dict:
    """All settings that the dataset of a study depends on, as a dict for JSON."""
    return getattr(configuration, study).model_dump()


def build(study: str, configuration: Configuration, answer: Callable) -> object:
    """Assemble the xarray.Dataset of a study.

    configuration: records.Configuration. answer(request) -> record, see microslip.sweeps.batches.
    """
    return _dataset_of(study).build(getattr(configuration, study), answer)


def groups(study: str) -> dict:
    """Groups in the file of a study's dataset, as for netcdf.divide: title and dims by name."""
    return _dataset_of(study).GROUPS


def report(study: str, dataset: xr.Dataset) -> Iterator[str]:
    """Lines of text that sum up the dataset of a study."""
    return _dataset_of(study).report(dataset)


def _dataset_of(study: str) -> ModuleType:
    return import_module(f"microslip.studies.{study}.dataset")
