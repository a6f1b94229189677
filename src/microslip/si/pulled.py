"""The solver asked for a contact that something pulls, and its answer in SI units."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from microslip.adaptive.checks import LARGEST_FORCE
from microslip.adaptive.point import Result, solve
from microslip.adaptive.pulled import GAP_MARGIN
from microslip.adaptive.shakedown import shakedown
from microslip.estimate.estimate import Estimate
from microslip.foundation.arguments import (
    LARGEST,
    LARGEST_BODY,
    SMALLEST_STIFFNESS,
    SMALLEST_TOLERANCE,
)
from microslip.foundation.errors import InputError
from microslip.motions.drive import Spring
from microslip.pressures.by_name import pressure_named
from microslip.si.bodies import TwoBodies
from microslip.si.dimensionless import (
    RealDrive,
    RealMotion,
    full_friction,
    groups,
    solver_motion,
    speed_unit,
)
from microslip.si.reduction import friction_of
from microslip.si.regimes import natural_frequency, regime
from microslip.si.several import Carriers
from microslip.si.static_limit import largest_force

SLOWEST = 1e-3
"""Velocity, in the unit of the motion, below which the accepted error is no longer relative."""
MARGIN = 0.8
"""Safety factor on the accepted error of a second run, since its velocity may be smaller."""
MILLIMETRE = 1e-3
RUNS_AWAY = "runs away"
"""The outcome, and the beginning of the solver's reason for it."""


def answer_of(
    contact: TwoBodies,
    motion: RealMotion,
    pulling: dict[str, float],
    tolerance: float,
    carriers: Carriers,
    threshold: Estimate | None,
) -> Result:
    """The result of microslip.solve for a motion in SI units.

    If the force differs from the threshold by less than the error of the threshold, the result is
    not converged: to compute so small a speed to a small relative error would take minutes.

    Parameters
    ----------
    pulling : dict of float
        The drive as dimensionless groups, from dimensionless.drive_groups.
    tolerance : float
        Accepted error: of mu_macro, or under a force of the velocity, relative down to SLOWEST.
    carriers : several.Carriers
        The contact, or several like it.
    threshold : Estimate or None
        Smallest force that moves the contact, over mu F_z; None: unknown.
    """
    if not pulling:
        return friction_of(contact, motion, tolerance, **carriers.settings)
    velocity, size = groups(motion, contact)
    if velocity is not None:
        velocity = min(velocity, LARGEST["velocity"])

    limits: dict[str, Any] = within_range(pulling)

    def found(tolerance: float, **changed: float) -> Result:
        settings: dict[str, Any] = {"poisson": contact.poisson, "tolerance": tolerance}
        settings |= {"pressure": contact.pressure} | carriers.settings
        name = solver_motion(motion, contact)
        return solve(name, velocity, size, **settings, **limits | changed)

    answer = found(tolerance)
    if "force" not in pulling or not answer.converged:
        return answer
    if threshold is not None and abs(pulling["force"] - threshold.value) <= threshold.error:
        reason = "the force differs from its threshold by less than the error of the threshold, "
        reason += f"{threshold.error:.1e} of mu times the load"
        force = threshold.value + GAP_MARGIN * threshold.error
        faster = found(tolerance, force=min(force, LARGEST_FORCE))
        assert faster.velocity_error is not None  # as under all forces
        half = 0.5 * (faster.velocity + faster.velocity_error)
        between = Estimate(half, {"model": half})
        return replace(answer, mean_velocity=between, converged=False, reason=reason)
    accepted = tolerance * max(answer.velocity, SLOWEST)
    assert answer.velocity_error is not None  # as under all forces
    if answer.velocity_error <= accepted:
        return answer
    return found(max(MARGIN * accepted, SMALLEST_TOLERANCE))


def answer_at_rest(
    carried: tuple[TwoBodies, Carriers],
    motion: RealMotion,
    pulling: dict[str, float],
    limit: Result | None,
    threshold: Estimate | None,
) -> Result | None:
    """The Result of a force below the threshold by more than the error of the threshold: such a
    contact comes to rest, and no drift is computed.  None for any other force.

    Parameters
    ----------
    carried : tuple
        The contact, and how many like it there are.
    pulling : dict of float
        Groups of the drive, from dimensionless.drive_groups.
    limit : Result or None
        Friction at a vanishing speed, None for a steady motion.
    threshold : Estimate or None
        Smallest force that moves the contact, over mu F_z; None: unknown.
    """
    force, mass = pulling.get("force"), pulling.get("mass")
    if force is None or threshold is None or limit is None or not limit.converged:
        return None
    if not force <= threshold.value - threshold.error:
        return None
    if force >= largest_force(carried[0], motion, carried[1], mass):
        return None
    driven: dict[str, Any] = {**pulling}
    return replace(limit, mean_velocity=Estimate(0.0), friction=Estimate(force), **driven)


def within_range(pulling: dict[str, float]) -> dict[str, float]:
    """The groups that the solver takes: beyond them a force is one that nothing holds, and a body
    hardly moves, whose parts are scaled as one so that it swings as it did."""
    body = {name: value for name, value in pulling.items() if name != "force"}
    scale = max(1.0, max(body.values(), default=0.0) / LARGEST_BODY)
    asked = {name: min(value / scale, LARGEST_BODY) for name, value in body.items()}
    if "stiffness" in asked:  # a softer spring pulls with the force of the softest
        asked["stiffness"] = max(asked["stiffness"], SMALLEST_STIFFNESS)
    if "force" in pulling:
        asked["force"] = min(pulling["force"], LARGEST_FORCE)
    return asked


