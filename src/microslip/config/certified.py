"""Certified maps.  A sweep requests one with the key `adaptive`."""

from typing import TYPE_CHECKING

from microslip.config.records import CERTIFIED, LOOSEST_POINTS, CertifiedMap, Refusal, Sweep
from microslip.foundation.canonical import number

if TYPE_CHECKING:
    from microslip.config.settings import Adaptive

EXACT_MODELS = ("auto", "radial", "polar", "cartesian")
"""Models of the half-space.  The drift threshold has closed forms for these models."""
SHARE_OF_POINTS = 0.3
"""Default tolerance of the points, divided by the largest error of the map."""


def _demand(condition: bool, circumstance: str, allowed: str) -> None:
    if not condition:
        raise Refusal(f"is not allowed {circumstance}; allowed: {allowed}", "adaptive")


def map_of(sweep: Sweep, adaptive: "Adaptive") -> CertifiedMap:
    """Create the certified map of a sweep.  Raises Refusal if a certified map is not possible."""
    many = len(sweep.amplitude or ()) > 1
    if sweep.drives:
        names = [name for name, _, _ in sweep.drives]
        _demand(names == ["force"], f"with {', '.join(names)}", "a force alone")
        range_ = "with two amplitudes at least, which are its range, and one Poisson's ratio"
        _demand(many and len(sweep.poisson) == 1, "here", range_)
        largest = sweep.drives[0][1][-1]
        range_ = "above 0 and below 1, the force at which a contact runs away"
        _demand(0.0 < largest < 1.0, f"up to the force {largest:g}", range_)
    range_ = "with two amplitudes and two velocities above 0 at least, which are its range, or "
    range_ += "two amplitudes and the velocity 0"
    mapped = sweep.spans_a_map or (many and 0.0 in sweep.velocity) or bool(sweep.drives)
    _demand(mapped, "here", range_)
    free = sweep.tolerance is not None and sweep.cells is None and sweep.steps is None
    _demand(free, "with cells or steps imposed", "a tolerance alone")
    error = float(number(adaptive.error))
    loosest = min(SHARE_OF_POINTS * error, LOOSEST_POINTS)
    tolerance = loosest if adaptive.tolerance is None else adaptive.tolerance
    return CertifiedMap(f"{CERTIFIED}{sweep.name}", sweep, error, float(number(tolerance)))


def refuse_unsolvable(map_: CertifiedMap) -> None:
    """Raise Refusal for a drift map if the threshold has no closed form."""
    from microslip.config.extended import solver_names
    from microslip.theory import drift_threshold

    if map_.force is None:
        return
    model, nu = map_.sweep.model, map_.sweep.poisson[0]
    motion, pressure = solver_names(map_.sweep)
    where = f"for {motion} under {pressure} at Poisson's ratio {nu:g}"
    allowed = (
        f"{', '.join(drift_threshold.MOTIONS)} under hertz, at Poisson's ratio 0 except for bore"
    )
    is_known = drift_threshold.is_known(motion, pressure, nu)
    _demand(is_known, f"{where}, whose threshold has no closed form", allowed)
    other = f"with model {model}, which has another threshold"
    _demand(model in EXACT_MODELS, other, ", ".join(EXACT_MODELS))
    least = float(drift_threshold.threshold(motion, map_.amplitude[1]))
    above = f"a force above the threshold at the largest amplitude, {least:.3g}"
    _demand(least < map_.force, "for forces that move nothing", above)
