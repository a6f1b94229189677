"""Iwan model of a contact, and its error due to Poisson's ratio."""

from __future__ import annotations

import dataclasses

import numpy as np

from microslip.answer.along import response
from microslip.answer.limits import within
from microslip.foundation.errors import InputError
from microslip.pressures.by_name import pressure_named
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Pressure
from microslip.theory.iwan import Iwan, with_elements, with_tolerance

TOLERANCE = 1e-3
"""Default tolerance of the discretisation, and tolerance of the full contact in the comparison."""
BEYOND_FULL_SLIP = 1.2
"""The loop of the comparison turns at plus and minus this displacement, in u_lim.  At nu = 0.5, the
force is within 2e-4 of full friction there."""
ROWS = 13
"""Number of rows in the first loading of the comparison, one for every 0.1 u_lim.  A branch of the
loop has twice as many intervals.  With 49 rows, the difference is up to 7 % larger."""


def iwan(
    pressure: str | Pressure = HERTZ,
    *,
    poisson: float = 0.0,
    elements: int | None = None,
    tolerance: float | None = None,
) -> Iwan:
    """Iwan model of a contact that moves along a line: parallel springs with sliders.

    At nu = 0, the model with many elements is exact.  At nu > 0, it is compared with the full
    contact on a first loading and a loop, and the difference is part of the error.

    Parameters
    ----------
    pressure : str or Pressure
        Pressure as for `microslip.solve`: an axisymmetric indenter, or an ellipse at nu = 0.
    poisson : float
        Poisson's ratio, 0 to 0.5.
    elements : int or None
        Number of elements.
    tolerance : float or None
        Largest error due to the number of elements, divided by mu F_z.  Defaults to 1e-3.  Give
        either this or `elements`.

    Returns
    -------
    Iwan
        The elements.  Displacements are divided by u_lim, and forces by mu F_z.

    Raises
    ------
    InputError
        If an argument is invalid.
    """
    record = pressure if isinstance(pressure, Pressure) else pressure_named(pressure)
    poisson = within("poisson", poisson)
    if not (record.is_indenter or (record.hertzian and not poisson)):
        allowed = (
            "allowed is an axisymmetric indenter (hertz, power, punch), or an ellipse at nu = 0"
        )
        raise InputError("pressure", record.name, allowed)
    shape = record if record.is_indenter else HERTZ  # an ellipse has the loading curve of a sphere
    if elements is not None and tolerance is not None:
        raise InputError("elements", elements, "allowed only without a tolerance")
    if elements is not None:
        model = with_elements(shape, within("elements", elements))
    else:
        accepted = TOLERANCE if tolerance is None else tolerance
        model = with_tolerance(shape, within("tolerance", accepted, high=1.0))
    if not poisson:
        return model
    return dataclasses.replace(model, poisson_error=_poisson_error(shape, poisson))


def _poisson_error(pressure: Pressure, poisson: float) -> float:
    """Return the largest difference between the full contact and the exact model at nu = 0.

    The path is a first loading and a loop between full slip in both directions.
    """
    rise = np.linspace(0.0, BEYOND_FULL_SLIP, ROWS)
    # Half the displacement since a turning point.
    half = np.linspace(0.0, BEYOND_FULL_SLIP, 2 * ROWS - 1)[1:]
    path = np.concatenate([rise, BEYOND_FULL_SLIP - 2.0 * half, 2.0 * half - BEYOND_FULL_SLIP])
    back = 1.0 - 2.0 * pressure.loading(half)
    forces = np.concatenate([pressure.loading(rise), back, -back])
    full = response(path, pressure=pressure, poisson=poisson, tolerance=TOLERANCE)
    return float(np.max(np.abs(full.force_forward - forces) + full.force_error[:, 0]))