def about_drive(
    carried: tuple[TwoBodies, Carriers],
    motion: RealMotion,
    pulls: tuple[RealDrive, dict[str, float]],
    answer: Result,
    threshold: Estimate | None,
) -> dict:
    """Fields of a prediction.Prediction that say what pulls, and what comes of it.

    Parameters
    ----------
    carried : tuple
        The contact, and how many like it there are.
    pulls : tuple
        The drive as it was given, and its groups.
    threshold : Estimate or None
        Smallest force that moves the contact, over mu F_z; None: unknown.
    """
    (contact, carriers), (drive, pulling) = carried, pulls
    still = full_friction(motion, contact) * carriers.count
    fields: dict[str, Any] = {
        "force_N": drive.force,
        "drive_stiffness_N_m": drive.stiffness,
        "mass_kg": drive.mass,
        "damping_N_s_m": drive.damping,
        "force_threshold_N": None if threshold is None else still * threshold.value,
        "force_threshold_error_N": None if threshold is None else still * threshold.error,
        **pulling,
    }
    if motion.speed is not None and motion.frequency is not None:
        fields["displacement_per_cycle_m"] = motion.speed / motion.frequency
        fields["displacement_per_cycle_error_m"] = 0.0
    if drive.force is not None:
        if threshold is not None:
            fields["safety_factor"] = still * threshold.value / drive.force
            fields["safety_factor_error"] = still * threshold.error / drive.force
        fields |= _walk(contact, motion, pulling["force"], answer)
        if fields["outcome"] == "stays":
            fields |= _way_to_rest((contact, carriers), motion, pulling)
    body = {name: value for name, value in pulling.items() if name != "force"}
    if body:
        working = Spring(**{"stiffness": 0.0} | body)  # a body under a force has none
        assert answer.amplitude is not None  # as of all that a spring pulls or that has a mass
        widest = answer.amplitude * max(carriers.widest, 1.0)
        fields["regime"] = regime(motion.name, widest, working)
        fields["natural_frequency"] = natural_frequency(working)
    return fields


def _walk(contact: TwoBodies, motion: RealMotion, force: float, answer: Result) -> dict[str, Any]:
    """Fields of the prediction for a contact under a force."""
    unit = speed_unit(motion, contact)
    velocity, error = answer.velocity, answer.velocity_error
    assert error is not None  # as under all forces
    speed = velocity * unit
    fields: dict[str, Any] = {
        "velocity_error": error,
        "speed_error_m_s": error * unit if unit else 0.0,
    }
    fields["outcome"] = _outcome(force, answer)
    if motion.frequency is not None:
        fields["displacement_per_cycle_m"] = speed / motion.frequency
        fields["displacement_per_cycle_error_m"] = fields["speed_error_m_s"] / motion.frequency
    if fields["outcome"] == "moves":
        share = error / (velocity - error)  # largest relative error of what is over the velocity
        for name, way in (("1_mm", MILLIMETRE), ("contact_radius", contact.contact_radius)):
            fields[f"time_to_{name}_s"] = way / speed
            fields[f"time_to_{name}_error_s"] = way / speed * share
    return fields


def _way_to_rest(
    carried: tuple[TwoBodies, Carriers], motion: RealMotion, pulling: dict[str, float]
) -> dict[str, Any]:
    """Fields of the displacement of a contact that comes to rest, or of the reason why it is not
    known.  A contact that is not round would take minutes."""
    contact, carriers = carried
    if set(pulling) != {"force"} or carriers.text is not None:
        return {"displacement_reason": "computed for one contact without mass only"}
    if not pressure_named(contact.pressure).is_round:
        return {"displacement_reason": "computed for a round contact only"}
    force = pulling["force"]
    _, size = groups(motion, contact)
    settings: dict[str, Any] = {"pressure": contact.pressure, "poisson": contact.poisson}
    try:
        found = shakedown(solver_motion(motion, contact), size, force, **settings)
    except InputError as error:  # a motion that exerts a forward force by itself
        return {"displacement_reason": error.allowed}
    if not found.converged:
        return {"displacement_reason": found.reason}
    unit = contact.u_lim
    return {
        "displacement_m": found.displacement * unit,
        "displacement_error_m": found.displacement_error * unit,
        "cycles_to_rest": found.most_after,
    }


def _outcome(force: float, answer: Result) -> str | None:
    velocity, error = answer.velocity, answer.velocity_error
    assert error is not None  # as under all forces
    if force >= 1.0 or answer.reason.startswith(RUNS_AWAY):
        return RUNS_AWAY
    if not math.isfinite(velocity):
        return None
    if velocity == error == 0.0:
        return "stays"
    return "moves" if velocity > error else "undecided"


def with_speed(motion: RealMotion, contact: TwoBodies, answer: Result) -> RealMotion:
    """The motion with the speed that a force makes, unless it has one."""
    if motion.speed is not None:
        return motion
    unit = speed_unit(motion, contact)
    return replace(motion, speed=answer.velocity * unit if unit else answer.velocity)
