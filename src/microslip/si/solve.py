"""Compute dimensionless results for a contact, either with the solver or from a map.  The module
also finds the amplitude, speed or load that gives a requested reduction of friction."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from microslip.answer import limits
from microslip.answer.answer import Estimate, Result
from microslip.answer.point import solve
from microslip.contact.registry import MODELS
from microslip.foundation import arguments
from microslip.foundation.errors import InputError, shown
from microslip.foundation.number_text import number_text
from microslip.scene.hertz import HERTZ
from microslip.scene.motion import PLANE, ROUNDING, Motion
from microslip.scene.named import Transverse
from microslip.scene.problem import Problem
from microslip.scene.samples import Sampled
from microslip.si.contact import INPUT_OF, Contact, contact_of
from microslip.si.inputs import Inputs
from microslip.si.output import Prediction, Value

TOLERANCE, TOLERANCE_OF_SPEED = 1e-3, 1e-2
"""Default tolerance of mu_macro, and default relative tolerance of the speed under a force."""
STATIC_TOLERANCE = 1e-3
"""Largest accepted error of the static limit under a force, dimensionless."""
TOLERANCE_OF_SEVERAL = 1e-2
"""Smallest dimensionless tolerance of the static limit, for a motion with several oscillations.  To
reach a smaller tolerance, the solver would need more than a minute."""
SLOWEST = 1e-3
"""Dimensionless velocity below which the accepted error is absolute instead of relative."""
MARGIN = 0.8
"""The accepted error is multiplied by this safety factor to obtain the tolerance of a second run.
The factor is below 1 because the velocity of the second run can be smaller than the velocity of the
first run."""
RUNS_AWAY = "runs away"
"""If the contact accelerates without limit, the solver returns a reason that begins with these
words."""
MAP = "map"
"""Model name in a Result that comes from a map."""
AMPLITUDES = 1e-6, 1e4
"""Smallest and largest dimensionless amplitude of the search."""
SPEEDS = 1e-9, 1e6
"""Smallest and largest dimensionless velocity of the search.  For a translation with an amplitude
above 1, the velocity is divided by the amplitude."""
LOAD = 1e-12
"""Load, in N, at which the dimensionless groups are computed in a search for the load.  This load
is so small that Hertz's theory applies to all bodies."""
STEP = 0.05
"""Step with which the slope of friction is computed by finite differences.  The step is a change of
the logarithm of the unknown."""


class NoSolutionError(InputError):
    """The requested reduction is outside the range of the search."""


class _SolverFailureError(Exception):
    """The solver failed at a point of the search."""


def answer_of(contact: Contact) -> Prediction:
    """Solve a contact.  Raises InputError.

    Returns
    -------
    Prediction
        The dimensionless result.  Its values are: friction, the mean forward force divided by mu
        times the mean load; velocity; static, the friction in the limit of vanishing velocity;
        threshold, the smallest constant force that moves the contact, and largest_force, the
        smallest constant force at which it runs away, both divided by mu times the mean load;
        mean_load, divided by the load without oscillation; torque, divided by mu F_z a; dissipation
        per period, divided by mu F_z u_lim; displacement until rest, divided by u_lim; and cycles
        until rest.  Unknown values are missing.
    """
    forced = contact.inputs.force is not None
    accepted = contact.inputs.tolerance or (TOLERANCE_OF_SPEED if forced else TOLERANCE)
    limit = None if contact.steady else static_limit(contact)
    threshold = _threshold(contact, limit)
    result = _friction(contact, limit, threshold, accepted)
    if result.model == MAP and not result.converged:
        where = f"velocity {result.velocity:.3g}"
        where += "" if result.amplitude is None else f", amplitude {result.amplitude:.3g}"
        raise InputError("map", result.motion, f"at {where}: {result.reason}")
    estimates: dict[str, Estimate | None] = {"friction": result.friction, "threshold": threshold}
    estimates |= {"velocity": result.mean_velocity, "static": limit.friction if limit else None}
    if result.converged:
        torque = contact.shape.torque * result.torque if result.torque else None
        estimates |= {"torque": torque, "dissipation": result.dissipation}
    values = {"mean_load": Value(contact.mean_load)}
    values |= {n: Value(one.value, one.error) for n, one in estimates.items() if one is not None}
    outcome, unknown = None, ""
    if forced:
        values["largest_force"] = Value(largest_force(contact))
        outcome = _outcome(contact, result)
    if outcome == "stays" and not contact.steady:
        rest, unknown = _rest(contact)
        values |= rest
    about = {name: getattr(result, name) for name in ("model", "converged", "reason")}
    about |= {"mu_static_reason": limit.reason if limit else "", "displacement_reason": unknown}
    return Prediction(values=values, outcome=outcome, **about)


