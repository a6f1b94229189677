"""Requests, which consist of a problem, a model, a method, a tolerance and a budget."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from microslip.adaptive.choice import choose_model, method_refusal
from microslip.adaptive.result import CLOSED_FORM, Result
from microslip.adaptive.under_force import refuse_drive
from microslip.estimate.estimate import Estimate
from microslip.foundation.arguments import (
    LARGEST,
    SMALLEST_TOLERANCE,
    count,
    is_real,
    real,
    without_array,
)
from microslip.foundation.errors import InputError
from microslip.motions.drive import Drive
from microslip.motions.problem import Problem
from microslip.solver import method_names
from microslip.solver.budget import Budget
from microslip.solver.method import Method

if TYPE_CHECKING:  # the module loads compiled code, which a closed form does not need
    from microslip.estimate.refine import Refined
    from microslip.solver.discretise import Resolution

TOLERANCE = 1e-3
"""Default tolerance, also used as the accuracy of runs if no tolerance is requested."""
MOST_WORK = {"polar": 2e9, "cartesian": 2e9}
MOST_WORK_OF_OTHERS = 2e8
"""Default limits on the work (step solves times unknowns) by model.  They are more than ten times
the work of the slowest points in the paper's range at a tolerance of 1e-4."""


@dataclass(frozen=True, kw_only=True)
class Request:
    """A checked request for the friction of a problem, or for its velocity under a force.

    Attributes
    ----------
    problem : problem.Problem
        The problem.
    model : str
        Name in contact.registry.MODELS.
    chosen : bool
        Whether the requested model is "auto", so that a closed form can replace the model.
    method : str
        Name of the method.
    how : method.Method
        The method.
    tolerance : float or None
        Absolute tolerance.  None means that any error is accepted.
    cells, steps : int or None
        Imposed numbers of cells and of steps per full period; None if not imposed.
    budget : budget.Budget
        Budget of all runs together.
    progress : callable or None
        Called before every run, with the run's Resolution.
    started : float
        Value of time.perf_counter() when the request was made.
    """

    problem: Problem
    model: str
    chosen: bool
    method: str
    how: Method
    tolerance: float | None
    cells: int | None
    steps: int | None
    budget: Budget
    progress: Callable | None
    started: float

    @property
    def accuracy(self) -> float:
        """The tolerance to which the runs are refined."""
        return TOLERANCE if self.tolerance is None else self.tolerance

    @property
    def point(self) -> dict:
        """The fields of a result.Result that are copied from the request."""
        problem = self.problem
        return driven_by(problem.drive) | {
            "motion": problem.motion.name,
            "pressure": problem.pressure.name,
            "mean_velocity": Estimate(problem.velocity),
            "amplitude": problem.amplitude,
            "poisson": problem.poisson,
            "tolerance": self.tolerance,
            "method": self.method,
        }

    @property
    def model_without_runs(self) -> str:
        """Name of the model in a Result that needs no run."""
        return CLOSED_FORM if self.chosen else self.model

    def show(self, resolution: Resolution) -> None:
        """Report the start of a run to `progress`."""
        if self.progress is not None:
            self.progress(resolution)

    @property
    def seconds(self) -> float:
        """Wall-clock time since the request was made, in seconds."""
        return time.perf_counter() - self.started


