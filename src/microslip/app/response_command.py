"""The command `microslip response`: forces of a contact that follows the path in a file."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

import numpy as np

from microslip.app.option_parser import StoreSpelling
from microslip.app.predict_command import GROUPS
from microslip.app.progress import elapsed_time
from microslip.app.question import (
    FILE_FORMAT,
    Answer,
    add_answer,
    add_options,
    dataset_writers,
    heading,
    refuse_output,
    short_csv,
    typed_options,
    write_output,
)
from microslip.foundation import spec

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from microslip.adaptive.response import Response
    from microslip.si.response import RealResponse

OUTPUT = {
    "output": ("FILE", "write all columns to a .csv or .nc file instead of printing them"),
    "tolerance": (
        "T",
        "largest error of a force divided by mu times the load, and of the torque divided by its "
        "value at full slip (1e-3)",
    ),
    **FILE_FORMAT,
}
LOAD = {"load": ("F", "normal load of the reference state, such as '10 N'")}
ROUNDING = 1e-9
"""A force is printed as 0 if its absolute value, divided by the error estimate, is at most this
number."""
ERRORS = {
    "force_forward": "force_error",
    "force_lateral": "force_error",
    "torque": "torque_error",
}
"""Columns with the error estimates of the forces and the torque."""
PLAIN = dict.fromkeys(("forward", "lateral", "angle", "load", "indentation"), "")
"""Columns of a dimensionless path."""
WITHOUT_CONTACT = {"nu", "pressure", *OUTPUT}
"""Options that are also allowed without a contact in SI units."""


def fill(parser: argparse.ArgumentParser) -> None:
    """Add the description and the arguments of `response` to its parser."""
    parser.description = (
        "Forces, torque, dissipated energy and stick fraction of a contact that follows a path, "
        "with error estimates.  The columns of the file are forward, lateral, angle, and load or "
        "indentation.  With units in the heading, as in forward [um], the options describe the "
        "contact as for `microslip predict`.  Without units and without a contact all numbers are "
        "dimensionless: displacements are divided by u_lim, angles by u_lim / a, loads and "
        "indentations by those of the reference state."
    )
    parser.add_argument("path", action=StoreSpelling, metavar="CSV", help="the path")
    bodies = parser.add_argument_group("bodies")
    add_options(bodies, GROUPS["bodies"] | LOAD)
    output = parser.add_argument_group("output")
    add_options(output, OUTPUT)
    add_answer(parser, _answer, output)


def _answer(options: argparse.Namespace) -> Answer:
    arguments = typed_options(options, reals=("tolerance",))
    refuse_output(options.output, options.path)
    real = arguments.keys() - WITHOUT_CONTACT
    with elapsed_time("microslip response"):
        answer = (_real if real else _dimensionless)(options.path, arguments)
    dataset = answer.to_xarray()
    texts = [] if answer.converged else [f"# NOT CONVERGED: {answer.reason}"]
    if options.output is not None:
        write_output(options.output, dataset_writers(dataset, lambda: _frame(dataset), index=False))
    else:
        texts.append(short_csv(_frame(_without_rounding(dataset))))
    plain = {name: values.tolist() for name, (_, values) in answer.columns.items()}
    plain |= answer.attributes | {"converged": answer.converged}
    return Answer(plain, "\n".join(texts), answer.converged)


def _real(path: str, arguments: dict[str, Any]) -> RealResponse:
    from microslip.si.response import predict_response

    return predict_response(path, **arguments)


def _dimensionless(path: str, arguments: dict[str, Any]) -> Response:
    from microslip.si.response import read_path, response_to

    file = {name: arguments.pop(name) for name in FILE_FORMAT if name in arguments}
    if "nu" in arguments:
        arguments["poisson"] = spec.read("nu", arguments.pop("nu"))
    return response_to(path, read_path(path, PLAIN, **file), {}, **arguments)


def _without_rounding(dataset: xr.Dataset) -> xr.Dataset:
    """Replace the forces that are only rounding errors by 0."""
    forces = {}
    for name, error in ERRORS.items():
        least = ROUNDING * np.abs(dataset[error])
        forces[name] = dataset[name].where(np.abs(dataset[name]) > least, 0.0)
    return dataset.assign(forces)


def _frame(dataset: xr.Dataset) -> pd.DataFrame:
    """Return the columns of a response."""
    headings = {name: heading(str(name), one.attrs["units"]) for name, one in dataset.items()}
    return dataset.to_dataframe().rename(columns=headings)
