"""Catalogue of the closed forms for each motion, with limits, ranges of validity and names.

This catalogue is used by datasets, by figures, and by the study of the paper's statements.  The
forms apply to Hertz pressure.  For other pressures, see datasets.pressure_limits.  The solver uses
exact.py, not this catalogue, so editing a name here does not change stored results.

The table catalogue.csv has a row for each form, in the order in which datasets list them.  The
column `function` names a function in microslip.theory, and `properties` lists the properties that
are True.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from microslip.datasets.variables import rows
from microslip.theory.exact import STATIC_LIMITS

STATIC = "mu_static"
"""Name of the exact limit as the velocity tends to 0. All motions use this name."""


@dataclass(frozen=True)
class ClosedForm:
    """A formula for the friction or the torque of a motion.

    Attributes
    ----------
    name : str
        Name of the variable in a dataset.
    function : callable
        Function of the ``arguments``. Its arguments and its result are dimensionless arrays.
    arguments : tuple of str
        "velocity", "amplitude", "force", or two of them.
    equation, label : str
        equation: number of the equation in the paper, "" if the paper does not contain the form.
        label: name in legends.
    long_name, description : str
        Long name and description in a dataset. An empty description is omitted.
    exact : bool
        True if the form is exact in the limit that it describes, False if it is an estimate.
    any_poisson, any_pressure : bool
        any_poisson: True if the form applies to every Poisson's ratio, False if it applies to 0
        only. any_pressure: True if the form applies to every pressure, False if it applies to Hertz
        pressure only.
    """

    name: str
    function: Callable
    arguments: tuple[str, ...]
    equation: str
    label: str
    long_name: str
    description: str = ""
    exact: bool = False
    any_poisson: bool = False
    any_pressure: bool = False


def _form(function: str, arguments: str, properties: str, **more: Any) -> ClosedForm:
    """Return the closed form described by a row of the table."""
    module, _, name = function.partition(".")
    more |= dict.fromkeys(properties.split(), True)
    computes = getattr(import_module(f"microslip.theory.{module}"), name)
    return ClosedForm(function=computes, arguments=tuple(arguments.split()), **more)


FORMS: dict[str, dict[str, ClosedForm]] = {}
"""Closed forms of friction and torque, keyed by motion and name, in the order in which datasets
list them."""
DRIFT_FORMS: dict[str, ClosedForm] = {}
"""Closed forms of the mean velocity at a constant force, keyed by motion."""
for _row in rows(Path(__file__).with_suffix(".csv")):
    _motion = _row.pop("motion")
    _one = _form(**_row)
    if "force" in _one.arguments:
        DRIFT_FORMS[_motion] = _one
    else:
        FORMS.setdefault(_motion, {})[_one.name] = _one
for _motion, _limit in STATIC_LIMITS.items():
    _text = "static friction, exact limit of mu_macro for velocity to 0"
    FORMS.setdefault(_motion, {})[STATIC] = ClosedForm(
        *(STATIC, _limit.function, ("amplitude",)),
        *("", "exact limit", "exact limit for velocity to 0"),
        _text if _limit.any_poisson else f"{_text} at Poisson's ratio 0",
        exact=True,
        any_poisson=_limit.any_poisson,
    )
