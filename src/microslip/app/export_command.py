"""The command `microslip export`: models of a contact for other programs."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

from microslip.app.option_parser import StoreSpelling
from microslip.app.predict_command import GROUPS, problem_text
from microslip.app.progress import elapsed_time
from microslip.app.question import (
    Answer,
    add_answer,
    add_options,
    heading,
    refuse_output,
    short_csv,
    typed_options,
    write_output,
)
from microslip.app.response_command import LOAD
from microslip.app.terminal import complain
from microslip.foundation import spec
from microslip.foundation.errors import InputError

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

IWAN_OPTIONS = {
    "elements": ("N", "number of elements"),
    "tolerance": (
        "T",
        "in place of --elements: largest error due to the finite number of elements, divided by mu "
        "times the load (1e-3)",
    ),
    "output": ("FILE", "write a .csv file"),
}
TABLE_OPTIONS = {
    "tolerance": ("T", "largest accepted absolute error of mu_macro (1e-3)"),
    "map": GROUPS["output"]["map"],
    "output": ("FILE", "write a .csv file"),
}
NO_FRICTION = ("force", "reduction")
"""Options of predict that are left out, because their answer is not the friction."""
WITHOUT_CONTACT = {"nu", "pressure", *IWAN_OPTIONS}
"""Options that are also allowed without a contact in SI units."""
COLUMNS = {
    "mu_apparent": "coefficient of friction with vibration",
    "mu_apparent_error": "error estimate of mu_apparent",
    "friction_force_N": "mean friction force",
    "friction_force_error_N": "error estimate of the friction force",
}
"""Long name of each column in a friction table."""


def fill(parser: argparse.ArgumentParser) -> None:
    """Add the description and the arguments of `export` to its parser."""
    parser.description = "A model of a contact as a table, with its error."
    models = parser.add_subparsers(dest="export", required=True, metavar="MODEL")
    iwan = models.add_parser(
        "iwan",
        help="an Iwan model: parallel springs with sliders",
        description="An Iwan model of a contact that moves along a line: the stiffness and the "
        "limit force of parallel Jenkins elements, each a spring in series with a slider.  At "
        "nu = 0 the model with many elements is exact for every load path.  At nu > 0 it is "
        "compared with the full contact, and the difference is part of the error.  Without a "
        "contact, forces are divided by mu times the load, and displacements by u_lim.",
    )
    bodies = iwan.add_argument_group("bodies")
    add_options(bodies, GROUPS["bodies"] | LOAD)
    add_options(iwan, IWAN_OPTIONS)
    add_answer(iwan, _iwan)
    table = models.add_parser(
        "table",
        help="a table of friction over speed, amplitude, load or other quantities",
        description="Friction over the ranges of one or more quantities, such as --speed '0.1..10 "
        "mm/s, 21, log': 21 values in equal ratios.  '0..2 um' has 11 values in equal steps.",
    )
    text = "motion, as for `microslip predict`"
    table.add_argument("motion", action=StoreSpelling, metavar="MOTION", help=text)
    for title in ("bodies", "load", "motion", "drive"):
        options = {name: one for name, one in GROUPS[title].items() if name not in NO_FRICTION}
        add_options(table.add_argument_group(title), options)
    add_options(table, TABLE_OPTIONS)
    add_answer(table, _table)


def _iwan(options: argparse.Namespace) -> Answer:
    import pandas as pd

    from microslip.answer.iwan import iwan
    from microslip.si.iwan import predict_iwan

    refuse_output(options.output, endings=(".csv",))
    arguments = typed_options(options, ("tolerance",), ("elements",))
    real = arguments.keys() - WITHOUT_CONTACT
    with elapsed_time("microslip export iwan"):
        if real:
            model, force, stiffness = predict_iwan(**arguments), "N", "N/m"
        else:
            if "nu" in arguments:
                arguments["poisson"] = spec.read("nu", arguments.pop("nu"))
            model, force, stiffness = iwan(**arguments), "1", "1"
    unit = " N" if real else ""
    comments = [
        "Iwan model: parallel springs (stiffness), each in series with a slider (limit_force)",
        f"error of the force on a first loading and on loops between two displacements: "
        f"{model.error:.3g}{unit}",
        f"error of the force on any path: {model.error_on_any_path:.3g}{unit}",
    ]
    if not real:
        comments.append("forces are divided by mu times the load, displacements by u_lim")
    units = {"stiffness": stiffness, "limit_force": force, "force_error": force}
    frame = pd.DataFrame({heading(name, one): getattr(model, name) for name, one in units.items()})
    plain = {name: getattr(model, name).tolist() for name in units}
    plain |= {"error": model.error, "error_on_any_path": model.error_on_any_path}
    return _answer(options, plain, frame, comments)


def _table(options: argparse.Namespace) -> Answer:
    from tqdm import tqdm

    from microslip.si.output import Prediction
    from microslip.si.table import dataset_of, grid_of, interpolation_errors, predictions

    refuse_output(options.output, endings=(".csv",))
    if options.speed is None:
        raise InputError("speed", None, "needed")
    if options.mass is not None and options.drive_stiffness is None:
        raise InputError("mass", options.mass, "allowed only with a drive_stiffness")
    grid = grid_of(options.motion, typed_options(options))
    lazy = predictions(grid, need_all=True)
    points = list(product(*(values for _, _, values in grid.axes.values())))
    answers = list(tqdm(lazy, "points", len(points), leave=False, disable=None))
    for point, one in zip(points, answers, strict=True):
        if not (isinstance(one, Prediction) and one.converged):
            where = ", ".join(f"{name} = {x:.4g}" for name, x in zip(grid.axes, point, strict=True))
            reason = (
                one.reason if isinstance(one, Prediction) else problem_text(one, map_=options.map)
            )
            complain(f"microslip export table: not converged at {where}: {reason}; no table")
            return Answer({"converged": False}, "", False)
    dataset = _friction_table(dataset_of(grid, answers))
    errors = [float(dataset[f"{name}_error"].max()) for name in ("mu_apparent", "friction_force")]
    comments = [
        f"friction of a contact, motion {options.motion}, from microslip predict",
        f"largest errors of the values: {errors[0]:.2g} of mu_apparent, {errors[1]:.2g} N",
        _interpolation_text(interpolation_errors(dataset.mu_apparent)),
    ]
    frame = dataset.to_dataframe().reset_index()
    plain = frame.to_dict("records")
    frame.columns = [heading(name, dataset[name].attrs["units"]) for name in frame.columns]
    return _answer(options, plain, frame, comments)


def _interpolation_text(errors: Mapping[str, float | None]) -> str:
    """Describe the differences from linear interpolation along each axis."""
    largest = [f"{one:.2g} along {name}" for name, one in errors.items() if one is not None]
    short = [name for name, one in errors.items() if one is None]
    texts = [f"up to {', '.join(largest)}"] if largest else []
    if short:
        texts.append(f"cannot be computed along {', '.join(short)} with fewer than 3 values")
    subject = "difference of mu_apparent from the linear interpolation of the neighbouring values"
    return f"{subject}: {'; '.join(texts)}"


def _friction_table(dataset: xr.Dataset) -> xr.Dataset:
    """Return the columns of a friction table.  Each axis is named after its argument."""
    table = dataset[list(COLUMNS)]
    for name, text in COLUMNS.items():
        table[name].attrs["long_name"] = text
    names = {axis: dataset[axis].attrs["long_name"].replace(" ", "_") for axis in dataset.dims}
    return table.rename({name: name.removesuffix("_N") for name in COLUMNS} | names)


def _answer(
    options: argparse.Namespace,
    plain: Any,
    frame: pd.DataFrame,
    comments: Sequence[str],
) -> Answer:
    """Write the --output file, or print the table as CSV with six digits."""
    if options.output is None:
        texts = [*(f"# {one}" for one in comments), short_csv(frame)]
        return Answer(plain, "\n".join(texts), True)

    def write_csv(file: Path) -> None:
        with file.open("w", encoding="utf-8", newline="\n") as stream:
            stream.writelines(f"# {one}\n" for one in comments)
            frame.to_csv(stream, index=False, lineterminator="\n")

    write_output(options.output, {".csv": write_csv})
    return Answer(plain, "\n".join(comments), True)