def solve_at(contact: Contact, velocity: float | None, tolerance: float, **drive: float) -> Result:
    """Return the `Result` for a contact, computed by microslip.solve or interpolated in a map.

    The arguments `velocity` and `drive` have the same meaning as for `problem_of`.  If an
    InputError is raised, it names the corresponding input of `predict`.
    """
    inputs = contact.inputs
    try:
        problem = problem_of(contact, velocity, **drive)
        if inputs.map is not None:
            friction = FrictionMap(inputs.map, problem.motion.name, contact.pressure)
            return friction.solve(problem, tolerance)
        return solve(problem, tolerance=tolerance)
    except InputError as error:
        name = INPUT_OF.get(error.argument, "")
        if not drive or name not in inputs.quantities:
            raise
        group = f"{error.value:.6g}" if isinstance(error.value, float) else shown(error.value)
        raise inputs.error(name, f"dimensionless {group}: {error.allowed}") from None


def problem_of(contact: Contact, velocity: float | None = 0.0, **drive: float) -> Problem:
    """Return the dimensionless Problem.

    velocity: dimensionless velocity, 0 for the limit of vanishing speed; None under a prescribed
    force.  A velocity above the range of the solver is replaced by the largest allowed velocity, at
    which the vibration has no effect.
    drive: dimensionless force, stiffness, mass and damping.
    """
    if velocity is not None:
        velocity = min(velocity, arguments.LARGEST["velocity"])
    size = None if contact.steady else float(contact.amplitude)
    body: dict[str, Any] = {"poisson": float(contact.poisson), "pressure": contact.pressure}
    return limits.problem_of(contact.motion, velocity, size, **body, drive=drive or None)


def static_limit(contact: Contact) -> Result:
    """Compute mu_macro in the limit of vanishing speed."""
    tolerance = contact.inputs.tolerance or TOLERANCE
    if contact.inputs.force is not None:  # the tolerance applies to the speed here
        tolerance = min(tolerance, STATIC_TOLERANCE)
    if contact.kind.several:
        tolerance = max(tolerance, TOLERANCE_OF_SEVERAL)
    return solve_at(contact, 0.0, tolerance)


def largest_force(contact: Contact) -> float:
    """Return the smallest constant force at which the contact slides away without limit.  The force
    is divided by mu times the mean load.

    For a body with a mass, the result is 1.  Otherwise, the result is the smallest normal load in a
    period, divided by the mean load.
    """
    return 1.0 if contact.inputs.mass else min(1.0, limits.least_load(problem_of(contact)))


