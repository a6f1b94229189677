"""The friction of a contact that is moved forward at a given velocity."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import NamedTuple

from microslip.adaptive.choice import choose_model
from microslip.adaptive.closed_forms import no_vibration, unless_imposed
from microslip.adaptive.continuation import run_safely
from microslip.adaptive.request import TOLERANCE, Request, verdict, within_friction
from microslip.adaptive.result import Result
from microslip.estimate.ladder import Ladder, ladder_for, refuse_free
from microslip.estimate.refine import refine, run_tolerance
from microslip.motions.problem import Problem
from microslip.solver.budget import Spent
from microslip.solver.discretise import Resolution
from microslip.solver.method_names import SHIPPED
from microslip.solver.run import Run, Settings
from microslip.solver.simulate import simulate
from microslip.solver.static_run import simulate_static
from microslip.solver.stick_edge import found_focus


class Marched(NamedTuple):
    """Arguments of refine.refine for a contact that is moved.

    Attributes
    ----------
    run : callable
        run(resolution, guess) -> run.Run.
    ladder : ladder.Ladder
        Its resolutions.
    readings : list of callable
        Like `run`, for other pressures that the same numbers may stand for.
    """

    run: Callable
    ladder: Ladder
    readings: list[Callable]


def marched(request: Request) -> Marched:
    """The Marched of a point with a velocity of at least 0.

    Where the search for stick edges takes more than the point may, its run raises budget.Spent.
    """
    problem, motion, tolerance = request.problem, request.problem.motion, request.accuracy
    try:
        focus = found_focus(problem, request.model, request.budget, request.progress)
    except Spent as spent:
        return _nothing_to_run(spent)
    ladder = ladder_for(problem, request.model, tolerance, request.cells, request.steps)
    if request.tolerance is None:
        refuse_free(ladder, request.cells, request.steps)
    share = run_tolerance(tolerance)
    settings = Settings(request.how, budget=request.budget, focus=focus)

    def run(resolution: Resolution, guess: Run | None, problem: Problem = problem) -> Run:
        if request.progress is not None:
            request.progress(resolution)
        if problem.velocity == 0.0 and motion.periodic:
            return simulate_static(problem, request.model, resolution, share, settings)

        def run_at(velocity: float, guess: Run | None, tighter: bool = False) -> Run:
            there = replace(problem, velocity=velocity)
            how_so = replace(settings, tighter=tighter)
            return simulate(there, request.model, resolution, share, guess, how_so)

        if request.method != SHIPPED or not motion.periodic:
            return run_at(problem.velocity, guess)
        return run_safely(run_at, problem.velocity, guess)

    readings: list[Callable] = [
        partial(run, problem=replace(problem, pressure=other))
        for other in problem.pressure.readings
    ]
    return Marched(run, ladder, readings)


def _nothing_to_run(spent: Spent) -> Marched:
    """The Marched of a point whose budget was spent before its first run."""

    def run(resolution: Resolution, guess: Run | None) -> Run:
        raise spent

    return Marched(run, Ladder(1, 0, 0), [])


def solve_moved(request: Request) -> Result:
    """The friction with its error estimate, a result.Result, of a point that has no closed form."""
    problem, (run, ladder, readings) = request.problem, marched(request)
    refined = refine(run, ladder, request.accuracy, readings)
    steady = not problem.motion.periodic
    return Result(
        **request.point,
        model=request.model,
        friction=within_friction(problem, refined.value),
        torque=refined.torque if steady else None,
        **verdict(request, refined, ladder, request.tolerance),
    )


def refuse_choice(problem: Problem, model: str, cells: int | None, steps: int | None) -> None:
    """Raise InputError where a resolution would have to be chosen without a tolerance."""
    exact = no_vibration(problem)
    if exact is None and model == "auto":
        exact = unless_imposed(problem, None, cells, steps)
    if exact is None:
        name = choose_model(problem, model)
        refuse_free(ladder_for(problem, name, TOLERANCE, cells, steps), cells, steps)