def request_for(
    problem: Problem,
    model: str,
    tolerance: float | None,
    *,
    cells: int | None = None,
    steps: int | None = None,
    method: str = method_names.SHIPPED,
    most_work: float | None = None,
    time_limit: float | None = None,
    progress: Callable | None = None,
) -> Request:
    """Build the Request for a problem.  The time limit counts from this call.

    Parameters
    ----------
    problem : problem.Problem
        The problem, already checked.
    model, tolerance, cells, steps, method, most_work, time_limit, progress
        See `microslip.solve`.

    Raises
    ------
    InputError
        If an argument is out of range, or a model or a method does not apply.  The message names
        the argument.
    """
    started = time.perf_counter()
    if cells is not None:
        cells = count("cells", cells, 4, most=LARGEST["cells"], even=True)
    if steps is not None:
        steps = count("steps", steps, 8, most=LARGEST["steps"], even=True)
    if tolerance is not None:
        tolerance = real("tolerance", tolerance, SMALLEST_TOLERANCE, 0.1)
    most_work, time_limit = without_array(most_work), without_array(time_limit)
    for argument, value in (("most_work", most_work), ("time_limit", time_limit)):
        if value is not None and not (is_real(value) and value > 0.0):
            raise InputError(argument, value, "allowed is a number above 0")
    if progress is not None and not callable(progress):
        raise InputError("progress", progress, "allowed is a function of one argument")
    name, how = choose_model(problem, model), method_names.method_named(method)
    lack = method_names.missing(method)
    if lack:
        raise InputError("method", method, lack)
    refusal = method_refusal(problem, name, how)
    if not refusal and how.run is not None:
        refusal = "it is one run, which cannot be refined"
    if refusal:
        motion = problem.motion.name
        raise InputError("method", method, f"does not apply to {motion}, model {name}: {refusal}")
    if problem.drive is not None:
        refuse_drive(problem, name)
        if method != method_names.SHIPPED:
            pulls = "stiffness" if problem.drive.force is None else "force"
            raise InputError("method", method, f"allowed is {method_names.SHIPPED} with a {pulls}")
    if most_work is None:
        most_work = MOST_WORK.get(name, MOST_WORK_OF_OTHERS)
    return Request(
        problem=problem,
        model=name,
        chosen=model == "auto",
        method=method,
        how=how,
        tolerance=tolerance,
        cells=cells,
        steps=steps,
        budget=Budget(most_work, math.inf if time_limit is None else time_limit),
        progress=progress,
        started=started,
    )


def within_friction(problem: Problem, friction: Estimate) -> Estimate:
    """Clip the friction to its range: 0 to 1, or -1 to 1 for motions that can propel.

    Values outside this range result from rounding and discretisation errors.  If the error exceeds
    the width of the range, the result is the middle of the range with half the width as its error.
    """
    least = -1.0 if problem.propels else 0.0
    if not math.isfinite(friction.value):
        return replace(friction, value=math.nan)
    half = 0.5 * (1.0 - least)
    if friction.error > 2.0 * half:
        return Estimate(1.0 - half, {"model": half})
    return replace(friction, value=min(max(friction.value, least), 1.0))


def driven_by(drive: Drive | None) -> dict:
    """The fields of a result.Result that describe the drive."""
    if drive is None:
        return {}
    if drive.force is None:
        return {"stiffness": drive.stiffness, "mass": drive.mass, "damping": drive.damping}
    return {"force": drive.force} | ({"mass": drive.mass} if drive.mass > 0.0 else {})


def result_of_runs(
    request: Request,
    refined: Refined,
    largest: float | None,
    name: str = "friction",
    **more: Estimate,
) -> Result:
    """Build the Result of a refinement.

    Parameters
    ----------
    request : Request
        The request.
    refined : refine.Refined
        Friction or velocity, with the other values from the same runs.
    largest : float or None
        Largest accepted error, or None if any error is accepted.
    name : str
        Name of the requested value.
    **more : Estimate
        Fields of the Result that replace those from `refined`.
    """
    problem, periodic = request.problem, request.problem.motion.periodic
    if request.budget.exhausted:
        refined = replace(refined, effort=request.budget.taken)
    estimates = dict(refined.estimates)
    error, by_source = estimates[name].error, estimates[name].by_source
    within = largest is None or error <= largest
    reason, ladder = refined.reason, refined.ladder
    if refined.converged and not within:
        where = "at the imposed resolution the error" if ladder.imposed else "the estimated error"
        reason = f"{where} is {error:.1e}, above the tolerance of {largest:g}"
        file_error = by_source.get("model", 0.0) if problem.readings else 0.0
        if file_error > 0.5 * error:
            reason += f": the file's own resolution leaves {file_error:.1e} open"
    values: dict[str, Estimate | None] = {
        "torque": None if periodic else estimates.get("torque"),
        "dissipation": estimates.get("dissipation") if periodic else None,
    }
    if "friction" not in more:
        values["friction"] = within_friction(problem, estimates["friction"])
    finest = refined.resolution
    return Result(
        **request.point | values | more,
        model=request.model,
        converged=refined.converged and within,
        periodic=refined.periodic,
        reason=reason,
        cells=finest.cells,
        angles=finest.angles,
        steps_per_period=2 * finest.steps if ladder.steps else 0,
        observed_order=refined.order if math.isfinite(refined.order) else None,
        periods=refined.periods,
        effort=refined.effort,
        exhausted=request.budget.exhausted,
        solve_time_s=request.seconds,
    )
