"""The command `microslip fold`: one period of a motion from a long record."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

import numpy as np

from microslip.app.option_parser import StoreSpelling
from microslip.app.question import (
    FILE_FORMAT,
    Answer,
    add_answer,
    add_options,
    refuse_output,
    typed_options,
    write_output,
)
from microslip.foundation.errors import InputError
from microslip.foundation.number_text import number_text

if TYPE_CHECKING:
    from microslip.si.fold import Fold

OPTIONS = {
    "output": ("FILE", "CSV file for the period, which is then the motion file:FILE"),
    "frequency": (
        "F",
        "approximate frequency of the motion, such as '200 Hz', to be refined (that of the "
        "strongest component)",
    ),
    "rows": (
        "N",
        "number of samples of the period, an even number (32).  More samples keep more harmonics, "
        "and more noise",
    ),
    **FILE_FORMAT,
}
"""Options, each with a metavar and a help text."""


def fill(parser: argparse.ArgumentParser) -> None:
    """Add the description and the arguments of `fold` to its parser."""
    parser.description = (
        "One period of a motion from a record of many periods, such as that of a laser vibrometer. "
        "The slow drift is removed, and the periods are averaged.  The standard error covers the "
        "scatter between the periods and a slow drift of the frequency.  The columns of the record "
        "are time and one or more of forward, lateral, angle, and load or indentation, each with "
        "its unit, as in time [s],lateral [um]."
    )
    parser.add_argument("record", action=StoreSpelling, metavar="CSV", help="the record")
    add_options(parser, OPTIONS, required=("output",))
    add_answer(parser, _answer)


def _answer(options: argparse.Namespace) -> Answer:
    from microslip.si.fold import ROWS, fold
    from microslip.si.inputs import INPUTS, read_quantity
    from microslip.si.strokes import read_record

    arguments = typed_options(options, wholes=("rows",))
    refuse_output(options.output, options.record, (".csv",))
    rows, frequency = arguments.get("rows", ROWS), None
    if "frequency" in arguments:
        frequency = read_quantity("frequency", arguments["frequency"], INPUTS["frequency"]).si
    form = {name: arguments[name] for name in FILE_FORMAT if name in arguments}
    time, columns, units = read_record(options.record, **form)
    try:
        result = fold(time, columns, frequency=frequency, rows=rows)
    except InputError as error:
        if error.argument in ("rows", "frequency"):
            raise
        problem = str(error)
        if error.argument in units and isinstance(error.value, float):
            value = f"{error.value:.9g} {units[error.argument]}"
            problem = f"{error.argument} = {value}: {error.allowed}"
        raise InputError("record", options.record, problem) from None
    text = _as_csv(result, units)
    write_output(options.output, {".csv": lambda file: file.write_text(text, encoding="utf-8")})
    plain = {
        "frequency_Hz": result.frequency,
        "frequency_error_Hz": result.frequency_error,
        "periods": result.periods,
        "columns": {
            name: {
                "unit": units[name],
                "peak_to_peak": result.peak_to_peak(name)[0],
                "peak_to_peak_error": result.peak_to_peak(name)[1],
                "sample_error": float(np.max(result.errors[name])),
                "drift_per_second": result.drift[name],
            }
            for name in result.columns
        },
        "output": options.output,
    }
    return Answer(plain, _as_text(result, units, options.output), complete=True)


def _as_text(result: Fold, units: dict[str, str], output: str) -> str:
    frequency = number_text(result.frequency, result.frequency_error, "Hz")
    lines = [f"frequency    {frequency}", f"periods      {result.periods}"]
    for name in result.columns:
        unit, error = units[name], float(np.max(result.errors[name]))
        size = number_text(*result.peak_to_peak(name), unit)
        drift = f"{result.drift[name]:.3g} {unit}/s"
        lines.append(f"{name:<12} {size} from peak to peak, drift {drift}")
        lines.append(f"{'':<12} standard error of a sample {error:.2g} {unit}")
    return "\n".join([*lines, f"written to   {output}: the motion file:{output}"])


def _as_csv(result: Fold, units: dict[str, str]) -> str:
    """Return the content of the output file."""
    columns = {"time": result.time} | result.columns
    heading = ",".join(f"{name} [{units[name]}]" for name in columns)
    errors = ", ".join(f"{n} {np.max(e):.2g} {units[n]}" for n, e in result.errors.items())
    lines = [
        f"# mean of {result.periods} periods; standard error of a sample: {errors}",
        heading,
        *(",".join(f"{x:.9g}" for x in row) for row in zip(*columns.values(), strict=True)),
    ]
    return "\n".join(lines) + "\n"
