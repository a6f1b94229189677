"""Certified maps.  A sweep requests one with the key `adaptive`."""

from typing import TYPE_CHECKING

from microslip.config.records import CERTIFIED, LOOSEST_POINTS, CertifiedMap, Refusal, Sweep
from microslip.foundation.canonical import number

if TYPE_CHECKING:
    from microslip.config.settings import Adaptive

SHARE_OF_POINTS = 0.3
"""Default tolerance of the points, divided by the largest error of the map."""


def _demand(condition: bool, circumstance: str, allowed: str) -> None:
    if not condition:
        raise Refusal(f"is not allowed {circumstance}; allowed: {allowed}", "adaptive")


def map_of(sweep: Sweep, adaptive: "Adaptive") -> CertifiedMap:
    """Create the certified map of a sweep.  Raises Refusal if a certified map is not possible."""
    many = len(sweep.amplitude or ()) > 1
    range_ = "with two amplitudes and two velocities above 0 at least, which are its range, or "
    range_ += "two amplitudes and the velocity 0"
    mapped = sweep.spans_a_map or (many and 0.0 in sweep.velocity)
    _demand(mapped, "here", range_)
    free = sweep.tolerance is not None and sweep.cells is None and sweep.steps is None
    _demand(free, "with cells or steps imposed", "a tolerance alone")
    error = float(number(adaptive.error))
    loosest = min(SHARE_OF_POINTS * error, LOOSEST_POINTS)
    tolerance = loosest if adaptive.tolerance is None else adaptive.tolerance
    return CertifiedMap(f"{CERTIFIED}{sweep.name}", sweep, error, float(number(tolerance)))
