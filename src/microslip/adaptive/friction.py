"""Runs of a contact at a prescribed velocity."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

from microslip.adaptive.continuation import second_attempt
from microslip.adaptive.request import Request
from microslip.estimate.ladder import Ladder, ladder_for, refuse_free
from microslip.estimate.refine import run_tolerance
from microslip.motions.problem import Problem
from microslip.solver.discretise import Resolution
from microslip.solver.method_names import SHIPPED
from microslip.solver.run import Run, Settings
from microslip.solver.simulate import simulate
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


def runs_of(request: Request) -> Callable[[Problem, Resolution, Run | None], Run]:
    """Function that runs a contact at a prescribed velocity of at least 0, see refine.refine.

    The runs raise budget.Spent if the point's budget is exceeded.
    """
    problem, share = request.problem, run_tolerance(request.accuracy)
    once = request.method != SHIPPED or problem.velocity == 0.0 or not problem.motion.periodic

    @cache  # the search for the slip front is charged once
    def settings() -> Settings:
        focus = edge_focus(problem, request.model, request.budget, request.progress)
        return Settings(request.how, budget=request.budget, focus=focus)

    def run(problem: Problem, resolution: Resolution, guess: Run | None) -> Run:
        how = settings()
        request.show(resolution)
        first = simulate(problem, request.model, resolution, share, guess, how)
        if once or first.converged:
            return first
        tighter = replace(how, tighter=True)

        def run_at(velocity: float, guess: Run | None) -> Run:
            there = replace(problem, velocity=velocity)
            return simulate(there, request.model, resolution, share, guess, tighter)

        return second_attempt(first, run_at, problem.velocity)

    return run
