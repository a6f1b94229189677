"""A page about a dataset: what it holds, and what made it."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from html import escape

import xarray as xr
import yaml

from microslip.foundation.files import writing_beside

# Quantities whose range tells at a glance whether a run came out well, where a dataset has them.
RANGES = ("mu_macro", "mu_macro_error", "mu_torque", "reference_error", "seconds")
MOST_LINES = 40


def write(path: str | os.PathLike, dataset: xr.Dataset, lines: list[str]) -> None:
    """Write the page of an xarray.Dataset; lines: list of what its report says.

    Raises CacheError as `files.writing_beside` does.
    """
    # Text inside HTML, since the report of a run shows that in place.
    text = escape(page(dataset, lines))
    title = escape(dataset.attrs.get("title", ""))
    head = f'<!DOCTYPE html>\n<html lang="en"><meta charset="utf-8"><title>{title}</title>'
    with writing_beside(path) as beside:
        beside.write_text(f"{head}\n<pre>{text}</pre></html>\n", encoding="utf-8", newline="\n")


def page(dataset: xr.Dataset, lines: list[str]) -> str:
    """Return the text of the page; it depends on its arguments alone."""
    attributes = dict(dataset.attrs)
    parts = [attributes.pop("title", ""), "", *lines[:MOST_LINES]]
    if len(lines) > MOST_LINES:
        parts.append(f"... and {len(lines) - MOST_LINES} lines more, see the log of collecting")
    parts += ["", "Sizes", *(f"  {name}: {size}" for name, size in dataset.sizes.items())]
    parts += ["", "Ranges", *_ranges(dataset), "", "Made by"]
    configuration = json.loads(attributes.pop("configuration", "{}"))
    parts += [f"  {name}: {value}" for name, value in attributes.items()]
    parts += ["", "Configuration, with all defaults"]
    return "\n".join([*parts, yaml.safe_dump(configuration, default_flow_style=None, width=100)])


def _ranges(dataset: xr.Dataset) -> Iterator[str]:
    for name in RANGES:
        if name in dataset:
            values = dataset[name]
            yield f"  {name}: {float(values.min()):.6g} to {float(values.max()):.6g}"
