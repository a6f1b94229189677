"""Forces of a real contact that follows a measured path.

The path is a table of columns with units:

forward [um],lateral [um],load [N]
0,0,10
0.2,0.1,11
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from importlib import import_module
from typing import Any

import numpy as np

from microslip.answer.along import Response, response
from microslip.foundation import spec
from microslip.foundation.csv_table import LABELS, table_of
from microslip.foundation.errors import InputError, shown
from microslip.si.contact import Contact, contact_of
from microslip.si.inputs import Input, read_inputs, read_quantity
from microslip.si.strokes import UNITS, scales


@dataclass(frozen=True, eq=False)
class RealResponse:
    """Forces of a real contact along a path, in SI units.  Each row is a point of the path.

    Attributes
    ----------
    path : dict of str to np.ndarray
        Columns of the path in SI units, by name.
    force_forward_N, force_lateral_N, torque_N_m : np.ndarray, shape (rows,)
        Forces and torque.  They are positive in the direction of the displacement that they
        resist.
    force_error_N, torque_error_N_m : np.ndarray, shape (rows,)
        Larger error estimate of the two forces, and error estimate of the torque.
    dissipated_energy_J, dissipated_energy_error_J : np.ndarray, shape (rows,)
        Energy dissipated by friction since the first row, and its error estimate.
    stick_fraction : np.ndarray, shape (rows,)
        Fraction of the area in contact that sticks; see microslip.Response.
    u_lim_m, contact_radius_m, load_N, mu : float
        Displacement at which the whole contact slides (m), contact radius (m), load of the
        reference state (N), and coefficient of friction.
    tolerance : float
        Largest accepted error of a force, relative to mu times the load.
    converged : bool
        Whether every error is within the tolerance.
    reason : str
        Why the response is not converged; empty if it is.
    """

    path: dict[str, np.ndarray]
    force_forward_N: np.ndarray
    force_lateral_N: np.ndarray
    torque_N_m: np.ndarray
    force_error_N: np.ndarray
    torque_error_N_m: np.ndarray
    dissipated_energy_J: np.ndarray
    dissipated_energy_error_J: np.ndarray
    stick_fraction: np.ndarray
    u_lim_m: float
    contact_radius_m: float
    load_N: float
    mu: float
    tolerance: float
    converged: bool
    reason: str

    @property
    def columns(self) -> dict[str, tuple[str, np.ndarray]]:
        """Unit and values of every column, by name."""
        path = {name: (UNITS[name], values) for name, values in self.path.items()}
        return path | {
            "force_forward": ("N", self.force_forward_N),
            "force_lateral": ("N", self.force_lateral_N),
            "torque": ("N m", self.torque_N_m),
            "force_error": ("N", self.force_error_N),
            "torque_error": ("N m", self.torque_error_N_m),
            "dissipated_energy": ("J", self.dissipated_energy_J),
            "dissipated_energy_error": ("J", self.dissipated_energy_error_J),
            "stick_fraction": ("1", self.stick_fraction),
        }

    @property
    def attributes(self) -> dict[str, object]:
        """Attributes of the dataset."""
        names = ("u_lim_m", "contact_radius_m", "load_N", "mu", "tolerance", "reason")
        return {name: getattr(self, name) for name in names} | {"converged": int(self.converged)}

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
        contact.  The load is that of the reference state.

    Returns
    -------
    RealResponse

    Raises
    ------
    InputError
        If an argument or a column is invalid.  The message names it.
    """
    real = only_contact(contact)
    columns = read_path(path, UNITS, decimal=decimal, encoding=encoding)
    answer = response_to(
        path,
        columns,
        scales(real, columns),
        pressure=real.pressure,
        poisson=real.poisson,
        tolerance=tolerance,
        progress=progress,
    )
    force = real.mu * real.load
    torque = force * real.contact_radius * answer.problem.pressure.torque
    energy = force * real.u_lim
    return RealResponse(
        path=columns,
        force_forward_N=force * answer.force_forward,
        force_lateral_N=force * answer.force_lateral,
        torque_N_m=torque * answer.torque,
        force_error_N=force * answer.force_error[:, :2].max(axis=1),
        torque_error_N_m=torque * answer.force_error[:, 2],
        dissipated_energy_J=energy * answer.dissipated_energy,
        dissipated_energy_error_J=energy * answer.dissipated_energy_error,
        stick_fraction=answer.stick_fraction,
        u_lim_m=real.u_lim,
        contact_radius_m=real.contact_radius,
        load_N=real.load,
        mu=real.mu,
        tolerance=answer.tolerance,
        converged=answer.converged,
        reason=answer.reason,
    )


