"""Single runs of a model and a method at one resolution.

Single runs are used to compare methods.  The results do not include an estimate of the
discretisation error.
"""

from __future__ import annotations

from microslip.adaptive.choice import method_refusal
from microslip.contact.registry import MODELS
from microslip.motions.by_name import motion_named
from microslip.motions.problem import Problem
from microslip.pressures.by_name import pressure_named
from microslip.pressures.hertz import HERTZ
from microslip.solver.discretise import Resolution
from microslip.solver.method_names import method_named, missing
from microslip.solver.run import Settings
from microslip.solver.simulate import simulate


def applies(
    motion: str, poisson: float, model: str, method: str, pressure: str = HERTZ.name
) -> str:
    """Reason why a model or a method does not apply to a motion; empty if both apply."""
    kind = motion_named(motion)
    amplitude = 1.0 if kind.periodic else None
    problem = Problem(kind, 1.0, amplitude, poisson, pressure_named(pressure))
    refusal = MODELS[model].refuses(problem) or missing(method)
    return refusal or method_refusal(problem, model, method_named(method))


def run_trial(
    motion: str,
    velocity: float,
    amplitude: float,
    *,
    poisson: float,
    model: str,
    method: str,
    cells: int,
    angles: int,
    steps: int,
    tolerance: float,
    pressure: str = HERTZ.name,
) -> dict:
    """Run a model with a method at one resolution.  The result does not depend on the machine.

    Parameters
    ----------
    motion, velocity, amplitude, poisson, model, method, pressure
        See `microslip.solve`.
    cells : int
        Number of rings, or of squares along a side.
    angles : int
        Number of angular points on half the disc.
    steps : int
        Number of steps in a full period.
    tolerance : float
        Tolerance of the periodic state, as a force divided by mu F_z.

    Returns
    -------
    dict
        - mu_macro: mean friction; NaN if the run failed.
        - converged, reason: whether the state is periodic, and the reason if it is not.
        - periods: number of full periods in all searches.
        - iterations, solves, unknowns: number of iterations of the step solver, of step solves, and
          of unknowns in a step.
        - work, effort: number of solves times unknowns, and number of iterations times unknowns.

    Raises
    ------
    ValueError
        If the model or the method does not apply.
    """
    refusal = applies(motion, poisson, model, method, pressure)
    if refusal:
        raise ValueError(f"model = {model!r}, method = {method!r}: {refusal}")
    resolution = Resolution(cells, angles, max(steps // 2, 1))
    problem = Problem(motion_named(motion), velocity, amplitude, poisson, pressure_named(pressure))
    settings = Settings(method_named(method))
    run = simulate(problem, model, resolution, tolerance, settings=settings)
    effort = run.effort
    unknowns = effort.work // effort.solves if effort.solves else 0
    return {
        "mu_macro": float(run.mu),
        "converged": bool(run.converged),
        "reason": run.reason,
        "periods": run.periods,
        "iterations": effort.iterations,
        "solves": effort.solves,
        "unknowns": unknowns,
        "work": effort.work,
        "effort": effort.updates,
    }