def _threshold(contact: Contact, limit: Result | None) -> Estimate | None:
    """Return the smallest constant force that moves the contact, divided by mu times the mean load.

    The threshold equals the static limit if the oscillation exerts no forward force.  If the
    oscillation exerts a forward force, a contact without mass follows the forward oscillation.  In
    this case, the threshold is the static limit of the other components of the motion, or 1 if
    there are no other components.  This static limit is computed only if a force is prescribed.
    The threshold is None if it is unknown.
    """
    if limit is None:
        return Estimate(0.0)  # under a steady spin any force moves the contact
    problem, mass = problem_of(contact), contact.inputs.mass
    if not limits.oscillates_forward(problem) or limits.is_even(problem):
        return limit.friction
    held = limits.without_forward_motion(problem)
    if not mass and not limits.oscillates(held):
        return Estimate(1.0)
    if mass or contact.inputs.force is None or not limits.is_even(held):
        return None
    return solve(held, tolerance=STATIC_TOLERANCE).friction


def _friction(
    contact: Contact, limit: Result | None, threshold: Estimate | None, tolerance: float
) -> Result:
    """Compute the friction at a prescribed speed, or the velocity under a prescribed force.

    If the force is below the threshold by more than the threshold's error, the contact comes to
    rest, and no drift is computed.  If the force differs from the threshold by less than the error
    of the threshold, the result is not converged.  The speed is then so small that the solver would
    need minutes to compute the speed.
    """
    groups = contact.drive(contact.mean_load)
    drive: dict[str, Any] = within_range(groups)
    if "force" not in drive:
        if contact.velocity == 0.0 and not drive and limit and limit.tolerance == tolerance:
            return limit  # the same problem
        return solve_at(contact, contact.velocity, tolerance, **drive)
    force, gap, error = groups["force"], math.inf, 0.0
    if threshold is not None:
        gap, error = force - threshold.value, threshold.error
    if gap <= -error and force < largest_force(contact) and limit and limit.converged:
        still = {"mean_velocity": Estimate(0.0), "friction": Estimate(force)}
        return limit.changed(**still, **groups)
    result = solve_at(contact, None, tolerance, **drive)
    if not result.converged:
        return result
    if abs(gap) <= error:
        reason = "the force differs from its threshold by less than the error of the threshold, "
        reason += f"{error:.1e} of mu times the load"
        from microslip.answer.force import GAP_MARGIN  # late, since it loads compiled code

        drive["force"] = min(force - gap + GAP_MARGIN * error, limits.LARGEST_FORCE)
        faster = solve_at(contact, None, tolerance, **drive).mean_velocity
        half = 0.5 * (faster.value + faster.error)
        return result.changed(reason=reason, mean_velocity=Estimate(half, {"model": half}))
    accepted = tolerance * max(result.velocity, SLOWEST)
    if result.mean_velocity.error <= accepted:
        return result
    return solve_at(contact, None, max(MARGIN * accepted, arguments.SMALLEST_TOLERANCE), **drive)


def within_range(drive: dict[str, float]) -> dict[str, float]:
    """Return the dimensionless drive, limited to the range of the solver.

    If the force exceeds the range of the solver, the contact slides away without limit.  A body
    that is too heavy or too stiff hardly moves.  The mass, stiffness and damping of such a body are
    divided by a common factor.  This preserves the natural frequency.
    """
    body = {name: value for name, value in drive.items() if name != "force"}
    scale = max(1.0, max(body.values(), default=0.0) / arguments.LARGEST_BODY)
    groups = {name: min(value / scale, arguments.LARGEST_BODY) for name, value in body.items()}
    if "stiffness" in groups:  # a softer spring exerts nearly the same force
        groups["stiffness"] = max(groups["stiffness"], arguments.SMALLEST_STIFFNESS)
    if "force" in drive:
        groups["force"] = min(drive["force"], limits.LARGEST_FORCE)
    return groups


def _outcome(contact: Contact, result: Result) -> str | None:
    speed = result.mean_velocity
    if contact.drive(contact.mean_load)["force"] >= 1.0 or result.reason.startswith(RUNS_AWAY):
        return RUNS_AWAY
    if not math.isfinite(speed.value):
        return None
    if speed.value == speed.error == 0.0:
        return "stays"
    return "moves" if speed.value > speed.error else "undecided"


