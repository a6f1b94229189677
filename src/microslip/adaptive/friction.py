"""Friction of a contact at a prescribed velocity, with its error estimate."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from microslip.adaptive.continuation import run_safely
from microslip.adaptive.request import Request, result_of_runs
from microslip.adaptive.result import Result
from microslip.estimate.ladder import Ladder, ladder_for, refuse_free
from microslip.estimate.refine import Levels, refine, run_tolerance
from microslip.motions.problem import Problem
from microslip.solver.discretise import Resolution
from microslip.solver.method_names import SHIPPED
from microslip.solver.run import Run, Settings
from microslip.solver.simulate import simulate
from microslip.solver.static_run import simulate_static
from microslip.solver.stick_edge import edge_focus


def ladder_of(request: Request, tolerance: float) -> Ladder:
    """Ladder for the problem of a request.

    Raises InputError if a resolution would have to be chosen without a tolerance of the request.
    """
    imposed = request.cells, request.steps
    ladder = ladder_for(request.problem, request.model, tolerance, *imposed)
    if request.tolerance is None:
        refuse_free(ladder, *imposed)
    return ladder


def levels_for(request: Request) -> Levels:
    """Runs of a contact at a prescribed velocity of at least 0.

    The runs raise budget.Spent if the point's budget is exceeded.
    """
    problem, motion = request.problem, request.problem.motion
    share = run_tolerance(request.accuracy)

    @cache  # the search for the slip front is charged once
    def settings() -> Settings:
        focus = edge_focus(problem, request.model, request.budget, request.progress)
        return Settings(request.how, budget=request.budget, focus=focus)

    def run(problem: Problem, resolution: Resolution, guess: Run | None) -> Run:
        how = settings()
        request.show(resolution)
        if problem.velocity == 0.0 and motion.periodic:
            return simulate_static(problem, request.model, resolution, share, how)

        def run_at(velocity: float, guess: Run | None, tighter: bool = False) -> Run:
            there = replace(problem, velocity=velocity)
            how_tight = replace(how, tighter=tighter)
            return simulate(there, request.model, resolution, share, guess, how_tight)

        if request.method != SHIPPED or not motion.periodic:
            return run_at(problem.velocity, guess)
        return run_safely(run_at, problem.velocity, guess)

    return Levels(run, ladder_of(request, request.accuracy), problem, *problem.readings)


def solve_friction(request: Request) -> Result:
    """Compute the Result of a contact at a prescribed velocity, by runs of a model."""
    unit = request.problem.largest_energy
    refined = refine(levels_for(request), request.accuracy, energy_unit=unit)
    return result_of_runs(request, refined, request.tolerance)
