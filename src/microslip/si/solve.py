"""The dimensionless answer for a contact: friction or velocity, static limit and threshold."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from microslip.answer import limits
from microslip.answer.answer import Estimate, Result
from microslip.answer.point import solve
from microslip.contact.registry import MODELS
from microslip.foundation import arguments
from microslip.foundation.errors import InputError, shown
from microslip.scene.hertz import HERTZ
from microslip.scene.problem import Problem
from microslip.si.contact import INPUT_OF, Contact
from microslip.si.map import MAP, FrictionMap
from microslip.si.output import Prediction, Value

TOLERANCE, TOLERANCE_OF_SPEED = 1e-3, 1e-2
"""Default tolerance of mu_macro, and default relative tolerance of the speed under a force."""
STATIC_TOLERANCE = 1e-3
"""Largest accepted error of the static limit under a force, dimensionless."""
TOLERANCE_OF_SEVERAL = 1e-2
"""Smallest tolerance of the static limit of a motion with several oscillations, dimensionless.
Smaller errors take more than a minute."""
SLOWEST = 1e-3
"""Dimensionless velocity below which the accepted error is absolute instead of relative."""
MARGIN = 0.8
"""Safety factor on the accepted error of a second run, because the second velocity can be
smaller."""
SIMPLER: dict[str, dict[str, Any]] = {
    "a sphere suffices: on a circular contact with the same u_lim, mu_macro differs by less than "
    "its error": {"pressure": HERTZ},
    "Poisson's ratio matters for u_lim only: with the ratio 0 and the same u_lim, mu_macro differs "
    "by less than its error": {"poisson": 0.0},
}
"""Changes of a Problem, keyed by the sentence for changes that do not matter."""
RUNS_AWAY = "runs away"
"""First words of the solver's reason for a contact that accelerates without limit."""


def answer_of(contact: Contact) -> Prediction:
    """Solve a contact.  Raises InputError.

    Returns
    -------
    Prediction
        The dimensionless answer.  Its values are friction: mean forward force divided by mu times
        the mean load; velocity; static: friction in the limit of vanishing velocity; threshold:
        smallest constant force that moves the contact, divided as the friction; largest_force:
        smallest force at which it runs away; mean_load divided by the load without oscillation;
        torque divided by mu F_z a; dissipation per period divided by mu F_z u_lim; displacement
        until rest in u_lim; cycles until rest.  Unknown values are missing.
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


def solve_at(contact: Contact, velocity: float | None, tolerance: float, **changes: Any) -> Result:
    """The Result of microslip.solve, or of a map, for a contact.

    velocity: dimensionless velocity; None under a force.  A velocity above the range of the solver
    is replaced by the largest one, at which the vibration has no effect.  changes: dimensionless
    force, stiffness, mass and damping.

    Raises InputError.  The message names the input of `predict`.
    """
    inputs, settings = contact.inputs, settings_of(contact)
    if velocity is not None:
        velocity = min(velocity, arguments.LARGEST["velocity"])
    if inputs.map is not None:
        assert velocity is not None  # a map is not allowed with a force
        friction = FrictionMap(inputs.map, str(contact.motion), settings["pressure"])
        return friction.solve(velocity, settings["amplitude"], settings["poisson"], tolerance)
    try:
        settings |= {"tolerance": tolerance, **changes}
        return solve(contact.motion, velocity, **settings)
    except InputError as error:
        name = INPUT_OF.get(error.argument, "")
        if not changes or name not in inputs.quantities:
            raise
        group = f"{error.value:.6g}" if isinstance(error.value, float) else shown(error.value)
        raise inputs.error(name, f"dimensionless {group}: {error.allowed}") from None


def settings_of(contact: Contact) -> dict[str, Any]:
    """Amplitude, Poisson's ratio and pressure for microslip.solve."""
    size = None if contact.steady else float(contact.amplitude)
    return {"amplitude": size, "poisson": float(contact.poisson), "pressure": contact.pressure}


def static_limit(contact: Contact) -> Result:
    """mu_macro in the limit of vanishing speed."""
    tolerance = contact.inputs.tolerance or TOLERANCE
    if contact.inputs.force is not None:  # the tolerance applies to the speed here
        tolerance = min(tolerance, STATIC_TOLERANCE)
    if contact.kind.several:
        tolerance = max(tolerance, TOLERANCE_OF_SEVERAL)
    return solve_at(contact, 0.0, tolerance)


