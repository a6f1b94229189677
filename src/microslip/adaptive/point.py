"""The public question and answer: one point, certified; a force history; a traction field."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial

from microslip.adaptive.choice import choose_model, method_refusal
from microslip.adaptive.closed_forms import closed_form, no_vibration
from microslip.adaptive.continuation import run_safely
from microslip.adaptive.refinement import certify
from microslip.adaptive.resolutions import plan
from microslip.adaptive.result import Result, of_closed_form
from microslip.foundation.arguments import LARGEST, count, is_real, real
from microslip.foundation.errors import InputError
from microslip.motions.by_name import motion_named, read_otherwise
from microslip.motions.motion import Motion
from microslip.solver.budget import Budget
from microslip.solver.method_names import SHIPPED, method_named, refuse_missing
from microslip.solver.problem import Problem
from microslip.solver.run import Settings
from microslip.solver.simulate import simulate
from microslip.solver.static_run import simulate_static

PERIODICITY_SHARE = 0.07
"""Share of the tolerance that the distance from the periodic state may take."""
SMALLEST_TOLERANCE = 1e-6
CLOSED_FORM = "closed-form"
TOLERANCE = 1e-3
"""Unless told otherwise; and how strict the search for a periodic state is where none is meant."""
MOST_WORK = {"polar": 2e9, "cartesian": 2e9}
MOST_WORK_OF_OTHERS = 2e8
"""Work, by model, beyond which a point is given up unless told otherwise: more than ten times what
the slowest points of the paper's range take at the tolerance 1e-4.  Rings have few unknowns, and
each of them takes longer."""


def solve(
    scene: str,
    velocity: float,
    amplitude: float | None = None,
    *,
    pressure: str = "hertz",
    poisson: float = 0.0,
    model: str = "auto",
    tolerance: float | None = TOLERANCE,
    cells: int | None = None,
    steps: int | None = None,
    method: str = SHIPPED,
    most_work: float | None = None,
    time_limit: float | None = None,
    progress: Callable | None = None,
) -> Result:
    """Macroscopic friction of a vibrated contact at one point.

    Parameters
    ----------
    scene : str
        What moves: "transverse", "bore", "continuous-bore" or another, with the numbers that its
        name takes.
    velocity : float
        The paper's dimensionless group, in units of the pressure's own u_lim; 0: the limit v -> 0.
    amplitude : float or None
        The paper's dimensionless group likewise; None for continuous-bore.
    pressure : str
        "hertz", "power:exponent=1", "file:measured.csv", see microslip.pressures.by_name.
    poisson : float
        Poisson's ratio, 0 to 0.5.
    model : str
        "auto" or a name in models.registry.MODELS.
    tolerance : float or None
        Absolute, on mu_macro; None where cells and steps are imposed and the error is only to be
        told.
    cells, steps : int or None
        Impose a resolution instead of letting the tolerance choose; steps in a full period.
    method : str
        One of solver.method_names.names(), to be compared with what ships.
    most_work : float or None
        Step solves x unknowns, over all runs, beyond which a point is given up; None: MOST_WORK.
    time_limit : float or None
        Seconds by the wall clock after which it is given up, looked at between marches; None:
        never.
    progress : callable or None
        Called with the Resolution of every run before it starts.

    Returns
    -------
    Result
        `converged` is False, with the reason, where the tolerance was not met, be it that of an
        imposed resolution.  Without a tolerance it says that every run found its periodic state,
        searched for as strictly as at the tolerance 1e-3.

    Raises
    ------
    InputError
        For input out of range or a model that does not apply; it names the argument.
    """
    motion, velocity, amplitude, poisson = checked_point(
        scene, velocity, amplitude, poisson, pressure
    )
    asked, cells, steps = checked_request(tolerance, cells, steps)
    refuse_bounds(most_work=most_work, time_limit=time_limit)
    if progress is not None and not callable(progress):
        raise InputError("progress", progress, "allowed is a function of one argument")
    tolerance = TOLERANCE if asked is None else asked
    name, how = choose_model(motion, poisson, model), method_named(method)
    _refuse_method(motion, name, method, how)
    started = time.perf_counter()
    point = {
        "scene": motion.name,
        "pressure": motion.pressure.name,
        "velocity": velocity,
        "amplitude": amplitude,
        "poisson": poisson,
        "tolerance": asked,
        "method": method,
    }
    problem = Problem(motion, velocity, amplitude, poisson)
    exact = no_vibration(motion, amplitude)
    if exact is None and model == "auto" and method == SHIPPED:
        exact = _exact(problem, asked, cells, steps)
    if exact is not None:
        used = CLOSED_FORM if model == "auto" else name
        return of_closed_form(point | {"model": used}, exact, time.perf_counter() - started)
    coarsest, axes = plan(problem, name, tolerance, cells, steps)
    imposed, names = any(axis.imposed for axis in axes), [axis.name for axis in axes]
    if asked is None:
        _refuse_free(axes)
    share = PERIODICITY_SHARE * tolerance
    if most_work is None:
        most_work = MOST_WORK.get(name, MOST_WORK_OF_OTHERS)
    budget = Budget(most_work, math.inf if time_limit is None else time_limit)

    settings = Settings(how, budget=budget)

    def run(resolution, guess, problem=problem):
        if progress is not None:
            progress(resolution)
        if velocity == 0.0 and motion.periodic:
            return simulate_static(problem, name, resolution, share, settings)

        def run_at(velocity, guess, tighter=False):
            there = replace(problem, velocity=velocity)
            how_so = replace(settings, tighter=tighter)
            return simulate(there, name, resolution, share, guess, how_so)

        if method != SHIPPED or not motion.periodic:
            return run_at(velocity, guess)
        return run_safely(run_at, velocity, guess)

    readings = [
        partial(run, problem=replace(problem, motion=other)) for other in read_otherwise(motion)
    ]
    certified = certify(run, coarsest, axes, tolerance, readings)
    if budget.exhausted:
        certified = replace(certified, **budget.counts())
    steady = not motion.periodic
    within = asked is None or certified.error <= asked
    reason = certified.reason
    if certified.converged and not within:
        where = "at the imposed resolution the error" if imposed else "the estimated error"
        reason = f"{where} is {certified.error:.1e}, above the tolerance of {asked:g}"
        left_open = certified.errors.get("model", 0.0)
        if left_open > 0.5 * certified.error:
            reason += f": the file's own resolution leaves {left_open:.1e} open"
    return Result(
        **point,
        model=name,
        mu_macro=_within(motion, certified.mu),
        mu_macro_error=certified.error,
        **{f"error_{source}": error for source, error in certified.errors.items()},
        mu_torque=certified.torque if steady else None,
        mu_torque_error=certified.torque_error + certified.errors["periodicity"]
        if steady
        else None,
        converged=bool(certified.converged and within),
        periodic=certified.periodic,
        reason=reason,
        cells=certified.finest.cells,
        angles=certified.finest.angles,
        steps_per_period=2 * certified.finest.steps if "steps" in names else 0,
        periods=certified.periods,
        iterations=certified.iterations,
        work=certified.work,
        effort=certified.effort,
        retried=certified.retried,
        exhausted=budget.exhausted,
        solve_time_s=time.perf_counter() - started,
    )


def _within(motion, mu):
    """A mean force brought to where it can be: what lies beyond is rounding and error."""
    least = -1.0 if motion.drives else 0.0
    return min(max(mu, least), 1.0) if math.isfinite(mu) else math.nan


def checked_point(
    scene: str, velocity: float, amplitude: float | None, poisson: float, pressure: str = "hertz"
) -> tuple[Motion, float, float | None, float]:
    """Motion record and numbers of a point; raises InputError naming the argument at fault."""
    motion = motion_named(scene, pressure)
    velocity = real("velocity", velocity, 0.0, LARGEST["velocity"])
    poisson = real("poisson", poisson, 0.0, 0.5)
    if motion.periodic:
        if amplitude is None:
            raise InputError("amplitude", None, f"{motion.name} needs an amplitude >= 0")
        amplitude = real("amplitude", amplitude, 0.0, LARGEST["amplitude"])
    elif amplitude is not None:
        raise InputError("amplitude", amplitude, f"{motion.name} has no amplitude")
    return motion, velocity, amplitude, poisson


def checked_request(
    tolerance: float | None, cells: int | None, steps: int | None
) -> tuple[float | None, int | None, int | None]:
    """Tolerance, if any, and imposed resolution; raises InputError naming the argument at fault."""
    cells, steps = _count("cells", cells, 4), _count("steps", steps, 8)
    if tolerance is not None:
        tolerance = real("tolerance", tolerance, SMALLEST_TOLERANCE, 0.1)
    return tolerance, cells, steps


def refuse_choice(
    motion: Motion, model: str, place: tuple, cells: int | None, steps: int | None
) -> None:
    """Raise InputError where a resolution would have to be chosen, and there is no tolerance to do
    that; place: velocity, amplitude, poisson, and all as checked."""
    problem = Problem(motion, *place)
    exact = no_vibration(motion, problem.amplitude)
    if exact is None and model == "auto":
        exact = _exact(problem, None, cells, steps)
    if exact is None:
        name = choose_model(motion, problem.poisson, model)
        _refuse_free(plan(problem, name, TOLERANCE, cells, steps)[1])


def _exact(problem, asked, cells, steps):
    """As `closed_form`, but that an imposed resolution is to be run, if anything is marched."""
    if problem.velocity > 0.0 and not (cells is None and steps is None):
        return None
    return closed_form(problem, asked or 0.0)


def _refuse_free(axes):
    """Raise InputError where a tolerance would have to choose the cells or the steps."""
    free = [name for axis in axes if not axis.imposed for name in axis.refines if name != "angles"]
    if free:
        what = " and ".join(free)
        allowed = f"allowed is a number, or none where {what} are imposed"
        raise InputError("tolerance", None, allowed)


def refuse_bounds(**given) -> None:
    """Raise InputError for a bound, None or a number, that is not above 0."""
    for name, value in given.items():
        if value is not None and not (is_real(value) and value > 0.0):
            raise InputError(name, value, "allowed is a number above 0")


def _refuse_method(motion, model, method, how):
    """Raise InputError where a method, by name and as a method.Method, has no part in a solve."""
    refuse_missing(method)
    refusal = method_refusal(motion, model, how)
    if not refusal and how.run is not None:
        refusal = "it is one run, which cannot be refined"
    if refusal:
        raise InputError(
            "method", method, f"does not apply to {motion.name}, model {model}: {refusal}"
        )


def _count(name, value, low):
    return None if value is None else count(name, value, low, most=LARGEST[name], even=True)


def warm_up() -> None:
    """Compile the kernels of the automatic models (and leave them in Numba's cache).

    Takes a while the first time; squares are compiled when they are first used.
    """
    solve("transverse", 0.5, 0.5, tolerance=1e-2)
    solve("transverse", 0.5, 0.5, poisson=0.3, tolerance=1e-2)
    solve("bore", 0.5, 0.5, tolerance=1e-2)
    solve("continuous-bore", 0.5, model="polar", tolerance=1e-2)
