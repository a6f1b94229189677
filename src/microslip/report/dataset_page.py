"""Write a page that describes the contents and the provenance of a dataset."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Sequence
from html import escape
from pathlib import Path

import xarray as xr
import yaml

from microslip.foundation.files import write_atomically

RANGES = (
    *("mu_macro", "mu_macro_error", "mu_torque", "dissipated_energy", "dissipated_energy_error"),
    *("reference_error", "seconds"),
)
"""Variables whose smallest and largest values are on the page."""
MOST_LINES = 40


def write(path: str | os.PathLike, dataset: xr.Dataset, lines: list[str]) -> None:
    """Write the page of a dataset to a file. lines: log of the collection of the dataset.

    Raises CacheError if the file cannot be written.
    """
    # Snakemake's report displays HTML inline.
    text, title = escape(page(dataset, lines)), escape(dataset.attrs.get("title", ""))
    head = f'<!DOCTYPE html>\n<html lang="en"><meta charset="utf-8"><title>{title}</title>'
    write_atomically(Path(path), f"{head}\n<pre>{text}</pre></html>\n".encode())


def page(dataset: xr.Dataset, lines: list[str]) -> str:
    """Return the text of the page. It depends on the arguments only."""
    shown = lines[:MOST_LINES]
    if len(lines) > MOST_LINES:
        shown.append(f"... and {len(lines) - MOST_LINES} lines more, see the log of collecting")
    sizes = [f"  {name}: {size}" for name, size in dataset.sizes.items()]
    parts = [dataset.attrs.get("title", ""), "", *shown, "", "Sizes", *sizes, "", "Ranges"]
    return "\n".join([*parts, *_ranges(dataset), "", "Made by", *provenance(dataset)])


def provenance(
    dataset: xr.Dataset, lines: Sequence[str] = (), without: Sequence[str] = ("title",)
) -> Iterator[str]:
    """Return lines with the attributes (except `without`), `lines` and the configuration."""
    attributes = {name: value for name, value in dataset.attrs.items() if name not in without}
    configuration = json.loads(attributes.pop("configuration", "{}"))
    yield from (f"  {name}: {value}" for name, value in attributes.items())
    yield from ("", *lines, *[""][: len(lines)], "Configuration, with all defaults")
    yield yaml.safe_dump(configuration, default_flow_style=None, width=100)


def _ranges(dataset: xr.Dataset) -> Iterator[str]:
    for name in RANGES:
        if name in dataset:
            values = dataset[name]
            yield f"  {name}: {float(values.min()):.6g} to {float(values.max()):.6g}"
