"""The public question and answer: one point, certified; a force history; a traction field."""

from __future__ import annotations

import math
import time
from dataclasses import asdict, dataclass
from functools import partial

import numpy as np

from microslip.accuracy import certify
from microslip.approach import run_safely
from microslip.choice import choose_model, closed_form, method_refusal, no_vibration, plan
from microslip.errors import InputError
from microslip.methods import SHIPPED, method_named, refuse_missing
from microslip.scenes import read_otherwise, scene_named
from microslip.simulate import simulate
from microslip.static_run import simulate_static

PERIODICITY_SHARE = 0.07
"""Share of the tolerance that the distance from the periodic state may take."""
SMALLEST_TOLERANCE = 1e-6
LARGEST = {"velocity": 1e6, "amplitude": 1e6, "cells": 1000, "steps": 1_000_000}
"""What is larger is a slip, and would run out of memory or of the range of floating-point numbers;
a test keeps them as in the schema of configurations."""
CLOSED_FORM = "closed-form"


@dataclass(frozen=True)
class Result:
    """Friction at one point, and how far to trust it.  All numbers dimensionless.

    mu_macro: mean forward force over mu F_z; mu_macro_error: sum of the five errors that follow it
    (error_model: of a closed form, and what the resolution of a pressure from a file leaves open;
    else 0); mu_torque, mu_torque_error: torque over its value at
    zero forward velocity (steady scenes only, else None); cells, angles, steps_per_period: finest
    resolution used (angles: points on half the disc, 1 where rings or squares suffice); periods:
    half periods marched in the longest run; iterations, work, effort: step-solver
    iterations, step solves x unknowns, and iterations x unknowns, over all runs; retried: runs that
    found no periodic state at first, and were done again by safer steps.
    """

    scene: str
    pressure: str
    velocity: float
    amplitude: float | None
    poisson: float
    model: str
    tolerance: float
    method: str
    mu_macro: float
    mu_macro_error: float
    error_space: float
    error_time: float
    error_periodicity: float
    error_solver: float
    error_model: float
    mu_torque: float | None
    mu_torque_error: float | None
    converged: bool
    reason: str
    cells: int
    angles: int
    steps_per_period: int
    periods: int
    iterations: int
    work: int
    effort: int
    retried: int
    solve_time_s: float

    def to_dict(self):
        """Fields as a plain dict, without those that the scene does not have."""
        fields = asdict(self)
        return {k: v for k, v in fields.items() if v is not None}


def solve(
    scene,
    velocity,
    amplitude=None,
    *,
    pressure="hertz",
    poisson=0.0,
    model="auto",
    tolerance=1e-3,
    cells=None,
    steps=None,
    method=SHIPPED,
    most_work=math.inf,
    progress=None,
):
    """Macroscopic friction of a vibrated contact at one point.

    scene: "transverse", "bore" or "continuous-bore"; velocity, amplitude: the paper's dimensionless
    groups (amplitude: None for continuous-bore; velocity 0: the limit v -> 0), in units of the
    pressure's own u_lim; pressure: "hertz", "power:exponent=1", "file:measured.csv", see
    microslip.pressures; poisson: nu;
    model: "auto" or a name in models.MODELS; tolerance: absolute, on mu_macro; cells, steps (in a
    full period): impose a resolution instead of letting the tolerance choose; method: one of
    methods.names(), to be compared with what ships; most_work: step solves x unknowns, over all
    runs, beyond which a point is given up; progress: called with the Resolution of every run before
    it starts.
    Returns a Result; ``converged`` is False, with the reason, where the tolerance was not met.
    Raises InputError, naming the argument, for input out of range or a model that does not apply.
    """
    kind, velocity, amplitude, poisson = checked_point(
        scene, velocity, amplitude, poisson, pressure
    )
    tolerance, cells, steps = checked_accuracy(tolerance, cells, steps)
    if not most_work > 0.0:
        raise InputError("most_work", most_work, "allowed is a number above 0")
    name, how = choose_model(kind, poisson, model), method_named(method)
    _refuse_method(kind, name, method, how)
    started = time.perf_counter()
    point = {
        "scene": kind.name,
        "pressure": kind.pressure.name,
        "velocity": velocity,
        "amplitude": amplitude,
        "poisson": poisson,
        "tolerance": tolerance,
        "method": method,
    }
    exact = no_vibration(kind, amplitude)
    # an imposed resolution is to be run, unless there is nothing to march
    free = velocity == 0.0 or (cells is None and steps is None)
    if exact is None and model == "auto" and method == SHIPPED and free:
        exact = closed_form(kind, velocity, amplitude, poisson, tolerance)
    if exact is not None:
        used = CLOSED_FORM if model == "auto" else name
        return _exact_result(point | {"model": used}, exact, time.perf_counter() - started)
    coarsest, axes = plan(kind, name, velocity, amplitude, poisson, tolerance, cells, steps)
    imposed, names = any(axis.imposed for axis in axes), [axis.name for axis in axes]
    share = PERIODICITY_SHARE * tolerance

    def run(resolution, guess, kind=kind):
        if progress is not None:
            progress(resolution)
        if velocity == 0.0 and kind.periodic:
            return simulate_static(kind, amplitude, poisson, name, resolution, share, how)

        def run_at(velocity, guess, careful=False):
            where = (kind, velocity, amplitude, poisson, name, resolution, share)
            return simulate(*where, guess, how, careful)

        if method != SHIPPED or not kind.periodic:
            return run_at(velocity, guess)
        return run_safely(run_at, velocity, guess)

    readings = [partial(run, kind=other) for other in read_otherwise(kind)]
    certified = certify(run, coarsest, axes, tolerance, most_work, readings)
    steady = not kind.periodic
    within = certified.error <= tolerance or imposed
    reason = certified.reason
    if certified.converged and not within:
        reason = f"estimated error {certified.error:.1e} above the tolerance"
        left_open = certified.errors.get("model", 0.0)
        if left_open > 0.5 * certified.error:
            reason += f": the file's own resolution leaves {left_open:.1e} open"
    return Result(
        **point,
        model=name,
        mu_macro=_within(kind, certified.mu),
        mu_macro_error=certified.error,
        **{
            f"error_{source}": error
            for source, error in ({"model": 0.0} | certified.errors).items()
        },
        mu_torque=certified.torque if steady else None,
        mu_torque_error=certified.torque_error + certified.errors["periodicity"]
        if steady
        else None,
        converged=bool(certified.converged and within),
        reason=reason,
        cells=certified.finest.cells,
        angles=certified.finest.angles,
        steps_per_period=2 * certified.finest.steps if "steps" in names else 0,
        periods=certified.periods,
        iterations=certified.iterations,
        work=certified.work,
        effort=certified.effort,
        retried=certified.retried,
        solve_time_s=time.perf_counter() - started,
    )


