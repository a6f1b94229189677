"""One run of any model by any method at one resolution, and what a step costs at any size.

For comparing methods: a trial is not certified, its number is as good as its resolution.
"""

from __future__ import annotations

import time
from statistics import median

import numpy as np

from microslip.adaptive.choice import method_refusal
from microslip.models.contact import forward_slip
from microslip.models.path import EULER, half_period_phases, make_path
from microslip.models.registry import MODELS
from microslip.motions.bore import Bore
from microslip.motions.by_name import motion_named
from microslip.motions.problem import Problem
from microslip.motions.transverse import Transverse
from microslip.pressures.by_name import pressure_named
from microslip.pressures.hertz import HERTZ
from microslip.solver.discretise import Resolution, build_contact
from microslip.solver.method_names import method_named, missing
from microslip.solver.run import Settings
from microslip.solver.simulate import simulate

STEP_TOLERANCE = 1e-6


def applies(
    motion: str, poisson: float, model: str, method: str, pressure: str = HERTZ.name
) -> str:
    """Why a model or a method, by name, cannot be tried on a motion, as one line; "" if it can."""
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
    """One run; nothing in it depends on the machine.

    Parameters
    ----------
    motion, velocity, amplitude, poisson, model, method, pressure
        As for `microslip.solve`.
    cells : int
        Rings, or squares along a side.
    angles : int
        On half the disc.
    steps : int
        In a full period.
    tolerance : float
        On the periodic state, a force over mu F_z.

    Returns
    -------
    dict
        - mu_macro: NaN if there is none.
        - converged, reason: whether the state is periodic, and why not.
        - periods: full ones, of all searches together.
        - iterations, solves, unknowns: of the step solver.
        - work, effort: solves x unknowns, and iterations x unknowns.

    Raises
    ------
    ValueError
        Where `applies` says why.
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

    The path is half a period from full slip, transverse for rings, else bore, each step solved to
    1e-6 of mu F_z.  Times are the median of three marches, after one that compiles.

    Parameters
    ----------
    model : str
        Name in models.registry.MODELS.
    cells, angles, steps : int
        Rings and angular points of the model, and steps in half a period.
    poisson : float
        Poisson's ratio.

    Returns
    -------
    dict
        unknowns; iterations and seconds (CPU) a step; memory, the bytes that the arrays of the
        contact take.
    """
    problem = Problem(Transverse() if model == "radial" else Bore(), 0.1, 1.0, poisson)
    contact = build_contact(problem, model, Resolution(cells, angles, steps))
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
    """Bytes in the arrays that an object holds, whatever holds them, each counted once."""
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
