"""Maps that are certified everywhere: what a sweep says under `adaptive`, checked."""

from microslip.config.records import CertifiedMap, ConfigError, Sweep
from microslip.foundation.canonical import number

EXACT_MODELS = ("auto", "radial", "polar", "cartesian")
"""Models whose contact is the half-space, of which thresholds of drift are known."""
SHARE_OF_POINTS = 0.3
"""Default tolerance of the points of a map, over that of the map."""
LOOSEST_POINTS = 1e-2
"""Largest tolerance of points: what looser ones may be off would be taken for bends of the map, and
its cells halved for nothing."""


def maps(sweeps: dict[str, Sweep], given: dict, where: str) -> dict[str, CertifiedMap]:
    """Certified maps by the names of their datasets, of those sweeps that ask for one.

    Parameters
    ----------
    sweeps : dict of Sweep
        By name.
    given : dict
        Their settings by name, with defaults filled in.
    where : str
        How messages begin, file and key.

    Raises
    ------
    ConfigError
        For a sweep that spans no map or imposes its resolution.
    """
    found = {}
    for name, sweep in sweeps.items():
        asked = given[name].get("adaptive")
        if asked is not None:
            _refuse_mismatch(sweep, f"{where}.{name}")
            error = float(number(asked["error"]))
            tolerance = _tolerance(asked["tolerance"], error, f"{where}.{name}.adaptive")
            dataset = f"certified_{name}"
            found[dataset] = CertifiedMap(dataset, sweep, error, tolerance)
    return found


def _tolerance(given: float | None, error: float, where: str) -> float:
    loosest = min(SHARE_OF_POINTS * error, LOOSEST_POINTS)
    tolerance = float(number(loosest if given is None else given))
    if tolerance >= error:
        raise ConfigError(
            f"{where}.tolerance: {tolerance:g} is not allowed; allowed: less than the error, which "
            f"is {error:g}"
        )
    return tolerance


def refuse_unsolvable(given: dict[str, CertifiedMap], where: str) -> None:
    """Raise ConfigError for a map of drift where the force that it begins at is not known.

    given: maps by name; where: how messages begin.  It takes a while to load.
    """
    from microslip.config.extended import solver_names
    from microslip.theory import drift_threshold

    for map_ in given.values():
        if map_.force is None:
            continue
        sweep, at = map_.sweep, f"{where}.{map_.sweep.name}.adaptive"
        motion, pressure = solver_names(sweep)
        if not drift_threshold.is_known(motion, pressure, sweep.poisson[0]):
            raise ConfigError(
                f"{at}: is not allowed for {motion} under {pressure} at Poisson's ratio "
                f"{sweep.poisson[0]:g}, whose threshold is not known exactly; allowed: "
                f"{', '.join(drift_threshold.KNOWN)} under hertz, at Poisson's ratio 0 but for bore"
            )
        if sweep.model not in EXACT_MODELS:
            raise ConfigError(
                f"{at}: is not allowed with model {sweep.model}, whose threshold is another one; "
                f"allowed: {', '.join(EXACT_MODELS)}"
            )
        least = float(drift_threshold.threshold(motion, map_.amplitude[1]))
        if least >= map_.force:
            raise ConfigError(
                f"{at}: is not allowed where nothing moves; allowed: a force above the threshold "
                f"at the largest amplitude, {least:.3g}"
            )


def _refuse_mismatch(sweep: Sweep, where: str) -> None:
    if sweep.drives:
        _refuse_no_drift(sweep, where)
    is_static = len(sweep.amplitude or ()) > 1 and 0.0 in sweep.velocity
    if not (sweep.spans_a_map or is_static or sweep.drives):
        raise ConfigError(
            f"{where}.adaptive: is not allowed here; allowed: with two amplitudes and two "
            "velocities above 0 at least, which are its range, or the velocity 0 in their place"
        )
    if sweep.tolerance is None or sweep.cells is not None or sweep.steps is not None:
        raise ConfigError(
            f"{where}.adaptive: is not allowed with cells or steps imposed; allowed: a tolerance "
            "alone"
        )


def _refuse_no_drift(sweep: Sweep, where: str) -> None:
    """Raise ConfigError for what is pulled but by a force alone, over which it is to be a map."""
    (name, values, _), *others = sweep.drives
    if others or name != "force" or sweep.contacts is not None:
        pulls = ", ".join(name for name, _, _ in sweep.drives)
        pulls += ", contacts" if sweep.contacts is not None else ""
        raise ConfigError(
            f"{where}.adaptive: is not allowed with {pulls}; allowed: a force alone, on one contact"
        )
    if len(sweep.amplitude or ()) < 2 or len(sweep.poisson) > 1:
        raise ConfigError(
            f"{where}.adaptive: is not allowed here; allowed: with two amplitudes at least, which "
            "are its range, and one Poisson's ratio"
        )
    if not 0.0 < values[-1] < 1.0:
        raise ConfigError(
            f"{where}.adaptive: is not allowed up to the force {values[-1]:g}; allowed: above 0 "
            "and below 1, where a contact runs away"
        )
