"""Maps that are certified everywhere: what a sweep says under `adaptive`, checked."""

from microslip.config.records import CertifiedMap, ConfigError, Sweep
from microslip.foundation.canonical import number

SHARE_OF_POINTS = 0.3
"""Of the error of a map: what is left to its points unless told otherwise."""


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


def _tolerance(given, error, where):
    tolerance = float(number(SHARE_OF_POINTS * error if given is None else given))
    if tolerance >= error:
        raise ConfigError(
            f"{where}.tolerance: {tolerance:g} is not allowed; allowed: less than the error, which "
            f"is {error:g}"
        )
    return tolerance


def _refuse_mismatch(sweep, where):
    is_static = len(sweep.amplitude or ()) > 1 and 0.0 in sweep.velocity
    if not (sweep.spans_a_map or is_static):
        raise ConfigError(
            f"{where}.adaptive: is not allowed here; allowed: with two amplitudes and two "
            "velocities above 0 at least, which are its range, or the velocity 0 in their place"
        )
    if sweep.tolerance is None or sweep.cells is not None or sweep.steps is not None:
        raise ConfigError(
            f"{where}.adaptive: is not allowed with cells or steps imposed; allowed: a tolerance "
            "alone"
        )
