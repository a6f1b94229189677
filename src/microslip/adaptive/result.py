"""Result at one point: friction, or velocity under a prescribed force, with its error estimate."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from microslip.contact.registry import MODELS
from microslip.estimate.estimate import SOURCES, Estimate
from microslip.foundation.number_text import number_text
from microslip.motions.by_name import motion_named
from microslip.motions.problem import Problem
from microslip.solver.effort import Effort

CLOSED_FORM = "closed-form"
"""Model name in results that need no run."""
QUANTITIES = {
    "friction": "mu_macro",
    "mean_velocity": "velocity",
    "torque": "mu_torque",
    "dissipation": "dissipated_energy",
}
"""Names of a Result's estimates in JSON and datasets."""
ERRORS = {source: f"error_{source}" for source in SOURCES}
"""Names of the error sources in JSON and datasets."""
EFFORT = {"iterations": "iterations", "work": "work", "updates": "effort", "retried": "retried"}
"""Names of an Effort's fields in JSON and datasets."""

RATIO = (
    "a ratio: mean forward force divided by mu F_z; the coefficient of friction is mu times "
    "mu_macro"
)
"""Explanation of mu_macro for users."""
OWN_EQUATIONS = (
    "an approximate model: the error estimate covers its discretisation, not the approximation"
)
DIGITS = 6
"""Number of significant digits of a number without an error estimate."""


