"""Forces of a real contact that follows a measured path.

The path is a table of columns with units:

forward [um],lateral [um],load [N]
0,0,10
0.2,0.1,11
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any

import numpy as np

from microslip.answer.along import response
from microslip.foundation.csv_table import LABELS, source_name, table_of
from microslip.foundation.errors import InputError, shown
from microslip.scene.files import UNITS
from microslip.si.contact import Contact, contact_of
from microslip.si.inputs import Input, read_inputs, read_quantity
from microslip.si.output import column
from microslip.si.strokes import factors, scales

COLUMNS = {
    **{"force_forward": "N", "force_lateral": "N", "torque": "N m"},
    **{"force_error": "N", "torque_error": "N m"},
    **{"dissipated_energy": "J", "dissipated_energy_error": "J", "stick_fraction": "1"},
}
"""SI units of the columns of `microslip.response`."""


@dataclass(frozen=True, eq=False)
class RealResponse:
    """Forces of a real contact along a path, in SI units.  Each row is a point of the path.

    The columns of COLUMNS, with the unit in the name (force_forward_N), and the names in
    `attributes` are attributes of the response, too.

    Attributes
    ----------
    path : dict of str to np.ndarray
        Columns of the path in SI units, by name.
    columns : dict of str to tuple
        Unit and values of every column, by name: those of the path, and those of
        `microslip.response` in SI units.
    attributes : dict
        Attributes of the dataset: u_lim_m, the displacement at which the whole contact slides (m);
        contact_radius_m; load_N, the load of the reference state; mu; tolerance, the largest
        accepted error of a force, relative to mu times the load; reason, why the response is not
        converged; converged, 0 or 1.
    converged : bool
        Whether every error is within the tolerance.
    """

    path: dict[str, np.ndarray]
    columns: dict[str, tuple[str, np.ndarray]] = field(repr=False)
    attributes: dict[str, Any]
    converged: bool

    def __getattr__(self, name: str) -> Any:
        for one, unit in COLUMNS.items():
            if name == column(one, unit.strip("1")):
                return self.columns[one][1]
        if name in self.__dict__.get("attributes", {}):
            return self.attributes[name]
        raise AttributeError(name)

    def to_xarray(self) -> Any:
        """The columns as an xarray.Dataset over `row`, with units."""
        return import_module("microslip.datasets.of_records").to_xarray(self)

    def __str__(self) -> str:
        """The lines that `microslip response` prints."""
        return str(import_module("microslip.datasets.of_records").response_text(self))


def predict_response(
    path: Any,
    *,
    tolerance: float = 1e-3,
    decimal: str = ".",
    encoding: str = "utf-8",
    progress: Callable[[int, int], None] | None = None,
    **contact: object,
) -> RealResponse:
    """Forces of a contact of two bodies that follows a measured path, in SI units.

    Parameters
    ----------
    path : path of a CSV file, mapping or pandas DataFrame
        Columns `forward`, `lateral`, `angle`, and `load` or `indentation`, with units as in
        "forward [um]".  Columns without a unit are in SI units.
    tolerance : float
        Largest accepted relative error of the forces and the torque.  Force errors are divided by
        mu times the load, torque errors by the torque at full slip.
    decimal, encoding : str
        Decimal mark and encoding of a file.
    progress : callable or None
        Progress callback; see `microslip.response`.
    **contact : quantity
        mu, load, radius, material and the other arguments of `microslip.predict` that describe a
        contact.  `load` is the load of the reference state.

    Returns
    -------
    RealResponse

    Raises
    ------
    InputError
        If an argument or a column is invalid.  The message names it.
    """
    real = only_contact(contact)
    columns = read_path(path, decimal=decimal, encoding=encoding)
    units = scales(real, columns)
    body: Any = {"pressure": real.pressure, "poisson": real.poisson}
    try:
        over: Any = {name: one / units[name] for name, one in columns.items()}
        answer = response(**over, **body, tolerance=tolerance, progress=progress)
    except InputError as error:
        name, value = error.argument, error.value
        if name not in UNITS:
            raise
        text = shown(value)
        if isinstance(value, float):
            si, unit = units[name], UNITS[name]
            text = f"{value * si:.6g} {unit} ({value:.6g} times {si:.6g} {unit})"
        raise InputError("path", source_name(path), f"{name} = {text}: {error.allowed}") from None
    force = real.mu * real.load
    torque = force * real.contact_radius * answer.problem.pressure.torque
    sizes = {"N": force, "N m": torque, "J": force * real.u_lim, "1": 1.0}
    forces = {n: (COLUMNS[n], sizes[COLUMNS[n]] * x) for n, (_, x) in answer.columns.items()}
    attributes = {
        **{"u_lim_m": real.u_lim, "contact_radius_m": real.contact_radius},
        **{"load_N": real.load, "mu": real.mu, "tolerance": answer.tolerance},
        **{"reason": answer.reason, "converged": int(answer.converged)},
    }
    places = {name: (UNITS[name], one) for name, one in columns.items()}
    return RealResponse(columns, places | forces, attributes, answer.converged)


def only_contact(contact: Mapping[str, object]) -> Contact:
    """The contact of inputs of the groups "bodies" and "load".  Raises InputError."""
    return contact_of(read_inputs(None, **contact))


def read_path(path: Any, **form: str) -> dict[str, np.ndarray]:
    """Columns of a path in SI units.

    form: decimal mark and encoding of a file.  Raises InputError if a column or a line cannot be
    read.  Lines cannot be skipped, since a path has no gaps.
    """
    table = table_of("path", path, UNITS, need_units=True, **form)
    names = [name for name in table.cells if name not in LABELS]
    columns: dict[str, Any] = {}
    try:
        for problem in table.errors.values():
            raise ValueError(problem)
        if not names or not set(names) <= UNITS.keys():
            raise ValueError(
                f"columns {', '.join(names)!r}; allowed are some of {', '.join(UNITS)}"
            )
        sizes = factors({name: table.units[name] for name in names})
        for name in names:
            unit = UNITS[name] if table.units[name] is None else ""
            number = Input("", unit, "", -math.inf, exact=True)
            lines = table.lines or range(1, 1 + len(table.cells[name]))
            cells = zip(lines, table.cells[name], strict=True)
            columns[name] = sizes[name] * np.array([_number(k, name, c, number) for k, c in cells])
    except ValueError as error:
        if isinstance(error, InputError):
            raise
        raise InputError("path", source_name(path), str(error)) from None
    return {"forward": np.zeros(len(table.cells[name]))} | columns


def _number(line: int, name: str, cell: object, form: Input) -> float:
    """The value of a cell.  Raises ValueError with the line number."""
    try:
        return read_quantity(name, cell, form).si
    except InputError as error:
        problem = "empty" if cell is None else f"{cell!r}: {error.allowed}"
        raise ValueError(f"line {line}: {name} is {problem}") from None
