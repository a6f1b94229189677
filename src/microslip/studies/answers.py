"""Answers to the requests of a study, and tables of the variables in the dataset of a study."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from microslip.foundation.canonical import canonical_json

Row = dict[str, Any]
"""An answer, as a dict.  An answer contains the entries of a request, the entries of the result,
the name of the result (`key`), the number of time steps in a period, and the index of the computer.
If the request and the result have an entry of the same name, the entry of the result is used."""
MOTIONS = ("transverse", "bore")
"""Motions that are inserted for {motion} in the tables of variables and groups."""


class Answers:
    """Callable object that returns the `Row` of a request.

    Attributes
    ----------
    rows : dict of str to (dict, Row)
        Each request and its row, keyed by the JSON string of the request, in the order of first
        use.
    versions : set of str
        Versions of the libraries that computed the results.
    machines : list of dict
        Computers on which times were measured.
    """

    def __init__(self, answer: Callable[[dict], dict]):
        """answer: function that returns the record of a request (see sweeps.batch.lookup)."""
        self._answer = answer
        self.rows: dict[str, tuple[dict, Row]] = {}
        self.versions: set[str] = set()
        self.machines: list[dict] = []

    def __call__(self, request: dict) -> Row:
        """Return the row of a request."""
        text = canonical_json(request)
        if text not in self.rows:
            record = self._answer(request)
            result = record["result"]
            self.versions.add(canonical_json(record["versions"]))
            if (machine := result.get("machine")) not in (None, *self.machines):
                self.machines.append(machine)
            steps = result.get("steps_per_period") or result.get("steps") or request.get("steps")
            index = self.machines.index(machine) if machine else -1
            own = {"key": record["key"], "machine": index, "steps": steps}
            self.rows[text] = request, request | result | own
        return self.rows[text][1]


def columns(study: str, dims: str, rows: list[Row], *shape: int) -> dict[str, Any]:
    """Return the values of all variables of a study that have the dimensions `dims`.

    rows: one row for each value; the last dimension varies fastest. shape: lengths of the
    dimensions, if there are several.
    """
    from microslip.datasets import variables  # imports NumPy

    own = [row for row in rows_of("variables.csv", study) if row["dims"] == dims]
    every = variables.columns(own, rows, len(rows))
    return {name: values.reshape(shape or -1) for name, values in every.items()}


def number(row: Row, name: str) -> float:
    """Return the number that a row contains under a name, or NaN if there is no such number."""
    value = row.get(name)
    return math.nan if value is None else float(value)


def rows_of(table: str, study: str) -> Iterator[dict[str, str]]:
    """Yield the rows of a table for a study.  A row with {motion} is repeated for each motion.

    table: "variables.csv" or "groups.csv".
    """
    from microslip.datasets.variables import rows  # imports NumPy

    for row in rows(Path(__file__).with_name(table)):
        if row["study"] == study:
            for motion in MOTIONS if "{motion}" in row["dims"] else MOTIONS[:1]:
                yield {key: text.replace("{motion}", motion) for key, text in row.items()}
