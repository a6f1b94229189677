"""Functions for the datasets of all studies: results of requests, tables, and provenance."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, TypeVar, overload

import numpy as np
import xarray as xr
from pydantic import BaseModel

from microslip.datasets import sweep_dataset
from microslip.datasets.variables import variable
from microslip.foundation.canonical import canonical_json, sha256

Kind = TypeVar("Kind")


class Answers:
    """Look up the results of requests.

    The object also collects the keys of the results, the library versions, and the computers on
    which times were measured (`machines`, a list of dicts).

    answer: function that returns the record of a request, see microslip.sweeps.batch.
    """

    def __init__(self, answer: Callable):
        self.answer = answer
        self.keys: set[str] = set()
        self.versions: set[str] = set()
        self.machines: list[dict] = []

    def record(self, request: dict) -> dict:
        """Return the record of a request."""
        record = self.answer(request)
        self.keys.add(record["key"])
        self.versions.add(canonical_json(record["versions"]))
        machine = record["result"].get("machine")
        if machine is not None and machine not in self.machines:
            self.machines.append(machine)
        return record

    def __call__(self, request: dict) -> Any:  # a result; a Run of runs.Runs
        return self.record(request)["result"]

    def machine_of(self, result: dict) -> int:
        """Return the index in `machines` of the computer that measured a result's time.

        The index is -1 if the result has no time.
        """
        machine = result.get("machine")
        return self.machines.index(machine) if machine in self.machines else -1


@overload
def value_of(result: dict, name: str) -> float: ...


@overload
def value_of(result: dict, name: str, kind: type[Kind]) -> Kind: ...


def value_of(result: dict, name: str, kind: type = float) -> Any:
    """Return a value of a result, converted to `kind`.

    A missing value becomes NaN, 0, False or an empty string, depending on `kind`.
    """
    value = result.get(name)
    if value is None:
        return np.nan if kind is float else kind()
    return kind(value)


def table(
    dim: str | tuple[str, ...], rows: Iterable[tuple], columns: dict[str, tuple]
) -> dict[str, tuple]:
    """Return the variables of a table as arguments of xarray.Dataset.

    columns: maps each name to (function of a row's items, long_name, kind, units). The defaults of
    kind and units are those of `variable`.
    """
    rows = list(rows)
    return {
        name: variable(dim, [read(*row) for row in rows], *about)
        for name, (read, *about) in columns.items()
    }


def finished(
    variables: dict,
    title: str,
    answers: Answers,
    settings: BaseModel,
    coordinates: Iterable[str] = (),
    **attributes: object,
) -> xr.Dataset:
    """Return a dataset with provenance. The settings are stored as an attribute in JSON.

    coordinates: names of coordinates that are not named after their dimension.
    """
    # The keys also depend on the sources of the methods.
    digest = sha256("\n".join(sorted(answers.keys)))
    described = sweep_dataset.provenance(
        title, settings.model_dump(), answers.versions, results_digest=digest, **attributes
    )
    return xr.Dataset(variables, attrs=described).set_coords(list(coordinates))
