"""The command `microslip predict`: friction of a contact in SI units."""

from __future__ import annotations

import argparse
import math
from collections.abc import Collection, Mapping
from typing import Any

from microslip.app.option_parser import StoreSpelling, format_as_options, option
from microslip.app.question import (
    FILE_FORMAT,
    Answer,
    add_answer,
    add_options,
    refuse_figure,
    refuse_output,
    typed_options,
    write_files,
)
from microslip.app.terminal import complain
from microslip.foundation.errors import InputError, shown
from microslip.foundation.named_files import speaks_of_file
from microslip.si.inputs import INPUTS, MOTIONS


def options_of(group: str) -> dict[str, tuple[str, str]]:
    """Metavar and help text of the options for the inputs of a group."""
    return {
        name.replace("_", "-"): (name.upper(), one.help.replace("%", "%%"))
        for name, one in INPUTS.items()
        if one.group == group
    }


GROUPS = {one.group: options_of(one.group) for one in INPUTS.values()}
"""Metavar and help text of the options for inputs, by heading in the help text."""
OUTPUT = {
    **{name: (word, f"with --table: {text}") for name, (word, text) in FILE_FORMAT.items()},
    "table": (
        "CSV",
        "predict one contact for each line of a file.  Its heading names options, as in "
        "load [N],speed [mm/s],material; options on the command line apply to all lines",
    ),
    "output": ("FILE", "with --table or ranges: write all columns to a .csv or .nc file"),
    "figure": ("FILE", "with one or two ranges: draw friction, .png or .pdf"),
}
"""Options for tables and files."""
WITH = {"output": "--table or a range", "figure": "a range"} | dict.fromkeys(FILE_FORMAT, "--table")
"""Options that require another option."""
ABOUT_GROUPS = {
    "drive": "For an oscillating normal load there are two reference loads.  Stiffness, mass and "
    "damping are made dimensionless by mu times the load without oscillation, force and mu_macro "
    "by mu times the mean load.",
}
"""Descriptions of option groups."""
MOST_COMPLAINTS = 10
"""Largest number of error messages about contacts without a prediction."""
MOST_LINES = 8
"""Largest number of lines in a figure."""


def fill(parser: argparse.ArgumentParser) -> None:
    """Add the description and the arguments of `predict` to its parser."""
    parser.description = (
        "Friction of a vibrated contact in SI units, with its error estimate and with warnings "
        "where the theory does not apply.  Every quantity has a unit.  mu_macro is a ratio: "
        "friction with vibration divided by friction without.  mu_apparent is the coefficient of "
        "friction with vibration.  For a quantity with a standard uncertainty, such as "
        "'0.15 +- 0.05' or '10 N +- 5 %', the answer has intervals and the probability of each "
        "outcome.  A quantity can be a range: '0..2 um' has 11 values, '0..2 um, 21' has 21, and "
        "'0.1..10 mm/s, 21, log' has equal ratios.  The answer is then a table."
    )
    motions = "; ".join(f"{name}: it {kind.description}" for name, kind in MOTIONS.items())
    parser.add_argument(
        "motion",
        action=StoreSpelling,
        metavar="MOTION",
        help=f"motion of the sphere. {motions}; file:FILE: it follows one period of samples with "
        "units; or another motion of `microslip point`",
    )
    for title, options in GROUPS.items():
        group = parser.add_argument_group(title, ABOUT_GROUPS.get(title))
        add_options(group, options | (OUTPUT if title == "output" else {}))
    add_answer(parser, _answer, group)


def _answer(options: argparse.Namespace) -> Answer:
    from microslip import predict
    from microslip.app.progress import elapsed_time
    from microslip.si.table import is_range

    if speaks_of_file(options.motion):
        from microslip.si.strokes import read_stroke

        if hint := read_stroke(options.motion).hint:
            complain(f"microslip predict: MOTION = {options.motion!r}: {hint}")
    arguments = typed_options(options)
    ranges = {name: value for name, value in arguments.items() if is_range(name, value)}
    if options.table is not None and ranges:
        raise InputError(*next(iter(ranges.items())), "a range; allowed without --table")
    source = "--table" if options.table is not None else "range" if ranges else "nothing"
    for name, allowed in WITH.items():
        if getattr(options, name) is not None and source not in allowed:
            raise InputError(name, getattr(options, name), f"allowed only with {allowed}")
    if source != "nothing":
        return _many(options, arguments)
    with elapsed_time("microslip predict"):
        prediction = predict(options.motion, **arguments)
    return Answer(prediction.to_dict(), str(prediction), prediction.converged)


