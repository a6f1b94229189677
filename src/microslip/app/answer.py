"""The answer of a command, as text, JSON, a CSV or netCDF file, or a figure."""

from __future__ import annotations

import csv
import io
import json
import math
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from microslip.foundation import extras
from microslip.foundation.canonical import plain
from microslip.foundation.errors import CacheError, InputError
from microslip.foundation.files import writing_beside


class Answer(NamedTuple):
    """The answer of a command.

    Attributes
    ----------
    plain : object
        The answer as values that JSON can represent.
    text : str
        The answer as text.
    complete : bool
        True if the command ends with the exit code 0.
    csv : callable or None
        csv() returns the content of the .csv file for --output.  None if the command writes no such
        file.
    dataset : callable or None
        dataset() returns the xarray.Dataset for the .nc file of --output and for the figure.
    figure : str
        Name of the figure in report.figures.drawing.
    is_table : bool
        True if the text contains the rows that --output writes.  With --output, they are not
        printed.
    """

    plain: Any
    text: str
    complete: bool
    csv: Callable[[], str] | None = None
    dataset: Callable[[], Any] | None = None
    figure: str = ""
    is_table: bool = False

    def write(self, output: str | None, figure: str | None) -> Answer:
        """Write the files of --output and --figure, and return the answer to print.

        Raises InputError if a file cannot be written.
        """
        if figure is not None and self.dataset is not None:
            from microslip.report.figures.drawing import draw, save

            save(draw(self.figure, {self.figure: self.dataset()}), figure)
        if output is None or self.csv is None and self.dataset is None:
            return self
        try:
            with writing_beside(output) as beside:
                if self.csv is not None and output.lower().endswith(".csv"):
                    beside.write_text(self.csv(), encoding="utf-8", newline="\n")
                elif self.dataset is not None:
                    self.dataset().to_netcdf(beside, engine="netcdf4")
        except (OSError, CacheError) as error:
            raise InputError("output", output, f"cannot be written: {error}") from None
        lines = self.text.splitlines()
        lines = [line for line in lines if line.startswith("#") or not self.is_table]
        return self._replace(text="\n".join(lines))

    def print(self, as_json: bool) -> None:
        if text := json.dumps(plain(self.plain)) if as_json else self.text:
            print(text)


def csv_text(columns: Mapping[str, Any], comments: Sequence[str] = (), digits: int = 0) -> str:
    """Return the content of a CSV file.  NaN becomes an empty cell.

    columns: values or pairs (unit, values), keyed by name.  digits: number of significant digits,
    or 0 for all.
    """

    def cell(value: Any) -> Any:
        if not isinstance(value, float):
            return value
        return "" if math.isnan(value) else f"{value:.{digits}g}" if digits else value

    headings, lists = [], []
    for name, values in columns.items():
        unit, values = values if isinstance(values, tuple) else ("1", values)
        headings.append(name if unit == "1" else f"{name} [{unit}]")
        lists.append(values.tolist() if hasattr(values, "tolist") else values)
    stream = io.StringIO()
    stream.writelines(f"# {one}\n" for one in comments)
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(headings)
    writer.writerows(map(cell, row) for row in zip(*lists, strict=True))
    return stream.getvalue()


def output_file(*endings: str) -> Callable[[str, str], str]:
    """Return a function that reads the name of a new file from an option.  `endings` contains the
    allowed file extensions."""

    def read(argument: str, text: str) -> str:
        file, problem = Path(text), ""
        if file.suffix.lower() not in endings:
            problem = f"allowed is a name that ends in {' or '.join(endings)}"
        elif file.is_dir() or not (file.parent.is_dir() and os.access(file.parent, os.W_OK)):
            problem = "allowed is a file in a folder that can be written to"
        elif ".png" in endings:
            problem = extras.missing("matplotlib")
        if problem:
            raise InputError(argument, text, problem)
        return text

    return read


def opened_map(argument: str, text: str) -> Any:
    """Return the dataset for the option --map, which is a .nc file or the name of a sweep."""
    from microslip.datasets.open_map import open_map

    try:
        dataset = open_map(text)
    except (InputError, CacheError) as error:
        raise InputError(argument, text, getattr(error, "allowed", str(error))) from None
    dataset.encoding["source"] = text  # for messages
    return dataset
