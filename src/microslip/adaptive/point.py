"""The public question and answer: one point, certified."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

from microslip.adaptive.asked import TOLERANCE, Asked, budget_for
from microslip.adaptive.checks import (
    checked_drive,
    checked_point,
    checked_request,
    refuse_bounds,
    refuse_progress,
)
from microslip.adaptive.choice import choose_model, method_refusal
from microslip.adaptive.result import Result
from microslip.adaptive.several import body_of, solve_each
from microslip.foundation.errors import InputError
from microslip.motions.mirror_image import mirror_image
from microslip.solver.method_names import SHIPPED, method_named, refuse_missing
from microslip.solver.problem import Problem


def solve(
    motion: str,
    velocity: float | None = None,
    amplitude: float | None = None,
    *,
    force: float | None = None,
    stiffness: float | None = None,
    mass: float | None = None,
    damping: float | None = None,
    contacts: str | None = None,
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
    motion : str
        What moves: "transverse", "bore", "continuous-bore" or another, with the numbers that its
        name takes.
    velocity : float or None
        The paper's dimensionless group, in units of the pressure's own u_lim; 0: the limit v -> 0;
        None: what is asked for, under a force.  Below 0, for a contact that is pushed back, where
        the motion drives: else friction at -v is that at v with the other sign.
    amplitude : float or None
        The paper's dimensionless group likewise; None for continuous-bore.
    force : float or None
        Prescribed forward force divided by mu times the mean normal load, as mu_macro is.  Give
        either this or the velocity.
    stiffness, mass, damping : float or None
        A spring pulls with the velocity at its far end, over mu F_z / u_lim, a body of a mass, over
        mu F_z / (u_lim omega^2), which a dashpot holds, over mu F_z / (u_lim omega).  Here F_z is
        the reference load, which is the load without oscillation.  A mass may be under a force,
        too.
    contacts : str or None
        Of a body that several contacts carry, such as "phase=0;phase=180": the load of each, over
        that of another, its phase in degrees, and its share of the amplitude, all 1, 0 and 1 if not
        given.  Velocity and amplitude are in units of u_lim of the contact with the mean load, and
        forces over mu times the load of all.
    pressure : str
        "hertz", "power:exponent=1", "file:measured.csv", see microslip.pressures.by_name.
    poisson : float
        Poisson's ratio, 0 to 0.5.
    model : str
        "auto" or a name in models.registry.MODELS.
    tolerance : float or None
        Absolute, on mu_macro; under a force on the velocity, and relative where that is above 1;
        None where cells and steps are imposed and the error is only to be
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
    drive = checked_drive(velocity, force, stiffness, mass, damping)
    motion, velocity, amplitude, poisson = checked_point(
        motion, 0.0 if velocity is None else velocity, amplitude, poisson, pressure, backward=True
    )
    tolerance, cells, steps = checked_request(tolerance, cells, steps)
    refuse_bounds(most_work=most_work, time_limit=time_limit)
    refuse_progress(progress)
    name = choose_model(motion, poisson, model, static=drive is None and velocity == 0.0)
    how = method_named(method)
    _refuse_method(motion, name, method, how)
    asked = Asked(
        problem=body_of(Problem(motion, velocity, amplitude, poisson), contacts),
        model=name,
        chosen=model == "auto",
        method=method,
        how=how,
        tolerance=tolerance,
        cells=cells,
        steps=steps,
        budget=budget_for(name, most_work, time_limit),
        progress=progress,
        started=time.perf_counter(),
    )
    if velocity < 0.0:
        return _seen_from_behind(asked, drive)
    return _answer(asked, drive)


def _answer(asked, drive):
    if drive is None:
        return solve_each(asked)
    from microslip.adaptive.pulled import refuse_pull, solve_pulled  # only now: it takes a while

    refuse_pull(asked, drive)
    return solve_pulled(asked, drive)


def _seen_from_behind(asked, drive):
    """The answer at a velocity below 0: that of the mirror image at the opposite one."""
    problem = asked.problem
    behind = replace(problem, motion=mirror_image(problem.motion), velocity=-problem.velocity)
    answer = _answer(replace(asked, problem=behind), drive)
    return replace(answer, velocity=problem.velocity, mu_macro=-answer.mu_macro)


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


KERNELS = {
    "rings": ({"motion": "transverse"},),
    "angles": (
        {"motion": "transverse", "poisson": 0.3},
        {"motion": "bore"},
        {"motion": "continuous-bore", "amplitude": None, "model": "polar"},
    ),
    "pulled": ({"motion": "transverse", "stiffness": 1.0}, {"motion": "bore", "stiffness": 1.0}),
}
"""Points that need what is compiled, by the name of the kernels."""


def warm_up(*kernels: str) -> None:
    """Compile kernels of the automatic models (and leave them in Numba's cache).

    Takes a while the first time.  Processes that compile different ones may do so side by side.
    Squares are compiled when they are first used.

    Parameters
    ----------
    kernels : str
        Which: "rings", "angles" (of motions that turn, and Poisson's ratios above 0) or "pulled"
        (contacts that a force or a spring pulls).  Rings and angles, unless any is named.

    Raises
    ------
    InputError
        There are no such kernels.
    """
    kernels = kernels or ("rings", "angles")
    for name in kernels:
        if name not in KERNELS:
            raise InputError("kernels", name, f"may be {', '.join(KERNELS)}")
    for name in kernels:
        for case in KERNELS[name]:
            solve(**{"velocity": 0.5, "amplitude": 0.5, "tolerance": 1e-2, **case})
