"""Requests for results, and the runs that compute these results.

A run that does not converge is repeated.  The slower the forward motion, the longer its transients.
In long transients, even small errors in the steps accumulate until the state is wrong.  The search
then needs a better initial guess.  So the second attempt solves the steps to a tighter tolerance.
The second attempt first finds the periodic state at a higher velocity, where the search is easier.
Then the second attempt lowers the velocity step by step. Each run starts from the state of the
previous run.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from microslip.answer import limits
from microslip.answer.answer import CLOSED_FORM, Answer, Estimate, Result
from microslip.answer.closed_forms import closed_form
from microslip.foundation.arguments import is_real, refuse_progress, without_array
from microslip.foundation.errors import InputError
from microslip.periodic.methods import SHIPPED, method_named
from microslip.periodic.run import Budget
from microslip.scene.problem import Problem

if TYPE_CHECKING:  # these load compiled code, which a closed form does not need
    from microslip.answer.ladder import Ladder
    from microslip.periodic.discretise import Resolution
    from microslip.periodic.run import Run, Settings

TOLERANCE = 1e-3
"""Default tolerance.  If no tolerance is requested, this value is the accuracy of the runs."""
MOST_WORK = {"polar": 2e9, "cartesian": 2e9}
MOST_WORK_OF_OTHERS = 2e8
"""Default limits on the work, by model.  The work is the number of step solves times the number of
unknowns.  The limits are more than ten times the work of the slowest points in the paper's range at
a tolerance of 1e-4."""
RUN_SHARE = 0.05
"""Largest distance of a run from its periodic state, divided by the tolerance.  In the
extrapolation, the distance of each run is multiplied by the weight of the run.  The weighted
distances of the runs add up to at most a twelfth of the tolerance."""
FACTOR, SMALLEST_FACTOR = 4.0, 1.15
"""Ratio of successive velocities in a second attempt.  After a failure, the ratio is replaced by
its square root.  The smallest ratio is `SMALLEST_FACTOR`."""
FASTEST_START = 1.0
"""A second attempt looks for the first periodic state at a drift of at most this value, in u_lim
per radian of phase.  At this drift, transients last less than a period."""


@dataclass(frozen=True, kw_only=True)
class Request:
    """A checked request: the friction in a problem, or the velocity of the contact under a force.

    Attributes
    ----------
    problem : problem.Problem
        The problem.
    model : str
        Name in contact.registry.MODELS.
    tolerance : float or None
        Absolute tolerance.  None means that any error is accepted.
    cells, steps : int or None
        Imposed numbers of cells and of steps per full period; None if not imposed.
    method : str
        Name of the method.
    progress : callable or None
        Called before every run, with the run's Resolution.
    chosen : bool
        Whether the requested model is "auto", so that a closed form can replace the model.
    budget : run.Budget
        Budget of all runs together.
    started : float
        Value of time.perf_counter() when the request was made.
    """

    problem: Problem
    model: str
    tolerance: float | None
    cells: int | None = None
    steps: int | None = None
    method: str = SHIPPED
    progress: Callable | None = None
    chosen: bool = False
    budget: Budget = field(default_factory=Budget)
    started: float = field(default_factory=time.perf_counter)

    def at(self, **changes: Any) -> Request:
        """Return a copy of the request in which the given fields of the problem are replaced."""
        return replace(self, problem=replace(self.problem, **changes))

    def result(self, estimates: dict[str, Estimate], reason: str = "", **values: Any) -> Result:
        """Create the `Result`.  Values that are not passed have the defaults for a result without a
        run."""
        own: dict[str, Any] = {
            "model": CLOSED_FORM if self.chosen else self.model,
            "tolerance": self.tolerance,
            "method": self.method,
            "exhausted": self.budget.exhausted,
            "solve_time_s": time.perf_counter() - self.started,
        }
        return Result.of(self.problem, estimates, reason, **own | values)


def request_of(
    problem: Problem,
    *,
    model: str = "auto",
    method: str = SHIPPED,
    progress: Callable | None = None,
    most_work: float | None = None,
    time_limit: float | None = None,
    **numbers: Any,
) -> Request:
    """Create the `Request` for a problem.  The time `solve_time_s` of the result is measured from
    this call on.

    Parameters
    ----------
    problem : problem.Problem
        The problem, already checked.
    model, method, progress, most_work, time_limit, **numbers
        See `microslip.solve`; the numbers are `tolerance`, `cells` and `steps`.

    Raises
    ------
    InputError
        If an argument is out of range, or a model or a method does not apply.  The message names
        the argument.
    """
    for name, value in numbers.items():
        numbers[name] = None if value is None else limits.within(name, value)
    limit = {"most_work": most_work, "time_limit": time_limit}
    for name, value in limit.items():
        if value is not None:
            limit[name] = value = without_array(value)
            if not (is_real(value) and value > 0.0):
                raise InputError(name, value, "allowed is a number above 0")
    refuse_progress(progress, 1)
    own = limits.choose_model(problem, model)
    limits.refuse(problem, own, method)
    most, seconds = limit.values()
    most = MOST_WORK.get(own, MOST_WORK_OF_OTHERS) if most is None else most
    numbers["budget"] = Budget(most, math.inf if seconds is None else seconds)
    how: dict[str, Any] = {"method": method, "progress": progress, "chosen": model == "auto"}
    return Request(problem=problem, model=own, **how, **numbers)


def answer_of(request: Request) -> Result:
    """Compute the friction at a velocity of at least 0, prescribed directly or through a spring.

    The result comes from a closed form if there is one, otherwise from runs of a model.
    """
    problem, drive, reason = request.problem, request.problem.drive, ""
    moves = problem.motion.periodic and problem.velocity > 0.0
    if drive is not None and not (moves and limits.oscillates(problem)):
        # under a constant force the length of the spring is constant
        request = request.at(drive=None)
        problem = request.problem
    exact, tolerance, velocity = None, request.tolerance, problem.velocity
    imposed = velocity > 0.0 and not (request.cells is None and request.steps is None)
    by_formula = request.chosen and request.method == SHIPPED and not imposed
    if by_formula or problem.amplitude == 0.0:
        exact = closed_form(problem, tolerance or 0.0)
    if exact is None:
        smallest = sys.float_info.epsilon * (1.0 + problem.stroke) / (2.0 * math.pi)
        if moves and problem.drift < smallest:  # the drift in a period is a rounding error
            least = smallest / problem.unit_drift
            allowed = f"allowed is 0 for the limit of vanishing velocity, or at least {least:.1e}"
            raise InputError("velocity", velocity, allowed)
        return result_of_runs(request, runs(request, tolerance or TOLERANCE), tolerance)
    error = exact["friction"].error
    if tolerance is not None and error > tolerance:
        reason = f"the error is {error:.1e}, above the tolerance of {tolerance:g}"
    return request.result(exact, reason)


def ladder_of(request: Request, tolerance: float) -> Ladder:
    """Return the ladder for the problem that a request describes.

    Raises InputError if a resolution must be chosen but the request has no tolerance.
    """
    from microslip.answer.ladder import ladder_for  # imported here because it loads compiled code

    ladder = ladder_for(request.problem, request.model, tolerance, request.cells, request.steps)
    if request.tolerance is None:
        names = ("cells", "steps")
        free = [one for one in names if getattr(ladder, one) and getattr(request, one) is None]
        if free:
            allowed = f"allowed is a number, or none where {' and '.join(free)} are imposed"
            raise InputError("tolerance", None, allowed)
    return ladder


def runs(
    request: Request,
    tolerance: float,
    name: str = "friction",
    *,
    ladder: Ladder | None = None,
    share: float = RUN_SHARE,
    slope: float = math.inf,
) -> Answer:
    """Refine the runs of a request until the error of one value is within the tolerance.

    Parameters
    ----------
    request : Request
        The request.
    tolerance : float
        Absolute tolerance.
    name : str
        Name of the value in run.Run.values.
    ladder : Ladder or None
        Resolutions.  By default, they are chosen for the problem.
    share : float
        Tolerance of a single run divided by `tolerance`.
    slope : float
        Rise of the friction with the velocity, for contacts under a force; see run.Settings.

    Returns
    -------
    Answer
        The `Answer` that refine.refine returns.  It has not converged if the budget of the request
        is exceeded.
    """
    # imported here because they load compiled code
    from microslip.answer.ladder import with_mass
    from microslip.answer.refine import refine
    from microslip.periodic.run import Settings
    from microslip.periodic.simulate import simulate
    from microslip.periodic.static_limit import edge_focus

    problem, drive, unresolved = request.problem, request.problem.drive, ""
    ladder = ladder or ladder_of(request, tolerance)
    if drive is not None and drive.mass > 0.0:
        ladder, unresolved = with_mass(ladder, problem, request.model, tolerance)
    full, work = 2.0 * math.pi * problem.mean_load, 0.0
    unit = full * (problem.mean_speed + abs(problem.drift))  # bounds the energy of a period
    if name == "velocity":  # its error changes the drift and the forces
        assert problem.force is not None
        work = full * problem.unit_drift * abs(problem.force)
        unit = slope * unit + work
    repeats = drive is None and problem.motion.periodic and problem.velocity > 0.0
    repeats = repeats and request.method == SHIPPED
    usual: Settings | None = None

    def run(one: Problem, resolution: Resolution, guess: Run | None) -> Run:
        nonlocal usual
        if usual is None:  # the search for the slip front is charged once
            place = problem, request.model, request.budget, request.progress
            focus = edge_focus(*place) if drive is None else None
            method = method_named(request.method)
            usual = Settings(method, budget=request.budget, focus=focus, slope=slope)
        settings, how = usual, (request.model, resolution, share * tolerance)
        if request.progress is not None:
            request.progress(resolution)
        first = simulate(one, *how, guess, settings)
        if not first.reason or not repeats:
            return first
        tighter = replace(settings, tighter=True)

        def run_at(velocity: float, guess: Run | None) -> Run:
            return simulate(replace(one, velocity=velocity), *how, guess, tighter)

        return second_attempt(first, run_at, one.velocity, FASTEST_START / one.unit_drift)

    every = problem, *problem.readings
    answer = refine(run, ladder, every, tolerance, name, energy_unit=unit, drive_work=work)
    return answer if answer.reason or not unresolved else replace(answer, reason=unresolved)


def second_attempt(
    first: Run, run_at: Callable[[float, Run | None], Run], velocity: float, fastest: float
) -> Run:
    """Repeat a run that did not converge, by continuation from a higher velocity.

    Parameters
    ----------
    first : run.Run
        The run that did not converge.
    run_at : callable
        `run_at(velocity, guess)` returns a run.Run whose steps are solved to a smaller tolerance.
    velocity : float
        Dimensionless velocity.
    fastest : float
        Largest velocity of the continuation.  `FACTOR * velocity` is always allowed.

    Returns
    -------
    run.Run
        The run, with the effort of all attempts and `effort.retried` equal to 1.  If all attempts
        fail, it is the first run, whose reason is the most informative.
    """
    attempts, at = [first, run_at(velocity, None)], velocity
    while not attempts[-1].converged and FACTOR * at <= max(fastest, FACTOR * velocity):
        at *= FACTOR
        attempts.append(run_at(at, None))
    above, factor = attempts[-1], FACTOR
    while above.converged and at > velocity and factor > SMALLEST_FACTOR:
        lower = max(at / factor, velocity)
        attempts.append(run_at(lower, above))
        if attempts[-1].converged:
            above, at = attempts[-1], lower
        else:
            factor = factor**0.5
    result = above if above.converged and at == velocity else first
    effort = sum((one.effort for one in attempts[1:]), first.effort._replace(retried=1))
    return replace(result, effort=effort)


def result_of_runs(
    request: Request,
    answer: Answer,
    largest: float | None,
    name: str = "friction",
    **more: Estimate,
) -> Result:
    """Create the `Result` of a refinement.

    The friction is clipped to its range.  The range is -1 to 1 for motions that can propel the
    contact, and 0 to 1 for all other motions.  If the error exceeds the width of the range, the
    result is the middle of the range.  In this case, the error is half the width of the range.

    Parameters
    ----------
    request : Request
        The request.
    answer : Answer
        The Answer of `runs`.
    largest : float or None
        Largest accepted error, or None if any error is accepted.
    name : str
        Name of the requested value.
    **more : Estimate
        Estimates of the Result that replace those of the Answer.
    """
    problem, requested, reason = request.problem, answer.estimates[name], answer.reason
    error = requested.error
    if not (reason or largest is None or error <= largest):
        where = "at the imposed resolution the error" if answer.imposed else "the estimated error"
        reason = f"{where} is {error:.1e}, above the tolerance of {largest:g}"
        file_error = requested.by_source.get("model", 0.0) if problem.readings else 0.0
        if file_error > 0.5 * error:
            reason += f": the file's own resolution leaves {file_error:.1e} open"
    estimates = {}
    for one in ("friction", "dissipation" if problem.motion.periodic else "torque"):
        if one in answer.estimates:
            estimates[one] = answer.estimates[one]
    friction, least = estimates.get("friction"), -1.0 if problem.propels else 0.0
    # values outside the range of the friction result from rounding and discretisation errors
    if friction is not None and not math.isfinite(friction.value):
        estimates["friction"] = replace(friction, value=math.nan)
    elif friction is not None and friction.error > 1.0 - least:
        half = 0.5 * (1.0 - least)
        estimates["friction"] = Estimate(1.0 - half, {"model": half})
    elif friction is not None:
        clipped = min(max(friction.value, least), 1.0)
        estimates["friction"] = replace(friction, value=clipped)
    values = {**answer.values}
    for unused in ("finest", "imposed"):
        values.pop(unused, None)
    if request.budget.exhausted:
        values["effort"] = request.budget.taken
    return request.result(estimates | more, reason, model=request.model, **values)
