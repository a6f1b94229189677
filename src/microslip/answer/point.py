"""Friction at one point, or velocity under a force, with its error estimate."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from microslip.answer import limits
from microslip.answer.answer import Result, about
from microslip.answer.request import TOLERANCE, answer_of, request_of
from microslip.contact.registry import MODELS
from microslip.periodic.methods import SHIPPED, method_named, missing
from microslip.scene.by_name import motion_named, pressure_named
from microslip.scene.hertz import HERTZ
from microslip.scene.motion import Motion
from microslip.scene.pressure import Pressure
from microslip.scene.problem import Problem


def solve(
    motion: str | Motion | Problem,
    velocity: float | None = None,
    amplitude: float | None = None,
    *,
    force: float | None = None,
    stiffness: float | None = None,
    mass: float | None = None,
    damping: float | None = None,
    pressure: str | Pressure = HERTZ,
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
    """Compute the macroscopic friction of a vibrated contact, or its velocity under a force.

    Parameters
    ----------
    motion : str, Motion or Problem
        "transverse", "bore", "continuous-bore" or another motion, with its parameters, such as
        "elliptic:forward=0.5".  A Problem replaces all arguments up to `poisson`.
    velocity : float or None
        The paper's dimensionless velocity, in units of u_lim of the pressure.  Use 0 for the static
        limit, and None under a prescribed force, which determines the velocity.  Negative
        velocities are allowed for self-propelled motions; for other motions, the friction at -v is
        minus the friction at v.
    amplitude : float or None
        The paper's dimensionless amplitude; None for steady motions.
    force : float or None
        Prescribed forward force divided by mu times the mean normal load.  Give either this or
        `velocity`.
    stiffness, mass, damping : float or None
        Stiffness of a spring that pulls the body, in units of mu F_z / u_lim; the far end of the
        spring moves at `velocity`.  Mass of the body, in units of mu F_z / (u_lim omega^2); it can
        also be combined with a force.  Damping of a dashpot parallel to the spring, in units of mu
        F_z / (u_lim omega).  F_z is the normal load without oscillation.
    pressure : str or Pressure
        Pressure, such as "hertz", "power:exponent=1" or "file:measured.csv", see
        microslip.scene.by_name.
    poisson : float
        Poisson's ratio, 0 to 0.5.
    model : str
        "auto" or a name in contact.registry.MODELS.
    tolerance : float or None
        Absolute tolerance of mu_macro.  Under a prescribed force, it is the tolerance of the
        velocity, and relative if the velocity is above 1.  If cells and steps are imposed, the
        tolerance can be None, and any error is then accepted.
    cells, steps : int or None
        Imposed numbers of cells and of steps per full period.  By default, they are chosen
        according to the tolerance.
    method : str
        Numerical method: "shipped", or another name in periodic.methods.names() for a comparison.
    most_work : float or None
        Limit on the work of all runs together.  The work of a run is its number of step solves
        times its number of unknowns.  Defaults to MOST_WORK.
    time_limit : float or None
        Limit on the wall-clock time in seconds, checked after each time integration.  None means no
        limit.
    progress : callable or None
        Called before every run, with the run's Resolution.

    Returns
    -------
    Result
        The result.  If the error estimate exceeds the tolerance, even at an imposed resolution,
        `converged` is False and `reason` says why.  Without a tolerance, `converged` is True if
        every run found its periodic state to the accuracy required for a tolerance of 1e-3.

    Raises
    ------
    InputError
        If an argument is out of range or a model does not apply.  The message names the argument.
    """
    drive = {"force": force, "stiffness": stiffness, "mass": mass, "damping": damping}
    problem = limits.problem_of(
        motion, velocity, amplitude, pressure=pressure, poisson=poisson, drive=drive
    )
    request = request_of(
        problem,
        model=model,
        tolerance=tolerance,
        cells=cells,
        steps=steps,
        method=method,
        progress=progress,
        most_work=most_work,
        time_limit=time_limit,
    )
    if problem.force is not None:
        from microslip.answer.force import under_force  # imported here because it loads slowly

        answer = under_force(request)
    elif problem.velocity < 0.0:  # the mirror image
        answer = answer_of(request.at(velocity=-problem.velocity, backward=not problem.backward))
        answer = answer.changed(mean_velocity=-answer.mean_velocity, friction=-answer.friction)
    else:
        answer = answer_of(request)
    if answer.problem is problem:
        return answer
    return replace(answer.changed(**about(problem)), problem=problem)


def warm_up() -> None:
    """Compile the solver for round contacts, so that Numba caches the compiled code.

    The first compilation takes a while.  The kernels for contacts resolved by squares are compiled
    at their first use.
    """
    for motion in ("transverse", "bore"):
        solve(motion, 0.5, 0.5, tolerance=1e-2)


# Single runs, which compare methods


def applies(motion: str, poisson: float, model: str, method: str, pressure: str = "hertz") -> str:
    """Return the reason why a model or a method does not apply to a motion, or "" if both apply."""
    kind = motion_named(motion)
    amplitude = 1.0 if kind.periodic else None
    problem = Problem(kind, 1.0, amplitude, poisson, pressure_named(pressure))
    refusal = MODELS[model].refuses(problem) or missing(method)
    return refusal or limits.method_refusal(problem, model, method)


def run_trial(
    motion: str,
    velocity: float,
    amplitude: float | None,
    *,
    poisson: float,
    model: str,
    method: str,
    tolerance: float,
    pressure: str = "hertz",
    **sizes: int,
) -> dict:
    """Run a model with a numerical method at one resolution.

    The result does not depend on the machine.

    Parameters
    ----------
    motion, velocity, amplitude, poisson, model, method, pressure
        See `microslip.solve`.
    tolerance : float
        Tolerance of the periodic state, as a force divided by mu F_z.
    **sizes : int
        cells: number of rings, or of squares along a side; angles: number of angular points on half
        the disc; steps: number of steps in a full period.

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
    # imported here because they load compiled code
    from microslip.periodic.discretise import Resolution
    from microslip.periodic.run import Settings
    from microslip.periodic.simulate import simulate

    resolution = Resolution(sizes["cells"], sizes["angles"], max(sizes["steps"] // 2, 1))
    problem = Problem(motion_named(motion), velocity, amplitude, poisson, pressure_named(pressure))
    settings = Settings(method_named(method))
    run = simulate(problem, model, resolution, tolerance, settings=settings)
    effort = run.effort
    return {
        "mu_macro": float(run.mu),
        "converged": bool(run.converged),
        **{"reason": run.reason, "periods": run.periods},
        **{"iterations": effort.iterations, "solves": effort.solves},
        "unknowns": effort.work // effort.solves if effort.solves else 0,
        **{"work": effort.work, "effort": effort.updates},
    }