def problem_of(contact: Contact) -> Problem:
    """The dimensionless Problem in the limit of vanishing speed."""
    return limits.problem_of(contact.motion, 0.0, **settings_of(contact))


def largest_force(contact: Contact) -> float:
    """Smallest constant force at which the contact runs away, divided by mu times the mean load.

    It is 1 for a body with a mass.  Otherwise it is the smallest normal load in a period divided by
    the mean load.
    """
    if contact.inputs.mass or contact.steady:
        return 1.0
    return min(1.0, limits.least_load(problem_of(contact)))


def _threshold(contact: Contact, limit: Result | None) -> Estimate | None:
    """Smallest constant force that moves the contact, divided by mu times the mean load.

    The threshold equals the static limit if the oscillation exerts no forward force.  Otherwise, a
    contact without mass follows the forward oscillation, and the threshold is the static limit of
    the other components, or 1 if there are no other components.  This limit is computed only if a
    force is prescribed. The threshold is None if it is unknown.
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
    """The friction at a prescribed speed, or the velocity under a prescribed force.

    If the force is below the threshold by more than the threshold's error, the contact comes to
    rest, and no drift is computed.  If the force is within this error of the threshold, the result
    is not converged, since computing the small speed would take minutes.
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
        from microslip.answer.force import GAP_MARGIN  # late: compiled code

        drive["force"] = min(force - gap + GAP_MARGIN * error, limits.LARGEST_FORCE)
        faster = solve_at(contact, None, tolerance, **drive).mean_velocity
        half = 0.5 * (faster.value + faster.error)
        return result.changed(reason=reason, mean_velocity=Estimate(half, {"model": half}))
    accepted = tolerance * max(result.velocity, SLOWEST)
    if result.mean_velocity.error <= accepted:
        return result
    return solve_at(contact, None, max(MARGIN * accepted, arguments.SMALLEST_TOLERANCE), **drive)


def within_range(drive: dict[str, float]) -> dict[str, float]:
    """The dimensionless drive, reduced to the range of the solver.

    If the force exceeds this range, the contact runs away.  A body that is too heavy or too stiff
    hardly moves.  Its mass, stiffness and damping are scaled by one factor, which preserves the
    natural frequency.
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
    """Displacement until the contact rests and number of cycles, or the reason why they are
    unknown.

    They are computed for round contacts only, because other contacts would take minutes.
    """
    drive = contact.drive(contact.mean_load)
    if set(drive) != {"force"}:
        return {}, "computed for a contact without mass only"
    if not contact.shape.is_round:
        return {}, "computed for a round contact only"
    from microslip.answer.force import shakedown  # late: compiled code

    try:
        rest = shakedown(contact.motion, force=float(drive["force"]), **settings_of(contact))
    except InputError as error:  # a motion that exerts a forward force by itself
        return {}, error.allowed
    if not rest.converged:
        return {}, rest.reason
    cycles = {} if rest.most_after is None else {"cycles": Value(float(rest.most_after))}
    return {"displacement": Value(rest.displacement, rest.displacement_error)} | cycles, ""


def simplifications(contact: Contact, answer: Prediction) -> list[str]:
    """Return the sentences of SIMPLER that hold for a contact: the simpler contact has the same
    friction at the same speed, within the error of the answer.

    A contact counts as simpler if another model is chosen for it.  The list is empty for a contact
    under a force, and for an answer that is a closed form, comes from a map or is not converged.
    """
    inputs, friction, sentences = contact.inputs, answer.values["friction"], []
    if inputs.force is not None or not answer.converged or answer.model not in MODELS:
        return []
    # the choice of a model distinguishes a velocity of 0 from others
    problem = replace(problem_of(contact), velocity=min(contact.velocity, 1.0))
    drive, tolerance = within_range(contact.drive(contact.mean_load)), inputs.tolerance or TOLERANCE
    for sentence, change in SIMPLER.items():
        if limits.choose_model(replace(problem, **change)) != answer.model:
            result = solve_at(contact, contact.velocity, tolerance, **drive, **change)
            if result.converged and abs(result.friction.value - friction.value) <= friction.error:
                sentences.append(sentence)
    return sentences