@dataclass(frozen=True, kw_only=True)
class Result:
    """Friction at one point, or the velocity under a force, with its error estimate.

    All numbers except the time are dimensionless.  A count that does not apply is 0: a closed form
    needs no marches, and a steady motion has no periods.

    Attributes
    ----------
    motion, pressure : str
        Names of the motion and the pressure, with their parameters.
    mean_velocity : Estimate
        Forward velocity, dimensionless as in the paper.  Its error is 0 if the velocity is
        prescribed.  The velocity is NaN if the contact accelerates without limit.
    amplitude : float or None
        Dimensionless amplitude of the motion; None for steady motions.
    poisson : float
        Poisson's ratio.
    force, stiffness, mass, damping : float or None
        Parameters of the drive, see motions.drive.  None if the drive has no such part.
    model : str
        Name of the contact model, or "closed-form".
    tolerance : float or None
        Largest accepted error of the result, relative for a velocity above 1.  None means that any
        error is accepted.
    method : str
        "shipped", or the name of another method.
    friction : Estimate
        Mean forward friction force divided by mu F_z; 1 is friction without vibration.  Its error
        is 0 if the force is prescribed.
    torque : Estimate or None
        Torque divided by its value at zero forward velocity; None for oscillating motions.
    dissipation : Estimate or None
        Energy that friction dissipates in a period, divided by mu F_z u_lim, where F_z is the
        normal load without oscillation.  None for steady motions, whose dissipated power is
        mu_macro * velocity + torque * angular velocity.
    converged : bool
        Whether the error is within the tolerance and every run found its periodic state.  Without a
        tolerance, only the second condition applies.
    periodic : bool
        Whether every run found its periodic state.
    reason : str
        Reason why the result is not converged, in one line; otherwise empty.
    cells : int
        Number of rings, or of squares across the contact, in the finest run.
    angles : int
        Number of angular points on half the disc in the finest run; 1 for rings and squares.
    steps_per_period : int
        Number of time steps in a full period in the finest run.
    observed_order : float or None
        Observed order of convergence of the last three levels, or None if it is unknown.  The
        expected order is 2.  If the observed order is far below 1, the runs are too coarse for the
        error estimate.
    periods : float
        Number of full periods that the longest run marched to find the periodic state; 2.5 means
        five half periods.
    effort : Effort
        Effort of all runs.
    exhausted : str
        Name of the limit that ended the search ("work" or "time"), otherwise empty.  The effect of
        a time limit depends on the machine.
    solve_time_s : float
        Wall-clock time in seconds.
    """

    motion: str
    pressure: str
    mean_velocity: Estimate
    amplitude: float | None
    poisson: float
    model: str
    tolerance: float | None
    method: str
    force: float | None = None
    stiffness: float | None = None
    mass: float | None = None
    damping: float | None = None
    friction: Estimate
    torque: Estimate | None = None
    dissipation: Estimate | None = None
    converged: bool
    periodic: bool
    reason: str = ""
    cells: int = 0
    angles: int = 0
    steps_per_period: int = 0
    observed_order: float | None = None
    periods: float = 0.0
    effort: Effort = Effort()
    exhausted: str = ""
    solve_time_s: float

    @property
    def answer(self) -> Estimate:
        """The requested quantity: the velocity under a prescribed force, otherwise the friction."""
        return self.friction if self.force is None else self.mean_velocity

    @property
    def mu_macro(self) -> float:
        """Value of `friction`."""
        return self.friction.value

    @property
    def mu_macro_error(self) -> float:
        """Error of `friction`."""
        return self.friction.error

    @property
    def velocity(self) -> float:
        """Value of `mean_velocity`."""
        return self.mean_velocity.value

    @property
    def velocity_error(self) -> float | None:
        """Error of `mean_velocity`; None if the velocity is prescribed."""
        return None if self.force is None else self.mean_velocity.error

    @property
    def mu_torque(self) -> float | None:
        """Value of `torque`; None for oscillating motions."""
        return None if self.torque is None else self.torque.value

    @property
    def dissipated_energy(self) -> float | None:
        """Value of `dissipation`; None for steady motions."""
        return None if self.dissipation is None else self.dissipation.value

    @property
    def dissipated_energy_error(self) -> float | None:
        """Error of `dissipation`; None for steady motions."""
        return None if self.dissipation is None else self.dissipation.error

    def __str__(self) -> str:
        """The lines that `microslip point` prints."""

        def text(one: Estimate) -> str:
            return number_text(one.value, one.error, digits=DIGITS)

        quantity = "mu_macro" if self.force is None else "velocity"
        lines = [f"{quantity} = {text(self.answer)}", *[RATIO] * (self.force is None)]
        if self.torque is not None:
            lines.append(f"mu_torque = {text(self.torque)}")
        resolved = f"{self.cells} cells"
        if self.angles > 1:
            resolved += f" x {self.angles} angles"
        if self.steps_per_period:
            resolved += f", {self.steps_per_period} steps a period"
        lines.append(f"model {self.model}" + (f" ({resolved})" if self.cells else ""))
        if self._is_approximate:
            lines.append(OWN_EQUATIONS)
        if not self.converged:
            lines.append(f"NOT CONVERGED: {quantity}: {self.reason}")
        return "\n".join(lines)

    @property
    def _is_approximate(self) -> bool:
        """True for a model whose error does not vanish when its mesh is refined."""
        if self.model not in MODELS:
            return False  # a closed form
        problem = Problem(motion_named(self.motion), self.velocity, self.amplitude)
        return not MODELS[self.model].exact(problem)

    def to_dict(self) -> dict:
        """Convert to a dict with the names used in JSON and datasets; fields that do not apply are
        omitted."""
        inside = {*QUANTITIES, "effort"}
        plain = {one.name: getattr(self, one.name) for one in fields(self)}
        flat = {name: value for name, value in plain.items() if name not in inside}
        for field, name in QUANTITIES.items():
            estimate = plain[field]
            flat[name] = None if estimate is None else estimate.value
            flat[f"{name}_error"] = None if estimate is None else estimate.error
        flat["velocity_error"] = self.velocity_error
        flat |= {name: self.answer.by_source.get(source, 0.0) for source, name in ERRORS.items()}
        flat |= {name: getattr(self.effort, field) for field, name in EFFORT.items()}
        return {k: v for k, v in flat.items() if v is not None or k == "tolerance"}

    @staticmethod
    def from_dict(flat: Mapping[str, Any]) -> Result:
        """Build a Result from the output of `to_dict`; missing fields become NaN, 0 or empty."""
        errors = {source: _number(flat.get(name)) for source, name in ERRORS.items()}
        values: dict[str, Any] = {"converged": False, "periodic": False, "solve_time_s": 0.0}
        values |= {"amplitude": None, "tolerance": None, "model": "", "method": ""}
        names = {one.name for one in fields(Result)} - {*QUANTITIES, "effort"}
        values |= {name: flat[name] for name in names if flat.get(name) is not None}
        driven = flat.get("force") is not None
        return Result(
            **values,
            friction=Estimate(_number(flat.get("mu_macro")), {} if driven else errors),
            mean_velocity=Estimate(_number(flat.get("velocity")), errors if driven else {}),
            torque=_estimate(flat, "mu_torque"),
            dissipation=_estimate(flat, "dissipated_energy"),
            effort=Effort(**{field: flat.get(name) or 0 for field, name in EFFORT.items()}),
        )


def _estimate(flat: Mapping[str, Any], name: str) -> Estimate | None:
    """Return the estimate of a quantity, or None if it is missing."""
    if flat.get(name) is None:
        return None
    return Estimate(flat[name], {"resolution": _number(flat.get(f"{name}_error"))})


def _number(value: float | None) -> float:
    """Return the number, or NaN for None."""
    return math.nan if value is None else value
