"""The friction of a contact that is moved forward at a given velocity."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import NamedTuple

from microslip.adaptive.asked import TOLERANCE, Asked, refuse_free, verdict
from microslip.adaptive.chains import Axis
from microslip.adaptive.choice import choose_model
from microslip.adaptive.closed_forms import no_vibration, unless_imposed
from microslip.adaptive.continuation import run_safely
from microslip.adaptive.refinement import certify, run_tolerance
from microslip.adaptive.resolutions import plan
from microslip.adaptive.result import Result
from microslip.motions.problem import Problem
from microslip.solver.budget import Spent
from microslip.solver.discretise import Resolution
from microslip.solver.method_names import SHIPPED
from microslip.solver.run import Settings
from microslip.solver.simulate import simulate
from microslip.solver.static_run import simulate_static
from microslip.solver.stick_edge import found_focus


class Marched(NamedTuple):
    """What refinement.certify asks for, of a contact that is moved.

    Attributes
    ----------
    run : callable
        run(resolution, guess) -> run.Run.
    coarsest : problem.Resolution
        For what is not refined.
    axes : tuple of chains.Axis
        To be refined.
    readings : list of callable
        Like `run`, for other pressures that the same numbers may stand for.
    """

    run: Callable
    coarsest: Resolution
    axes: tuple[Axis, ...]
    readings: list[Callable]


def marched(asked: Asked) -> Marched:
    """The Marched of a point with a velocity of at least 0.

    Where the search for stick edges takes more than the point may, its run raises budget.Spent.
    """
    problem, motion, tolerance = asked.problem, asked.problem.motion, asked.accuracy
    try:
        focus = found_focus(problem, asked.model, asked.budget, asked.progress)
    except Spent as spent:
        return _nothing_to_run(spent)
    coarsest, axes = plan(problem, asked.model, tolerance, asked.cells, asked.steps, together=True)
    if asked.tolerance is None:
        refuse_free(axes)
    share = run_tolerance(coarsest, axes, tolerance)
    settings = Settings(asked.how, budget=asked.budget, focus=focus)

    def run(resolution, guess, problem=problem):
        if asked.progress is not None:
            asked.progress(resolution)
        if problem.velocity == 0.0 and motion.periodic:
            return simulate_static(problem, asked.model, resolution, share, settings)

        def run_at(velocity, guess, tighter=False):
            there = replace(problem, velocity=velocity)
            how_so = replace(settings, tighter=tighter)
            return simulate(there, asked.model, resolution, share, guess, how_so)

        if asked.method != SHIPPED or not motion.periodic:
            return run_at(problem.velocity, guess)
        return run_safely(run_at, problem.velocity, guess)

    readings = [
        partial(run, problem=replace(problem, pressure=other))
        for other in problem.pressure.readings
    ]
    return Marched(run, coarsest, axes, readings)


def _nothing_to_run(spent):
    """The Marched of a point whose budget was spent before its first run."""

    def run(resolution, guess):
        raise spent

    return Marched(run, Resolution(0, 0, 0), (), [])


def solve_moved(asked: Asked) -> Result:
    """The certified friction, a result.Result, of a point that has no closed form."""
    problem, (run, coarsest, axes, readings) = asked.problem, marched(asked)
    certified = certify(run, coarsest, axes, asked.accuracy, readings)
    steady = not problem.motion.periodic
    return Result(
        **asked.point,
        model=asked.model,
        mu_macro=_within(problem, certified.mu),
        mu_macro_error=certified.error,
        mu_torque=certified.torque if steady else None,
        mu_torque_error=certified.torque_error + certified.errors["periodicity"]
        if steady
        else None,
        **verdict(asked, certified, axes, asked.tolerance),
    )


def _within(problem, mu):
    """A mean force brought to where it can be: what lies beyond is rounding and error."""
    least = -1.0 if problem.propels else 0.0
    return min(max(mu, least), 1.0) if math.isfinite(mu) else math.nan


def refuse_choice(problem: Problem, model: str, cells: int | None, steps: int | None) -> None:
    """Raise InputError where a resolution would have to be chosen without a tolerance."""
    exact = no_vibration(problem)
    if exact is None and model == "auto":
        exact = unless_imposed(problem, None, cells, steps)
    if exact is None:
        refuse_free(plan(problem, choose_model(problem, model), TOLERANCE, cells, steps)[1])
