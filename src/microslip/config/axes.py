"""From settings to grids of points: axes expanded, and what does not go together refused.

Imports nothing heavy, since the workflow reads it whenever it is parsed.
"""

import math
from itertools import pairwise
from typing import Any

from microslip.config.records import MODELS_OF_MOTION, MOTION_OF_SWEEP, ConfigError, Sweep
from microslip.foundation.canonical import number

# More points than this are a slip of the pen: naming them all takes the workflow a minute whenever
# it starts.
MOST_POINTS = 1_000_000
DRIVES = ("mass", "damping", "stiffness", "force")
"""Settings that say what pulls, in the order of the dimensions of a dataset."""


def of_paper(name: str, given: dict, where: str) -> Sweep:
    """The Sweep of a motion of the paper; given: dict of settings, with defaults filled in.

    where: how messages begin, file and key. Raises ConfigError.
    """
    sweep = grid_of(name, MOTION_OF_SWEEP[name], given, where)
    _refuse_mismatch(sweep, where)
    return sweep


def grid_of(name: str, motion: str, given: dict, where: str, **more: Any) -> Sweep:
    """A Sweep with its axes expanded, of settings with defaults filled in; more: its other fields.

    Raises ConfigError, beginning with `where`, for a bad axis or too many points.
    """
    poisson, amplitude, velocity = given["poisson"], given.get("amplitude"), given.get("velocity")
    sweep = Sweep(
        name=name,
        motion=motion,
        velocity=() if velocity is None else axis_of(velocity, f"{where}.velocity"),
        amplitude=None if amplitude is None else axis_of(amplitude, f"{where}.amplitude"),
        poisson=axis_of(poisson if isinstance(poisson, list) else [poisson], f"{where}.poisson"),
        poisson_is_axis=isinstance(poisson, list),
        model=given["model"],
        tolerance=None if given["tolerance"] is None else float(number(given["tolerance"])),
        cells=given["cells"],
        steps=given["steps"],
        **more,
    )
    _refuse_no_tolerance(sweep, where)
    points = len(sweep.velocity or (None,)) * len(sweep.amplitude or (None,)) * len(sweep.poisson)
    points *= math.prod(len(values) for _, values, _ in sweep.drives)
    refuse_crowd(points, where, MOST_POINTS)
    return sweep


def _refuse_no_tolerance(sweep: Sweep, where: str) -> None:
    """Raise ConfigError where no tolerance is meant but the resolution is not imposed, either.

    What has neither cells nor steps is left to the solver, which then has nothing to choose.
    """
    free = [name for name in ("cells", "steps") if getattr(sweep, name) is None]
    if sweep.amplitude is None:  # a steady motion takes no steps
        free = [name for name in free if name == "cells"]
    if sweep.tolerance is None and free:
        raise ConfigError(
            f"{where}.tolerance: null is not allowed; allowed: a number, or {' and '.join(free)} "
            "imposed"
        )


def drives_of(given: dict, where: str) -> tuple:
    """The `drives` of a Sweep; given: dict of settings with defaults filled in.

    Raises ConfigError, beginning with `where`, for a bad axis.
    """
    found = []
    for name in DRIVES:
        value = given.get(name)
        if value is not None:
            is_axis = isinstance(value, list | dict)
            values = axis_of(value if is_axis else [value], f"{where}.{name}")
            found.append((name, values, is_axis))
    return tuple(found)


def refuse_crowd(points: int, where: str, most: int) -> None:
    """Raise ConfigError for more points than `most`."""
    if points > most:
        raise ConfigError(f"{where}: {points} points are not allowed; allowed: at most {most}")


def axis_of(given: list | dict, where: str, positive: bool = False) -> tuple[float, ...]:
    """Coordinates of an axis, an ascending tuple; given: a list, or a dict of one spacing.

    positive: whether 0 is refused. Raises ConfigError, beginning with `where`.
    """
    if isinstance(given, list):
        values = [float(number(value)) for value in given]
    else:
        ((spacing, spec),) = given.items()
        values = _spaced(spacing, spec, f"{where}.{spacing}")
    values.sort()
    for low, high in pairwise(values):
        if high - low <= 1e-9 * high:
            raise ConfigError(f"{where}: {high:.12g} occurs twice; allowed: different values")
    if positive and values[0] <= 0:
        raise ConfigError(f"{where}: {values[0]:g} is not allowed; allowed: numbers > 0")
    return tuple(values)


def _spaced(spacing: str, spec: dict, where: str) -> list[float]:
    start, stop, count = spec["start"], spec["stop"], spec["count"]
    if stop <= start:
        raise ConfigError(f"{where}.stop: {stop} is not allowed; allowed: a number above {start}")
    if spacing == "log" and math.isinf(stop / start):
        raise ConfigError(f"{where}.start: {start} is not allowed; allowed: a number nearer {stop}")
    if spacing == "linear":
        values = (start + (stop - start) * i / (count - 1) for i in range(count))
    else:
        values = (start * math.exp(math.log(stop / start) * i / (count - 1)) for i in range(count))
    # Six digits make the coordinates readable, and the same on every machine.
    return [float(f"{value:.6g}") for value in values]


def _refuse_mismatch(sweep: Sweep, where: str) -> None:
    """Refuse settings that are fine one by one but not together."""
    known = MODELS_OF_MOTION[sweep.motion]
    if sweep.model not in known:
        raise ConfigError(
            f'{where}.model: "{sweep.model}" does not apply to {sweep.motion}; '
            f"allowed: {', '.join(known)}"
        )
    if sweep.model == "radial" and sweep.poisson[-1] > 0:
        raise ConfigError(
            f"{where}.poisson: {sweep.poisson[-1]:g} does not go with model radial; allowed: 0"
        )
