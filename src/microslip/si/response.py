"""Forces in a real contact along a measured path.

The path is a table of columns with units:

forward [um],lateral [um],load [N]
0,0,10
0.2,0.1,11
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any

import numpy as np

from microslip.answer.answer import Answer
from microslip.foundation.csv_table import LABELS, source_name, table_of
from microslip.foundation.errors import InputError, shown
from microslip.scene.files import UNITS
from microslip.si.contact import Contact, contact_of
from microslip.si.inputs import Input, read_inputs, read_quantity
from microslip.si.output import column
from microslip.si.strokes import scales
from microslip.theory.masing import Iwan

COLUMNS = {
    **{"force_forward": "N", "force_lateral": "N", "torque": "N m"},
    **{"force_error": "N", "torque_error": "N m"},
    **{"dissipated_energy": "J", "dissipated_energy_error": "J", "stick_fraction": "1"},
}
"""SI units of the columns of `microslip.response`."""


class RealResponse(Answer):
    """Forces of a real contact along a path, in SI units.  Each row is a point of the path.

    The columns in COLUMNS are also attributes of the response, with the unit at the end of the
    name, as in `force_forward_N`.  The items of the dictionary `attributes` are also attributes of
    the response.

    Attributes
    ----------
    path : dict of str to np.ndarray
        Columns of the path in SI units, keyed by name.
    columns : dict of str to tuple
        Unit and values of every column, keyed by name: the columns of the path, and the columns of
        `microslip.response` in SI units.
    attributes : dict
        Attributes of the dataset: u_lim_m, the displacement at which the whole contact slides (m);
        contact_radius_m; load_N, the load of the reference state; mu; tolerance, the largest
        accepted error of a force, relative to mu times the load; reason, the reason why the
        response is not converged; converged, 0 or 1.
    converged : bool
        True if every error of a force or a torque is within the tolerance.
    """

    def to_xarray(self) -> Any:
        """Return the columns, with units, as an xarray.Dataset whose dimension is `row`."""
        return import_module("microslip.datasets.of_records").to_xarray(self)

    def __str__(self) -> str:
        """Return the lines that `microslip response` prints."""
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
    """Compute the forces in a contact of two bodies along a measured path.  The forces are in SI
    units.

    Parameters
    ----------
    path : path of a CSV file, mapping or pandas DataFrame
        Columns `forward`, `lateral`, `angle`, and `load` or `indentation`, with units as in
        "forward [um]".  Columns without a unit are in SI units.
    tolerance : float
        Largest accepted relative error of the forces and the torque.  Force errors are divided by
        mu times the load, torque errors by the torque at full slip.
    decimal, encoding : str
        Decimal mark and encoding of a CSV file.
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
        If an argument or a column is invalid.  The message contains its name.
    """
    real = only_contact(contact)
    columns = read_path(path, decimal=decimal, encoding=encoding)
    from microslip.answer.along import response  # late, to refuse invalid input fast

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
    places = {name: (UNITS[name], one) for name, one in columns.items()}
    attributes = {
        **{"u_lim_m": real.u_lim, "contact_radius_m": real.contact_radius},
        **{"load_N": real.load, "mu": real.mu, "tolerance": answer.tolerance},
        **{"reason": answer.reason, "converged": int(answer.converged)},
    }
    values = {column(name, unit.strip("1")): one for name, (unit, one) in forces.items()}
    values |= attributes | {"path": columns, "columns": places | forces, "attributes": attributes}
    return RealResponse(answer.problem, values, reason=answer.reason)


def only_contact(contact: Mapping[str, object]) -> Contact:
    """Return the contact for inputs of the groups "bodies" and "load".  Raises InputError."""
    return contact_of(read_inputs(None, **contact))


def read_path(path: Any, **form: str) -> dict[str, np.ndarray]:
    """Read the columns of a path, in SI units.

    form: decimal mark and encoding of a CSV file.  Raises InputError if a column or a line cannot
    be read.  An invalid line cannot be skipped, since the path would then have a gap.
    """
    table = table_of("path", path, UNITS, need_units=True, **form)
    cells = {name: one for name, one in table.columns.items() if name not in LABELS}
    problem, columns = next(iter(table.errors.values()), ""), {}
    if not cells or not cells.keys() <= UNITS.keys():
        problem = f"columns {', '.join(cells)!r}; allowed are some of {', '.join(UNITS)}"
    for name, texts in cells.items() if not problem else ():
        number = Input("", UNITS[name], "", -math.inf, exact=True)
        columns[name] = np.empty(len(texts))
        for row, cell in enumerate(texts):
            try:
                columns[name][row] = read_quantity(name, cell, number).si
            except InputError as error:
                line = table.lines[row] if table.lines else 1 + row
                about = "empty" if cell is None else f"{cell!r}: {error.allowed}"
                problem = problem or f"line {line}: {name} is {about}"
    if problem:
        raise InputError("path", source_name(path), problem)
    return {"forward": np.zeros(len(table.cells[name]))} | columns


def predict_iwan(
    *, elements: int | None = None, tolerance: float | None = None, **contact: object
) -> Iwan:
    """Compute an Iwan model of a contact of two bodies: springs with sliders, connected in
    parallel, with stiffnesses and forces in SI units.

    Parameters
    ----------
    elements : int or None
        Number of elements.
    tolerance : float or None
        Largest accepted error due to the number of elements, divided by mu times the load (default
        1e-3).  Give either `tolerance` or `elements`.
    **contact : quantity
        mu, load, radius, material and the other arguments of `microslip.predict` that describe a
        contact.

    Returns
    -------
    Iwan
        The elements, with stiffnesses in N/m and forces in N.

    Raises
    ------
    InputError
        If an argument is invalid.  The message contains its name.
    """
    real = only_contact(contact)
    from microslip.answer.along import iwan  # late, to refuse invalid input fast

    try:
        model = iwan(real.pressure, poisson=real.poisson, elements=elements, tolerance=tolerance)
    except InputError as error:
        if error.argument != "pressure" or real.inputs.radius_across is None:
            raise
        allowed = "allowed only if nu = 0, because the contact is an ellipse"
        raise real.inputs.error("radius_across", allowed) from None
    return model.scaled(real.mu * real.load, real.u_lim)