def _rest(contact: Contact) -> tuple[dict[str, Value], str]:
    """Return the displacement and the number of cycles until the contact rests, or the reason why
    they are unknown.

    The displacement and the number of cycles are computed for round contacts only, because other
    contacts would take minutes.
    """
    drive = contact.drive(contact.mean_load)
    if set(drive) != {"force"}:
        return {}, "computed for a contact without mass only"
    if not contact.shape.is_round:
        return {}, "computed for a round contact only"
    from microslip.answer.force import shakedown  # late, since it loads compiled code

    try:
        rest = shakedown(problem_of(contact), force=float(drive["force"]))
    except InputError as error:  # a motion that exerts a forward force by itself
        return {}, error.allowed
    if not rest.converged:
        return {}, rest.reason
    cycles = {} if rest.most_after is None else {"cycles": Value(float(rest.most_after))}
    return {"displacement": Value(rest.displacement, rest.displacement_error)} | cycles, ""


def with_mean_load(problem: Problem) -> Problem:
    """Return the problem without the oscillation of its normal load.

    If the contact separates, the problem is returned unchanged.  In such a problem, the mean load
    differs from the reference load.  If nothing else oscillates, the amplitude of the result is 0.
    """
    motion = problem.motion
    if not motion.loads or abs(problem.mean_load - 1.0) > ROUNDING:
        return problem
    if isinstance(motion, Sampled):
        motion = replace(motion, height=None, text=f"{motion.text} (mean load)")
    else:
        waves = {name: wave for name, wave in motion.components.items() if name in PLANE}
        if not waves:
            return replace(problem, motion=Transverse(), amplitude=0.0)
        motion = type("MeanLoad", (Motion,), {"waves": waves})()
    problem = replace(problem, motion=motion)
    return problem if limits.oscillates(problem) else replace(problem, amplitude=0.0)


SIMPLER: dict[str, Callable[[Problem], Problem]] = {
    "a sphere suffices: on a circular contact with the same u_lim": partial(
        replace, pressure=HERTZ
    ),
    "Poisson's ratio matters for u_lim only: with the ratio 0 and the same u_lim": partial(
        replace, poisson=0.0
    ),
    "a constant load suffices: with the mean load": with_mean_load,
}
"""Functions that simplify a Problem.  Each key is the beginning of a sentence about the simpler
problem.  The sentence is printed if the original and the simpler problem have the same mu_macro,
within the error."""


def simplifications(contact: Contact, answer: Prediction) -> list[str]:
    """Return the sentences of `SIMPLER` that apply to a contact.  The sentence about a simpler
    contact applies if both contacts have the same friction at the same speed.  The two friction
    values may differ by at most the error of `answer`.

    A contact counts as simpler only if the solver can use a cheaper model, or if the load becomes
    constant.  There is no such sentence about Poisson's ratio of a named material.  The list is
    empty for a contact under a prescribed force.  The list is also empty for a result from a closed
    form or a map, and for a result that is not converged.
    """
    friction, tolerance = answer.values["friction"], contact.inputs.tolerance or TOLERANCE
    if contact.inputs.force is not None or not answer.converged or answer.model not in MODELS:
        return []

    def cost(problem: Problem) -> tuple[int, bool]:
        return list(MODELS).index(limits.choose_model(problem)), problem.motion.loads

    problem, sentences = problem_of(contact, contact.velocity, **within_range(contact.drive())), []
    for words, simplify in SIMPLER.items():
        simpler = simplify(problem)
        own = simpler.poisson == problem.poisson or contact.inputs.nu is not None
        if own and cost(simpler) < cost(problem):
            other = solve(simpler, tolerance=tolerance)
            if other.converged and abs(other.mu_macro - friction.value) <= friction.error:
                sentences.append(f"{words}, mu_macro differs by less than its error")
    return sentences


# Maps


