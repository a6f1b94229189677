"""Write pages that describe the contents and the provenance of datasets.

The page of the study `claims` contains the verdicts, the numbers that support them, and commands
that repeat the runs. This page is made from the dataset and the template claims.html. Every page is
one self-contained HTML file.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from html import escape
from pathlib import Path
from types import SimpleNamespace

import jinja2
import numpy as np
import xarray as xr
import yaml

from microslip.datasets.catalogue import FORMS
from microslip.report.motions import MOTIONS
from microslip.studies.static_limits import FORMULAS
from microslip.studies.verdicts import OUTCOMES, WORDS

RANGES = (
    *("mu_macro", "mu_macro_error", "mu_torque", "dissipated_energy", "dissipated_energy_error"),
    *("reference_error", "seconds"),
)
"""Variables whose smallest and largest values are shown on the page."""
MOST_LINES = 40


def page(dataset: xr.Dataset, lines: list[str]) -> str:
    """Return the HTML of the page of a dataset. The HTML depends only on the arguments.

    lines: log lines from the collection of the dataset.
    """
    if "verdict" in dataset:
        return claims_page(dataset, lines)
    # Snakemake's report displays HTML inline.
    text, title = escape(text_page(dataset, lines)), escape(dataset.attrs.get("title", ""))
    head = f'<!DOCTYPE html>\n<html lang="en"><meta charset="utf-8"><title>{title}</title>'
    return f"{head}\n<pre>{text}</pre></html>\n"


def text_page(dataset: xr.Dataset, lines: list[str]) -> str:
    """Return the contents and the provenance of a dataset as plain text."""
    shown = lines[:MOST_LINES]
    if len(lines) > MOST_LINES:
        shown.append(f"... and {len(lines) - MOST_LINES} lines more, see the log of collecting")
    sizes = [f"  {name}: {size}" for name, size in dataset.sizes.items()]
    parts = [dataset.attrs.get("title", ""), "", *shown, "", "Sizes", *sizes, "", "Ranges"]
    return "\n".join([*parts, *_ranges(dataset), "", "Made by", *provenance(dataset)])


def provenance(
    dataset: xr.Dataset, lines: Sequence[str] = (), without: Sequence[str] = ("title",)
) -> Iterator[str]:
    """Yield the attributes except those in `without`, then `lines`, then the configuration."""
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


# The page of the study `claims`


def claims_page(dataset: xr.Dataset, lines: list[str]) -> str:
    """Return the page for the study `claims` as HTML."""
    environment = jinja2.Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True)
    environment.filters.update(number=_number, with_error=_with_error, is_finite=np.isfinite)
    text = Path(__file__).with_name("claims.html").read_text(encoding="utf-8")
    runs, claims = _runs(dataset), []
    for claim in _records(dataset, "claim"):
        claim.parts = [one for one in _parts(dataset, runs) if one.claim == claim.name]
        shown = [part.decisive for part in claim.parts if part.counts and part.decisive]
        claim.runs = list({check.run.row: check.run for check in shown}.values())
        claims.append(claim)
    return environment.from_string(text).render(
        words=WORDS,
        outcomes=OUTCOMES,
        claims=claims,
        motions=[_static(dataset, name) for name in MOTIONS if f"{name}_limit" in dataset],
        runs=runs.values(),
        dataset=dataset,
        made_by="\n".join(provenance(dataset, lines, ("title", "comment"))),
    )


def _records(dataset: xr.Dataset, dim: str, prefix: str = "") -> list[SimpleNamespace]:
    """Return the entries along a dimension. Each entry has the attribute `name`, which contains the
    coordinate along this dimension.

    prefix: prefix to remove from the names of variables. The default is the name of the dimension.
    """
    names = [name for name in dataset.variables if dataset[name].dims == (dim,)]
    short = {name: str(name).removeprefix(prefix or f"{dim}_") for name in names} | {dim: "name"}
    rows = dataset[names].to_dataframe().reset_index().rename(columns=short).to_dict("records")
    return [SimpleNamespace(**row) for row in rows]


def _runs(dataset: xr.Dataset) -> dict[str, SimpleNamespace]:
    """Return a dict of the runs, keyed by name. Each run has a description and the number of its
    row on the page."""
    runs = {run.name: run for run in _records(dataset, "run")}
    for row, run in enumerate(runs.values(), start=1):
        run.row = row
        words = [run.motion, f"v {run.velocity:g}"]
        words += [f"A {run.amplitude:g}"] if np.isfinite(run.amplitude) else []
        size = f"{run.cells:.0f} cells" if run.cells else ""
        size += f" x {run.angles:.0f} angles" if run.angles > 1 else ""
        steps = f"{run.steps:.0f} steps" if run.steps else ""
        words += [f"nu {run.poisson:g}", run.model, size, steps]
        run.place = ", ".join(filter(None, words))
    return runs


def _parts(dataset: xr.Dataset, runs: dict[str, SimpleNamespace]) -> list[SimpleNamespace]:
    """Return the parts of all statements, each with the checks of the part and the decisive
    check."""
    checks, parts = _records(dataset, "check"), _records(dataset, "part")
    for check in checks:
        check.run, check.other_run = runs[check.run], runs.get(check.other_run)
    for part in parts:
        part.checks = [check for check in checks if check.part == part.name]
        decided = (check for check in part.checks if OUTCOMES[check.outcome] != "open")
        # the check that fails most clearly or, if no check fails, the one that holds most narrowly
        part.decisive = min(decided, key=lambda one: (-one.outcome, one.margin), default=None)
    return parts


def _number(value: float, digits: int = 4) -> str:
    return "" if not np.isfinite(value) else f"{value:.{digits}g}"


def _with_error(value: float, error: float) -> str:
    """Format the significant digits of a number, followed by the error estimate."""
    if not np.isfinite(value):
        return "none"
    if not np.isfinite(error):
        return f"{_number(value)}, without an error estimate"
    decimals = int(np.clip(1 - np.floor(np.log10(max(error, 1e-12))), 1, 6))
    rounded = f"{value:.{decimals}f}"
    return f"{rounded if float(rounded) else _number(value)} \N{PLUS-MINUS SIGN} {error:.2g}"


def _static(dataset: xr.Dataset, motion: str) -> SimpleNamespace:
    """Return the table of the static limit, with a row for each amplitude.

    The largest excess of each formula over the limit is also returned.
    """
    names = {name: FORMS[motion][form].equation for name, form in FORMULAS[motion].items()}
    gaps = [
        (equation, *(float(dataset[f"{motion}_gap_{name}{end}"]) for end in ("", "_at")))
        for name, equation in names.items()
    ]
    rows = _records(dataset, f"{motion}_amplitude", f"{motion}_")
    title = MOTIONS[motion].title.capitalize()
    return SimpleNamespace(title=title, names=names, gaps=gaps, rows=rows)
