"""Options, error messages and output of the commands that print one answer."""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from microslip.app.option_parser import StoreSpelling, format_as_options, option
from microslip.app.terminal import complain
from microslip.foundation import extras, spec
from microslip.foundation.errors import CacheError, InputError, shown

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

ENDINGS = (".csv", ".nc")
"""File extensions of output files."""
FIGURES = (".png", ".pdf")
"""File extensions of figures."""
FILES = ("output", "figure", "table")
"""Options for files that the commands themselves read and write."""
FILE_FORMAT = {
    "decimal": ("MARK", "decimal mark of the file, a point or a comma (.)"),
    "encoding": ("NAME", "encoding of the file, such as cp1252 (utf-8)"),
}
"""Options that describe the format of a CSV file."""
OTHER_NAMES = {"nu": ("--poisson",), "poisson": ("--nu",)}
"""Alternative names of options."""
SPIN = "Bore means spin: rotation about the contact normal."
"""Remark in help texts."""


class Answer(NamedTuple):
    """The answer of a command.

    Attributes
    ----------
    plain : object
        The answer as JSON values.
    text : str
        The answer as text.
    complete : bool
        True for exit code 0.
    """

    plain: Any
    text: str
    complete: bool


def add_options(
    parser: Any, options: Mapping[str, tuple[str, str]], required: Iterable[str] = ()
) -> None:
    """Add options that take a value to a parser or a group.

    options: metavar and help text of each option, by name.
    """
    for name, (metavar, text) in options.items():
        parser.add_argument(
            *(f"--{name}", *OTHER_NAMES.get(name, ())),
            dest=name.replace("-", "_"),
            action=StoreSpelling,
            metavar=metavar,
            help=text,
            required=name in required,
        )


def add_answer(
    parser: argparse.ArgumentParser,
    answer: Callable[[argparse.Namespace], Answer],
    group: Any = None,
) -> None:
    """Add the option `--json` to a parser or its group, and store what `respond` needs.

    answer: function that computes the answer from the parsed command line.
    """
    text = "print one JSON object and nothing else"
    (group or parser).add_argument("--json", action="store_true", help=text)
    parser.set_defaults(answer=answer, command=parser.prog, spellings={})


def typed_options(
    options: argparse.Namespace, reals: Iterable[str] = (), wholes: Iterable[str] = ()
) -> dict[str, Any]:
    """Return the values of the options on the command line, by argument name.

    The options in `reals` and `wholes` are converted to numbers, and the dataset of --map is
    opened.  The options in FILES are left out.  Raises InputError for a text that is not a
    number, and InputError and CacheError for a map that cannot be opened.
    """
    words = {name: word for name, word in options.spellings.items() if name not in FILES}
    typed = {name: getattr(options, name) for name, word in words.items() if word.startswith("--")}
    for name, text in typed.items():
        if name in reals or name in wholes:
            typed[name] = spec.read(name, text, whole=name in wholes)
        elif name == "map":
            typed[name] = _opened_map(text)
    return typed


def respond(options: argparse.Namespace) -> int:
    """Print the answer to a parsed command line, or an error message.

    Returns the exit code: 0 if the answer is complete, 1 if not, 2 for bad input.
    """
    try:
        result = options.answer(options)
    except InputError as error:
        name, value = option(error.argument), error.value
        if error.argument in options.spellings:
            name, value = options.spellings[error.argument], getattr(options, error.argument)
        text = "" if value is None or value is True else f" = {shown(value)}"
        allowed = format_as_options(
            error.allowed, () if error.argument == "table" else vars(options)
        )
        complain(f"{options.command}: {name}{text}: {allowed}")
        return 2
    except CacheError as error:
        complain(f"{options.command}: {error}")
        return 2
    text = result.text
    if options.json:
        from microslip.sweeps.evaluate import plain

        text = json.dumps(plain(result.plain))
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    # The encoding may lack characters that units use.
    if text:
        print(text.encode(encoding, "backslashreplace").decode(encoding))
    return 0 if result.complete else 1


def refuse_output(
    path: str | None,
    table: str | None = None,
    endings: tuple[str, ...] = ENDINGS,
    argument: str = "output",
) -> None:
    """Raise InputError if the output file cannot be written, or if it is the input table."""
    if path is None:
        return
    file, allowed = Path(path), ""
    if file.suffix.lower() not in endings:
        allowed = f"a name that ends in {' or '.join(endings)}"
    elif file.is_dir() or not (file.parent.is_dir() and os.access(file.parent, os.W_OK)):
        allowed = "a file in a folder that can be written to"
    elif table is not None and file.resolve() == Path(table).resolve():
        allowed = "another file than the table that is read"
    if allowed:
        raise InputError(argument, path, f"allowed is {allowed}")


def refuse_figure(path: str | None) -> None:
    """Raise InputError if the figure cannot be written, or if matplotlib is missing."""
    refuse_output(path, endings=FIGURES, argument="figure")
    if path is not None and (hint := extras.missing("matplotlib")):
        raise InputError("figure", path, hint)


def _opened_map(path: str) -> xr.Dataset:
    """Open the dataset of the option --map, which is a .nc file or the name of a sweep.

    Raises InputError and CacheError.
    """
    from microslip.datasets.open_map import open_map

    try:
        return open_map(Path(path)) if path.endswith(".nc") else open_map(path)
    except InputError as error:
        raise error.renamed("map") from None
    except CacheError as error:
        raise CacheError(f"--map: {error}") from None


def write_output(path: str, writers: Mapping[str, Callable[[Path], object]]) -> None:
    """Write a file atomically.  The file extension selects the writer.

    Raises InputError if the file cannot be written.
    """
    from microslip.foundation.files import writing_beside

    try:
        with writing_beside(Path(path)) as beside:
            writers[Path(path).suffix.lower()](beside)
    except (OSError, CacheError) as error:
        raise InputError("output", path, f"cannot be written: {error}") from None


def heading(name: str, unit: str) -> str:
    """Return the heading of a column.  A unit other than 1 is in brackets."""
    return name if unit == "1" else f"{name} [{unit}]"


def short_csv(frame: pd.DataFrame) -> str:
    """Format a table as CSV with six digits."""
    return frame.to_csv(index=False, float_format="%.6g", lineterminator="\n").rstrip("\n")


def dataset_writers(
    dataset: xr.Dataset, frame: Callable[[], pd.DataFrame], **to_csv: Any
) -> dict[str, Callable[[Path], object]]:
    """Return writers for a dataset: a .csv writer for the table that `frame` returns, and a .nc
    writer."""
    return {
        ".csv": lambda file: frame().to_csv(file, **to_csv),
        ".nc": lambda file: dataset.to_netcdf(file, engine="netcdf4"),
    }


def write_files(options: argparse.Namespace, figure: str, dataset: xr.Dataset) -> None:
    """Write the --output and --figure files of a dataset.

    figure: name of the figure in report.figures.drawing.  Raises InputError.
    """
    if options.output is not None:
        write_output(options.output, dataset_writers(dataset, dataset.to_dataframe))
    if options.figure is not None:
        from microslip.report.figures.drawing import draw, save

        save(draw(figure, {figure: dataset}), options.figure)
