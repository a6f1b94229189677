"""The command `microslip response`: forces of a contact that follows the path in a file."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from microslip.app.option_parser import StoreSpelling
from microslip.app.predict_command import GROUPS
from microslip.app.progress import elapsed_time
from microslip.app.question import (
    FILE_FORMAT,
    Answer,
    add_answer,
    add_options,
    dataset_writers,
    refuse_output,
    typed_options,
    write_output,
)
from microslip.foundation import spec

if TYPE_CHECKING:
    from microslip.answer.along import Response
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
    from microslip.datasets.of_records import table  # late, since it imports xarray

    dataset = answer.to_xarray()
    text = str(answer)
    if options.output is not None:
        write_output(options.output, dataset_writers(dataset, lambda: table(dataset), index=False))
        text = "" if answer.converged else text.partition("\n")[0]
    plain = {name: values.tolist() for name, (_, values) in answer.columns.items()}
    plain |= answer.attributes | {"converged": answer.converged}
    return Answer(plain, text, answer.converged)


def _real(path: str, arguments: dict[str, Any]) -> RealResponse:
    from microslip.si.response import predict_response

    return predict_response(path, **arguments)


def _dimensionless(path: str, arguments: dict[str, Any]) -> Response:
    from microslip.si.response import read_path, response_to

    file = {name: arguments.pop(name) for name in FILE_FORMAT if name in arguments}
    if "nu" in arguments:
        arguments["poisson"] = spec.read("nu", arguments.pop("nu"))
    return response_to(path, read_path(path, PLAIN, **file), {}, **arguments)
