"""The dimensionless answer for a contact at a speed, on a spring or under a force."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from microslip.adaptive.checks import LARGEST_FORCE
from microslip.adaptive.driven_contact import GAP_MARGIN
from microslip.adaptive.point import Result
from microslip.estimate.estimate import Estimate
from microslip.foundation.arguments import LARGEST_BODY, SMALLEST_STIFFNESS, SMALLEST_TOLERANCE
from microslip.si.request import Request
from microslip.si.static_limit import largest_force

SLOWEST = 1e-3
"""Velocity, in the unit of the motion, below which the accepted error is no longer relative."""
MARGIN = 0.8
"""Safety factor on the accepted error of a second run, since its velocity may be smaller."""


def answer_of(request: Request, limit: Result | None, threshold: Estimate | None) -> Result:
    """Friction at the speed, or the velocity under the force.

    A force below the threshold by more than the error of the threshold lets the contact come to
    rest: no drift is computed.  If the force differs from the threshold by less, the result is not
    converged: to compute so small a speed to a small relative error would take minutes.

    Parameters
    ----------
    limit : Result or None
        Friction at a vanishing speed, None for a steady motion.
    threshold : Estimate or None
        Smallest force that moves the contact, over mu F_z; None: unknown.
    """
    drive: dict[str, Any] = within_range(request.drive_groups)
    velocity, tolerance = request.groups[0], request.tolerance
    if "force" not in drive:
        return request.solve(velocity, tolerance, **drive)
    force, near = request.drive_groups["force"], False
    if threshold is not None:
        near = abs(force - threshold.value) <= threshold.error
        below = force <= threshold.value - threshold.error and force < largest_force(request)
        if below and limit is not None and limit.converged:
            parts: dict[str, Any] = dict(request.drive_groups)
            return replace(limit, mean_velocity=Estimate(0.0), friction=Estimate(force), **parts)
    answer = request.solve(velocity, tolerance, **drive)
    if not answer.converged:
        return answer
    if near and threshold is not None:
        reason = "the force differs from its threshold by less than the error of the threshold, "
        reason += f"{threshold.error:.1e} of mu times the load"
        drive["force"] = min(threshold.value + GAP_MARGIN * threshold.error, LARGEST_FORCE)
        faster = request.solve(velocity, tolerance, **drive).mean_velocity
        half = 0.5 * (faster.value + faster.error)
        between = Estimate(half, {"model": half})
        return replace(answer, mean_velocity=between, converged=False, reason=reason)
    accepted = tolerance * max(answer.velocity, SLOWEST)
    if answer.mean_velocity.error <= accepted:
        return answer
    return request.solve(velocity, max(MARGIN * accepted, SMALLEST_TOLERANCE), **drive)


def within_range(drive: dict[str, float]) -> dict[str, float]:
    """The groups of a drive within the range of the solver.

    Nothing holds a larger force.  A heavier or stiffer body hardly moves: its parts are scaled as
    one, so that it swings as it did.
    """
    body = {name: value for name, value in drive.items() if name != "force"}
    scale = max(1.0, max(body.values(), default=0.0) / LARGEST_BODY)
    groups = {name: min(value / scale, LARGEST_BODY) for name, value in body.items()}
    if "stiffness" in groups:  # a softer spring pulls with the force of the softest
        groups["stiffness"] = max(groups["stiffness"], SMALLEST_STIFFNESS)
    if "force" in drive:
        groups["force"] = min(drive["force"], LARGEST_FORCE)
    return groups
