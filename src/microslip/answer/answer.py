"""Classes of the results of public functions, and of quantities with error estimates."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Self

from microslip.contact.registry import MODELS
from microslip.foundation.number_text import number_text
from microslip.periodic.run import Effort
from microslip.scene.problem import Problem

CLOSED_FORM = "closed-form"
"""Model name in results of a closed form. A closed form needs no run."""
SOURCES = ("resolution", "periodicity", "solver", "model")
"""Error sources of an estimate, see refine.py."""
QUANTITIES = {
    "mu_macro": "friction",
    "velocity": "mean_velocity",
    "mu_torque": "torque",
    "dissipated_energy": "dissipation",
}
"""Dictionary.  The keys are names of values in JSON and datasets.  The values are names of the
estimates in a Result."""
ERRORS = {source: f"error_{source}" for source in SOURCES}
"""Names of the error sources in JSON and datasets."""
EFFORT = {"iterations": "iterations", "work": "work", "updates": "effort", "retried": "retried"}
"""Names of an Effort's fields in JSON and datasets."""
DRIVE = ("force", "stiffness", "mass", "damping")
"""Names of the parameters of a drive."""
DEFAULTS: dict[str, Any] = {
    "torque": None,
    "dissipation": None,
    "model": CLOSED_FORM,
    "tolerance": None,
    "method": "shipped",
    "periodic": True,
    "cells": 0,
    "angles": 0,
    "steps_per_period": 0,
    "observed_order": None,
    "periods": 0.0,
    "effort": Effort(),
    "exhausted": "",
    "solve_time_s": 0.0,
}
"""Values of a Result that needs no run."""
FIELDS = (
    *("motion", "pressure", "amplitude", "poisson", "model", "tolerance", "method", *DRIVE),
    *("converged", "periodic", "reason", "cells", "angles", "steps_per_period"),
    *("observed_order", "periods", "exhausted", "solve_time_s"),
)
"""Names of the values without an error estimate, in the order of JSON and datasets."""

RATIO = (
    "a ratio: mean forward force divided by mu F_z; the coefficient of friction is mu times "
    "mu_macro"
)
"""Explanation of mu_macro, printed with a result."""
OWN_EQUATIONS = (
    "an approximate model: the error estimate covers its discretisation, not the approximation"
)
DIGITS = 6
"""Number of significant digits of a number without an error estimate."""


@dataclass(frozen=True)
class Estimate:
    """A quantity with its error estimate.

    Estimates can be added to each other and multiplied by numbers.  For each source, the error of a
    sum is the sum of the errors of the terms.

    Attributes
    ----------
    value : float
        The quantity.
    by_source : mapping of float
        Error estimate by source, in the unit of the value; the keys are from SOURCES.  The error of
        a missing source is 0.
    """

    value: float
    by_source: Mapping[str, float] = field(default_factory=dict)

    @property
    def error(self) -> float:
        """Sum of the errors of all sources."""
        return float(sum(self.by_source.values()))

    def __add__(self, other: Estimate) -> Estimate:
        sources = [name for name in SOURCES if name in self.by_source or name in other.by_source]
        errors = {n: self.by_source.get(n, 0.0) + other.by_source.get(n, 0.0) for n in sources}
        return Estimate(self.value + other.value, errors)

    def __rmul__(self, factor: float) -> Estimate:
        errors = {name: abs(factor) * error for name, error in self.by_source.items()}
        return Estimate(factor * self.value, errors)

    def __neg__(self) -> Estimate:
        return Estimate(-self.value, self.by_source)


UNKNOWN = Estimate(math.nan, dict.fromkeys(("resolution", "periodicity", "solver"), math.inf))
"""Estimate of an unknown quantity."""


@dataclass(frozen=True, eq=False)
class Answer:
    """Named results for a problem.  Every value and every estimate is also an attribute.

    Attributes
    ----------
    problem : Problem
        The problem.
    values : mapping of str to object
        Numbers, strings and arrays by name.
    estimates : mapping of str to Estimate
        Quantities with error estimates by name.
    reason : str
        Reason why the result has not converged, in one line; otherwise empty.
    """

    problem: Problem
    values: Mapping[str, Any] = field(default_factory=dict)
    estimates: Mapping[str, Estimate] = field(default_factory=dict)
    reason: str = ""

    def __getattr__(self, name: str) -> Any:
        if not name.startswith("_"):  # pickle and copy look for special methods
            for table in (self.estimates, self.values):
                if name in table:
                    return table[name]
        raise AttributeError(f"{type(self).__name__} has no attribute {name!r}")

    @property
    def converged(self) -> bool:
        """Whether the result has converged.  If the result has not converged, `reason` says why."""
        return bool(self.values.get("converged", not self.reason))

    def changed(self, **changes: Any) -> Self:
        """Return a copy in which the given reason, values or estimates are replaced."""
        reason = changes.pop("reason", self.reason)
        estimates = {name: one for name, one in changes.items() if isinstance(one, Estimate)}
        values = {name: one for name, one in changes.items() if name not in estimates}
        return replace(
            self,
            values={**self.values, **values},
            estimates={**self.estimates, **estimates},
            reason=reason,
        )

    def to_dict(self) -> dict[str, Any]:
        """Return a dict that contains the values and the entries `converged` and `reason`."""
        return {**self.values, "converged": self.converged, "reason": self.reason}


def about(problem: Problem) -> dict[str, Any]:
    """Return a dict of the parameters of a problem.  Drive parameters that do not apply are
    None."""
    own: dict[str, Any] = {
        "motion": problem.motion.name,
        "pressure": problem.pressure.name,
        "amplitude": problem.amplitude,
        "poisson": problem.poisson,
    }
    own |= dict.fromkeys(DRIVE)
    drive = problem.drive
    if drive is None:
        return own
    if drive.force is None:
        return own | {name: getattr(drive, name) for name in DRIVE[1:]}
    return own | {"force": drive.force, "mass": drive.mass or None}