class FrictionMap:
    """Interpolator for the friction in the dataset of a sweep; see datasets.accessor.

    Parameters
    ----------
    dataset : xarray.Dataset
        Dataset of a sweep.
    motion, pressure : str
        Motion and pressure of the contact.

    Raises
    ------
    InputError
        If the dataset is for another motion or pressure, or for a drive other than a prescribed
        velocity.
    """

    def __init__(self, dataset: Any, motion: str, pressure: str = "hertz"):
        attributes = getattr(dataset, "attrs", {})
        own = attributes.get("motion"), attributes.get("pressure", "hertz")
        what = f"{own[0]}, pressure {own[1]}"
        if own[0] is None:
            what = type(dataset).__name__ if hasattr(dataset, "attrs") else dataset
        allowed = f"allowed is the dataset of a sweep of {motion}, pressure {pressure}"
        if own != (motion, pressure) or "drive" in attributes:
            raise InputError("map", what, f"{allowed}, with a prescribed velocity")
        self.dataset = dataset

    def at(
        self, velocity: Any, amplitude: Any, poisson: float | None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the friction and its error bound at the given points.  Raises InputError for an
        invalid `nu`, and ValueError for points outside the map."""
        try:
            answer = self.dataset.microslip.at(velocity, amplitude, poisson=poisson)
        except InputError as error:
            raise (error.renamed("nu") if error.argument == "poisson" else error) from None
        return answer.mu_macro.values, answer.mu_macro_error.values

    def solve(self, problem: Problem, tolerance: float) -> Result:
        """Return the interpolated friction as a Result of microslip.solve.  The result is not
        converged if its error bound is above the tolerance, or if the point is outside the map."""
        value, error = math.nan, math.inf
        try:
            place = problem.velocity, problem.amplitude, problem.poisson
            value, error = (float(one) for one in self.at(*place))
            reason = f"the error bound of the map is {error:.1e}; allowed is at most {tolerance:g}"
        except InputError as refusal:
            reason = f"{refusal.argument} = {refusal.value}: {refusal.allowed.partition(';')[0]}"
        except ValueError as outside:
            reason = str(outside)
        reason = "" if error <= tolerance else reason
        friction = {"friction": Estimate(value, {"model": error})}
        return Result.of(problem, friction, reason, model=MAP, tolerance=tolerance)


# Search


def find_reduction(inputs: Inputs) -> tuple[Contact, Value]:
    """Find the smallest amplitude, the largest speed or the largest load that gives the requested
    reduction.  Returns the contact, and the value of the quantity that was searched for, in SI
    units.

    If the solver fails for a contact during the search, this contact is returned, and the error of
    the quantity is NaN.  Raises NoSolutionError if the reduction is outside the range of the
    search, and InputError if an input is invalid.
    """
    from scipy.optimize import brentq

    name, share, tolerance = str(inputs.search), inputs.reduction, inputs.tolerance or TOLERANCE
    _check_share(inputs, share, tolerance)
    (scale, power, low, high, last_place), unit = _line(inputs, name, share), inputs.unit(name)
    least, towards = ("smallest", "up") if name == "amplitude" else ("largest", "down")
    last: Any = None
    error, reductions = 0.0, []

    def size(place: float) -> float:
        """Return the unknown in its SI unit."""
        return scale * math.exp(power * place)

    def excess(place: float) -> float:
        """Return mu_macro minus the requested mu_macro."""
        nonlocal last, error
        last = Contact(inputs.at(**{name: size(place)}))
        answer = solve_at(last, last.velocity, tolerance)
        friction, error = answer.mu_macro, answer.mu_macro_error
        if not math.isfinite(friction):
            raise _SolverFailureError
        if last.inputs.speed == 0.0 and friction <= error:
            friction = 0.0  # the whole contact slides; the remaining friction is an error
        reductions.append((100.0 * (1.0 - friction), 100.0 * error))
        return friction - (1.0 - share)

    def refusal(end: str, reduction: str) -> NoSolutionError:
        allowed = f"{end} {unit}, reduces friction by more{reduction} %"
        return NoSolutionError("reduction", inputs.given["reduction"], allowed)

    try:
        if excess(low) < 0.0:
            end = f"the {least} {name} of the search, {size(low):.2g}"
            raise refusal(end, f": {number_text(*reductions[0])}")
        if name == "speed" and excess(math.inf) > 0.0:
            high = last_place
        while excess(high) > 0.0:
            if high >= last_place:
                end = f"no {name} of the search, {towards} to {size(high):.2g}"
                raise refusal(end, f" than {number_text(*max(reductions))}")
            high = min(high + math.log(2.0), last_place)
        place = brentq(excess, low, high, xtol=0.1 * tolerance)
        here, error_here = excess(place), error
        slopes = [excess(place - STEP) - here, here - excess(place + STEP)]
    except _SolverFailureError:
        return last, Value(getattr(last.inputs, name), math.nan)
    steep = [slope / STEP for slope in slopes if slope > 0.0]
    place_error = (abs(here) + error_here) / min(steep) if steep else math.inf
    root = size(place)
    try:
        contact = contact_of(replace(inputs, search=None).at(**{name: root}))
    except InputError as problem:
        allowed = f"it takes a {name} of {root:.3g} {unit}; {problem}"
        raise inputs.error("reduction", allowed) from None
    return contact, Value(root, abs(power) * root * place_error)


def _check_share(inputs: Inputs, share: float, tolerance: float) -> None:
    """Raise InputError if no search can find a contact with the requested reduction of friction."""
    most = f"{100.0 * (1.0 - tolerance):g} %, 100 % minus the tolerance: at a speed some friction"
    spins, moves = inputs.kind.unit == "rad", inputs.search != "speed" and inputs.speed
    for name, is_refused, allowed in (
        ("reduction", share < tolerance, f"at least the tolerance, {tolerance:g}"),
        ("reduction", spins and share == 1.0, "less than 100 %: the centre always sticks"),
        ("reduction", moves and share > 1.0 - tolerance, f"at most {most} remains"),
        ("amplitude", inputs.search == "load" and inputs.amplitude == 0.0, "above 0"),
    ):
        if is_refused:
            raise inputs.error(name, f"allowed with a reduction is {allowed}")


def _line(inputs: Inputs, name: str, share: float) -> tuple[float, float, float, float, float]:
    """Return the parameters of the search.  The unknown is scale * exp(power * place).  Friction
    decreases as `place` increases.

    Returns
    -------
    tuple of float
        Scale, power, first place, initial guess of the bracket's upper end, and last place.
    """
    low, high = (math.log(one) for one in AMPLITUDES)
    spins = inputs.kind.unit == "rad"
    if name == "amplitude":  # a place is the logarithm of the dimensionless amplitude
        contact = Contact(inputs.at(amplitude=0.0))
        unit = contact.u_lim / (contact.contact_radius if spins else 1.0)
        return unit, 1.0, low, 0.0, high
    if name == "speed":  # a place is minus the logarithm of the speed
        contact = Contact(inputs.at(speed=0.0))
        unit = contact.speed_unit
        if not (contact.steady or spins):
            unit *= max(1.0, float(contact.amplitude))  # the speed of the vibration
        slow, fast = (-math.log(one) for one in SPEEDS)
        return unit, -1.0, fast, 0.0, slow
    # A place is the logarithm of the dimensionless amplitude, which is a power of the load with a
    # negative exponent.  Under a large load nothing slips, and under a small load the dimensionless
    # velocity of a bore is large.  The reduction is largest in between.  Small steps from large
    # loads downwards find the first load with the requested reduction.
    first, second = (float(Contact(inputs.at(load=f * LOAD)).amplitude) for f in (1.0, 8.0))
    power = math.log(8.0) / math.log(second / first)
    return LOAD * first**-power, power, low, math.log(0.01 * share), high