def _within(kind, mu):
    """A mean force brought to where it can be: what lies beyond is rounding and error."""
    least = -1.0 if kind.drives else 0.0
    return min(max(mu, least), 1.0) if math.isfinite(mu) else math.nan


def checked_point(scene, velocity, amplitude, poisson, pressure="hertz"):
    """Scene record and numbers of a point; raises InputError naming the argument at fault."""
    kind = scene_named(scene, pressure)
    velocity = _number("velocity", velocity, 0.0, LARGEST["velocity"])
    poisson = _number("poisson", poisson, 0.0, 0.5)
    if kind.periodic:
        if amplitude is None:
            raise InputError("amplitude", None, f"{kind.name} needs an amplitude >= 0")
        amplitude = _number("amplitude", amplitude, 0.0, LARGEST["amplitude"])
    elif amplitude is not None:
        raise InputError("amplitude", amplitude, f"{kind.name} has no amplitude")
    return kind, velocity, amplitude, poisson


def checked_accuracy(tolerance, cells, steps):
    """Tolerance and imposed resolution; raises InputError naming the argument at fault."""
    tolerance = _number("tolerance", tolerance, SMALLEST_TOLERANCE, 0.1)
    return tolerance, _count("cells", cells, 4), _count("steps", steps, 8)


def _refuse_method(kind, model, method, how):
    """Raise InputError where a method, by name and as a method.Method, has no part in a solve."""
    refuse_missing(method)
    refusal = method_refusal(kind, model, how)
    if not refusal and how.run is not None:
        refusal = "it is one run, which cannot be refined"
    if refusal:
        raise InputError(
            "method", method, f"does not apply to {kind.name}, model {model}: {refusal}"
        )


def _number(name, value, low, high=math.inf):
    if isinstance(value, bool) or not isinstance(value, int | float | np.integer | np.floating):
        raise InputError(name, value, "allowed is a number")
    try:
        real = float(value)
    except OverflowError:  # a whole number of more than 308 digits
        real = math.inf
    if not (math.isfinite(real) and low <= real <= high):
        upper = f" and at most {high:g}" if high < math.inf else ""
        raise InputError(name, value, f"allowed is a finite number of at least {low:g}{upper}")
    return real


def _count(name, value, low):
    if value is None:
        return None
    whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
    if not whole or not low <= value <= LARGEST[name]:
        most = f"{LARGEST[name]:g}"
        raise InputError(
            name, value, f"allowed is an even whole number of at least {low} and at most {most}"
        )
    if value % 2:
        raise InputError(name, value, "allowed is an even number (half of it is run, too)")
    return int(value)


def _exact_result(point, values, seconds):
    mu, torque, error = values
    return Result(
        **point,
        mu_macro=mu,
        mu_macro_error=error,
        error_space=0.0,
        error_time=0.0,
        error_periodicity=0.0,
        error_solver=0.0,
        error_model=error,
        mu_torque=torque,
        mu_torque_error=None if torque is None else error,
        converged=True,
        reason="",
        cells=0,
        angles=0,
        steps_per_period=0,
        periods=0,
        iterations=0,
        work=0,
        effort=0,
        retried=0,
        solve_time_s=seconds,
    )


def warm_up():
    """Compile the kernels of the automatic models (and leave them in Numba's cache).

    Takes a while the first time; squares are compiled when they are first used.
    """
    solve("transverse", 0.5, 0.5, tolerance=1e-2)
    solve("transverse", 0.5, 0.5, poisson=0.3, tolerance=1e-2)
    solve("bore", 0.5, 0.5, tolerance=1e-2)
    solve("continuous-bore", 0.5, model="polar", tolerance=1e-2)