class Result(Answer):
    """Result of `solve`: the friction, or the velocity under a force, with its error estimate.

    All numbers except `solve_time_s` are dimensionless.  Counts that do not apply, such as the
    number of cells of a closed form or the number of periods of a steady motion, are 0.

    Attributes
    ----------
    motion, pressure : str
        Names of the motion and the pressure, with their parameters.
    mean_velocity : Estimate
        Mean forward velocity in the paper's dimensionless form.  Its error is 0 if the velocity is
        prescribed.  The velocity is NaN if the contact accelerates without limit.
    velocity, velocity_error : float
        Value and error of `mean_velocity`; the error is None if the velocity is prescribed.
    amplitude : float or None
        Dimensionless amplitude of the motion; None for steady motions.
    poisson : float
        Poisson's ratio.
    force, stiffness, mass, damping : float or None
        Parameters of the drive, see `microslip.solve`.  None if the drive does not have the
        parameter.
    model : str
        Name of the contact model, or "closed-form".
    tolerance : float or None
        Largest accepted error of the result.  For a velocity above 1, it is relative to the
        velocity.  None means that any error is accepted.
    method : str
        Name of the numerical method.  The default is "shipped".
    friction : Estimate
        Mean forward friction force divided by mu F_z; it is 1 without vibration.  Its error is 0 if
        the force is prescribed.
    mu_macro, mu_macro_error : float
        Value and error of `friction`.
    torque : Estimate or None
        Torque divided by its value at zero forward velocity; None for oscillating motions.
    mu_torque, mu_torque_error : float or None
        Value and error of `torque`.
    dissipation : Estimate or None
        Energy that friction dissipates in a period, divided by mu F_z u_lim, where F_z is the
        normal load without oscillation.  None for steady motions, whose dissipated power is
        mu_macro * velocity + torque * angular velocity.
    dissipated_energy, dissipated_energy_error : float or None
        Value and error of `dissipation`.
    answer : Estimate
        The requested quantity: the velocity under a prescribed force, otherwise the friction.
    converged : bool
        Whether the error is within the tolerance and every run found its periodic state.  Without a
        tolerance, only the second condition applies.
    periodic : bool
        Whether every run found its periodic state.
    reason : str
        Reason why the result has not converged, in one line; otherwise empty.
    cells : int
        Number of rings, or of squares across the contact, in the finest run.
    angles : int
        Number of angular points on half the disc in the finest run; 1 for rings and squares.
    steps_per_period : int
        Number of time steps in a full period in the finest run.
    observed_order : float or None
        Observed order of convergence of the last three levels, or None if it is unknown.  The
        expected order is 2.  If the observed order is far below 1, the runs are too coarse for a
        reliable error estimate.
    periods : float
        Number of full periods that the longest run needed to find the periodic state; 2.5 means
        five half periods.
    effort : Effort
        Effort of all runs.
    exhausted : str
        Name of the limit that ended the search ("work" or "time"), otherwise empty.  The effect of
        a time limit depends on the machine.
    solve_time_s : float
        Wall-clock time in seconds.
    """

    @classmethod
    def of(
        cls, problem: Problem, estimates: Mapping[str, Estimate], reason: str = "", **values: Any
    ) -> Result:
        """Build a Result.  If a value is missing, the value in DEFAULTS is used."""
        known = {"mean_velocity": Estimate(problem.velocity), **estimates}
        return cls(problem, {**about(problem), **DEFAULTS, **values}, known, reason)

    def __getattr__(self, name: str) -> Any:
        quantity = name.removesuffix("_error")
        if quantity not in QUANTITIES:
            return super().__getattr__(name)
        one = self.estimates.get(QUANTITIES[quantity])
        return None if one is None else one.value if quantity == name else one.error

    @property
    def velocity_error(self) -> float | None:
        return None if self.force is None else self.mean_velocity.error

    @property
    def answer(self) -> Estimate:
        return self.friction if self.force is None else self.mean_velocity

    def __str__(self) -> str:
        """Return the text that `microslip point` prints."""

        def text(one: Estimate) -> str:
            return number_text(one.value, one.error, digits=DIGITS)

        quantity = "mu_macro" if self.force is None else "velocity"
        lines = [f"{quantity} = {text(self.answer)}", *[RATIO] * (self.force is None)]
        if self.torque is not None:
            lines.append(f"mu_torque = {text(self.torque)}")
        resolution = f" ({self.cells} cells" + f" x {self.angles} angles" * (self.angles > 1)
        resolution += f", {self.steps_per_period} steps a period" * bool(self.steps_per_period)
        lines.append(f"model {self.model}" + f"{resolution})" * bool(self.cells))
        if self.model in MODELS and not MODELS[self.model].exact(self.problem):
            lines.append(OWN_EQUATIONS)
        return "\n".join(lines + [f"NOT CONVERGED: {quantity}: {self.reason}"] * bool(self.reason))

    def to_dict(self) -> dict[str, Any]:
        """Return a dict with the names used in JSON and datasets.  Fields that do not apply are
        omitted."""
        names = [name for one in QUANTITIES for name in (one, f"{one}_error")]
        flat = {name: getattr(self, name) for name in (*FIELDS, *names)}
        flat |= {name: self.answer.by_source.get(source, 0.0) for source, name in ERRORS.items()}
        flat |= {name: getattr(self.effort, own) for own, name in EFFORT.items()}
        return {k: v for k, v in flat.items() if v is not None or k == "tolerance"}
