"""Single runs of a model and a method at one resolution, and the cost of a step.

Single runs are used to compare methods.  The results do not include an estimate of the
discretisation error.
"""

from __future__ import annotations

import time
from statistics import median

import numpy as np

from microslip.adaptive.choice import method_refusal
from microslip.models.contact import forward_slip
from microslip.models.path import EULER, half_period_phases, make_path
from microslip.models.registry import MODELS
from microslip.motions.by_name import motion_named
from microslip.motions.named import Bore, Transverse
from microslip.motions.problem import Problem
from microslip.pressures.by_name import pressure_named
from microslip.pressures.hertz import HERTZ
from microslip.solver.discretise import Resolution, contact_of
from microslip.solver.method_names import method_named, missing
from microslip.solver.run import Settings
from microslip.solver.simulate import simulate

STEP_TOLERANCE = 1e-6
"""Step tolerance in measurements of the cost, as a force divided by mu F_z."""


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


def measure_steps(model: str, cells: int, angles: int, poisson: float, steps: int) -> dict:
    """Measure the cost of a backward Euler step.

    The march starts from full slip and covers half a period.  The motion is transverse for rings
    and bore for all other models.  The time is the median of three marches.  A first march compiles
    the code.

    Parameters
    ----------
    model : str
        Name in models.registry.MODELS.
    cells, angles, steps : int
        Numbers of rings, of angular points, and of steps in half a period.
    poisson : float
        Poisson's ratio.

    Returns
    -------
    dict
        Number of unknowns, iterations per step, CPU time per step in seconds, and memory used by
        the arrays of the contact in bytes.
    """
    problem = Problem(Transverse() if model == "radial" else Bore(), 0.1, 1.0, poisson)
    contact = contact_of(problem, model, Resolution(cells, angles, steps))
    path = make_path(problem.displacement, half_period_phases(steps), EULER)
    start = forward_slip(contact)
    contact.march(make_path(problem.displacement, path.phase[:2], EULER), start, STEP_TOLERANCE)
    times = []
    for _ in range(3):
        began = time.process_time()
        march = contact.march(path, start, STEP_TOLERANCE)
        times.append(time.process_time() - began)
    return {
        "unknowns": march.state.size,
        "iterations": march.iterations / march.solves,
        "seconds": median(times) / march.solves,
        "memory": held_bytes(contact),
    }


def held_bytes(thing: object) -> int:
    """Size in bytes of all arrays that an object refers to, directly or indirectly."""
    sizes, stack = {}, [thing]
    while stack:
        one = stack.pop()
        if isinstance(one, np.ndarray):
            base = one if one.base is None else one.base
            if isinstance(base, np.ndarray):
                sizes[id(base)] = base.nbytes
        elif isinstance(one, list | tuple):
            stack += one
        elif type(one).__module__.startswith("microslip"):
            stack += vars(one).values()
    return sum(sizes.values())
