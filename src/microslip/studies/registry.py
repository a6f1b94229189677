"""All studies: cost of accuracy, failures of methods, and check of the paper.

Each study is a package with two main modules. The first one (`accuracy_cost`, `stability` or
`claims`) makes the requests. It imports only light modules, because the workflow reads it at every
start. The second one, `dataset`, builds a dataset from the results. The modules `ladders`
(resolutions of the models) and `requests` (forms of the requests) are common to the studies.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING

from microslip.sweeps.batch import lookup

if TYPE_CHECKING:
    import xarray as xr

    from microslip.config.settings import Configuration, Settings

MODULES = {"accuracy": "accuracy_cost", "stability": "stability", "claims": "claims"}
"""Name of each study's request module. The keys are names in the configuration."""


def pieces(study: str, settings: Settings) -> list[list[dict]]:
    """Return the jobs of a study, slow ones first. A job is a list of requests."""
    slow, fast = _module(study, MODULES[study]).pieces(settings)
    return [*slow, *fast]


def build(
    configuration: Configuration, study: str, records: Iterable[dict]
) -> tuple[xr.Dataset, dict[str, xr.Dataset]]:
    """Build the dataset of a study, and the datasets of its groups by name."""
    return divided(undivided(configuration, study, lookup(records)), study)


def divided(dataset: xr.Dataset, study: str) -> tuple[xr.Dataset, dict[str, xr.Dataset]]:
    """Divide the dataset of a study into its root and the datasets of its groups."""
    from microslip.datasets import netcdf

    return netcdf.divide(dataset, _module(study, "dataset").GROUPS)


def undivided(configuration: Configuration, study: str, answer: Callable) -> xr.Dataset:
    """Build the dataset of a study with the variables of all groups.

    answer: function that returns the record of a request.
    """
    return _module(study, "dataset").build(configuration.studies[study], answer)


def report(dataset: xr.Dataset, study: str) -> Iterator[str]:
    """Yield lines of text that summarise the dataset of a study."""
    yield from _module(study, "dataset").report(dataset)


def _module(study: str, name: str) -> ModuleType:
    return import_module(f"microslip.studies.{study}.{name}")
