"""The dimensionless answer for a contact at a prescribed speed, on a spring or under a force."""

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
"""Dimensionless velocity below which the accepted error is absolute instead of relative."""
MARGIN = 0.8
"""Safety factor on the accepted error of a second run, because the second velocity can be
smaller."""


def answer_of(request: Request, limit: Result | None, threshold: Estimate | None) -> Result:
    """The friction at a prescribed speed, or the velocity under a prescribed force.

    If the force is below the threshold by more than the threshold's error, the contact comes to
    rest, and no drift is computed.  If the force is within this error of the threshold, the result
    is not converged, since computing the small speed would take minutes.

    Parameters
    ----------
    limit : Result or None
        Friction in the limit of vanishing speed; None for a steady motion.
    threshold : Estimate or None
        Smallest force that moves the contact, divided by mu F_z; None if it is unknown.
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
    """The dimensionless drive, reduced to the range of the solver.

    If the force exceeds this range, the contact runs away.  A body that is too heavy or too stiff
    hardly moves.  Its mass, stiffness and damping are scaled by one factor, which preserves the
    natural frequency.
    """
    body = {name: value for name, value in drive.items() if name != "force"}
    scale = max(1.0, max(body.values(), default=0.0) / LARGEST_BODY)
    groups = {name: min(value / scale, LARGEST_BODY) for name, value in body.items()}
    if "stiffness" in groups:  # a softer spring exerts nearly the same force
        groups["stiffness"] = max(groups["stiffness"], SMALLEST_STIFFNESS)
    if "force" in drive:
        groups["force"] = min(drive["force"], LARGEST_FORCE)
    return groups