def _many(options: argparse.Namespace, arguments: Mapping[str, Any]) -> Answer:
    """Predict all contacts in a table, or all combinations of the values in ranges.

    The answer is complete if all predictions converged.  Error messages of contacts without a
    prediction are written to standard error.  Raises InputError if an option is invalid, or no
    contact is valid.
    """
    from tqdm import tqdm

    from microslip.si.output import Prediction
    from microslip.si.table import dataset_of, grid_of, predictions, read_cases, table_text

    refuse_output(options.output, options.table)
    refuse_figure(options.figure)
    format: dict[str, Any] = {name: arguments[name] for name in FILE_FORMAT if name in arguments}
    shared = {name: value for name, value in arguments.items() if name not in FILE_FORMAT}
    if options.table is not None:
        cases = read_cases(options.motion, options.table, shared, **format)
    else:
        cases = grid_of(options.motion, shared)
        sizes = sorted(len(values) for _, _, values in cases.axes.values())
        if options.figure is not None and (len(sizes) > 2 or sizes[:-1] > [MOST_LINES]):
            allowed = f"allowed with one range, or with a second one of at most {MOST_LINES} values"
            raise InputError("figure", options.figure, allowed)
    headings = cases.columns if options.table is not None else ()  # not shown as options
    try:
        lazy = predictions(cases)
    except InputError as error:
        if error.argument not in headings:
            raise
        problem = problem_text(error, headings)
        raise InputError("table", options.table, problem) from None
    answers = list(tqdm(lazy, "contacts", len(cases.names), leave=False, disable=None))
    errors = [
        "" if isinstance(one, Prediction) else problem_text(one, headings, options.map)
        for one in answers
    ]
    names = cases.axes or [name for name in cases.starts if name != "case"]
    rows = []
    for k, one in enumerate(answers):
        start = {name: cases.starts[name][k] for name in names if name in cases.starts}
        plain = one.to_dict() if isinstance(one, Prediction) else {}
        rows.append({**start, "error": errors[k] or None, **plain})
    if cases.axes:
        for row, point in zip(rows, _points(cases.axes), strict=True):
            row |= point
    if options.output is not None or options.figure is not None:
        dataset = dataset_of(cases, answers)
        shape = dataset["error"].shape
        dataset["error"] = dataset["error"].copy(data=_reshaped(errors, shape))
        if "line" in cases.starts:
            about = {"long_name": "line of the file"}
            dataset = dataset.assign_coords(line=("case", cases.starts["line"], about))
        write_files(options, "curve", dataset)
    missing = [
        text if isinstance(one, str) else f"{name}: {text}"
        for name, text, one in zip(cases.names, errors, answers, strict=True)
        if text
    ]
    more = len(missing) - MOST_COMPLAINTS
    for text in missing[:MOST_COMPLAINTS] + [f"{more} more without a prediction"] * (more > 0):
        complain(f"microslip predict: {text}")
    converged = all(isinstance(one, Prediction) and one.converged for one in answers)
    return Answer(rows, table_text(cases, answers), converged)


def _points(axes: Mapping[str, tuple[str, str, list[float]]]) -> list[dict[str, float]]:
    """Values of the axes at each point of a grid, in SI units."""
    from itertools import product

    values = product(*(one for _, _, one in axes.values()))
    return [dict(zip(axes, point, strict=True)) for point in values]


def _reshaped(texts: list[str], shape: tuple[int, ...]) -> Any:
    import numpy as np

    assert math.prod(shape) == len(texts)
    return np.reshape(texts, shape)


def problem_text(
    error: InputError | str, columns: Collection[str] = (), map_: str | None = None
) -> str:
    """Format a contact's error message, with columns and options in place of Python arguments.

    For an empty cell or a missing column, the message contains no value.  map_: value of --map.
    """
    if not isinstance(error, InputError):
        return format_as_options(error)
    others = [name for name in INPUTS if name not in columns]
    name = error.argument if error.argument in columns else option(error.argument)
    wrong = map_ if error.argument == "map" else error.value
    value = "" if wrong is None else f" = {shown(wrong)}"
    allowed = format_as_options(error.allowed, others)
    return " ".join(f"{name}{value}: {allowed}".split())