def only_contact(contact: Mapping[str, object]) -> Contact:
    """The contact of inputs of the groups "bodies" and "load".  Raises InputError."""
    return contact_of(read_inputs(None, **contact))


def response_to(
    path: Any, columns: dict[str, np.ndarray], scales: Mapping[str, float], **settings: Any
) -> Response:
    """Call `microslip.response` with the columns of a table, each divided by its scale in SI units.
    Error messages refer to the table as `path`, and show SI values.

    scales: empty for a dimensionless table.
    """
    over: dict[str, Any] = {n: one / scales.get(n, 1.0) for n, one in columns.items()}
    try:
        return response(**over, **settings)
    except InputError as error:
        name, value = error.argument, error.value
        if name not in UNITS:
            raise
        text = shown(value)
        if name in scales and isinstance(value, float):
            si, unit = scales[name], UNITS[name]
            text = f"{value * si:.6g} {unit} ({value:.6g} times {si:.6g} {unit})"
        raise InputError("path", named(path), f"{name} = {text}: {error.allowed}") from None


def read_path(
    path: Any, units: dict[str, str], *, decimal: str = ".", encoding: str = "utf-8"
) -> dict[str, np.ndarray]:
    """Columns of a path in SI units.

    Parameters
    ----------
    path : path of a CSV file, mapping or pandas DataFrame
        The table.
    units : dict of str
        SI units of the allowed columns.  The unit of pure numbers is "".
    decimal, encoding : str
        Decimal mark and encoding of a file.

    Raises
    ------
    InputError
        If a column or a line cannot be read.  Lines cannot be skipped, since a path has no gaps.
    """
    form: dict = {"decimal": decimal, "encoding": encoding, "need_units": any(units.values())}
    table = table_of("path", path, units, **form)
    if table.errors:
        raise InputError("path", named(path), next(iter(table.errors.values())))
    columns = {}
    for name, cells in table.columns.items():
        if name in LABELS:
            continue
        if name not in units:
            raise InputError(
                "path", named(path), f"a column {name!r}; allowed are {', '.join(units)}"
            )
        where = table.lines or range(1, len(cells) + 1)
        try:
            numbers = [_number(*one, name, units[name]) for one in zip(where, cells, strict=True)]
        except ValueError as error:
            raise InputError("path", named(path), str(error)) from None
        columns[name] = np.array(numbers)
    if not columns:
        raise InputError("path", named(path), f"allowed are some of {', '.join(units)}")
    return {"forward": np.zeros(len(cells))} | columns


def named(source: Any) -> str | list:
    """Name of a table for messages: the path, or the names of the columns."""
    return str(source) if isinstance(source, str | os.PathLike) else list(source)


def _number(where: int, cell: object, name: str, unit: str) -> float:
    """The value of a cell in the SI unit.  Raises ValueError with the line number."""
    try:
        if isinstance(cell, str):
            number, space, written = cell.partition(" ")
            if space and not unit:
                allowed = "allowed with a contact: --mu, --load, --radius and --material"
                raise ValueError(f"line {where}: {name} is in {written}; {allowed}")
            if space:
                return spec.read(name, number) * _factor(name, written, unit)
        return read_quantity(name, cell, Input("", unit, "", -math.inf, exact=True)).si
    except InputError as error:
        problem = "empty" if cell is None else f"{cell!r}: {error.allowed}"
        raise ValueError(f"line {where}: {name} is {problem}") from None


@lru_cache
def _factor(name: str, written: str, unit: str) -> float:
    """A unit divided by the SI unit."""
    return read_quantity(name, f"1 {written}", Input("", unit, "")).si
