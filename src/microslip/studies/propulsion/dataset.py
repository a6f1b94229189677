"""The dataset propulsion: a line for every motion, from stall force to no-load velocity."""

from collections.abc import Callable, Iterator

import numpy as np
import xarray as xr

from microslip.config.settings import Propulsion
from microslip.datasets.variables import variable
from microslip.studies.propulsion import propulsion as study
from microslip.studies.tables import Answers, finished, table, value_of

GROUPS: dict = {}
"""All of it is over lines and their points."""

POWER = "over mu times the mean normal load, u_lim and omega"


def _number(name: str) -> Callable[[dict], float]:
    return lambda result: value_of(result, name)


LINE_COLUMNS: dict[str, tuple] = {
    name: (_number(name), text)
    for name, text in {
        "stall_force": "load that stops the motion, over mu times the mean normal load",
        "stall_force_error": "largest error of stall_force, by estimate",
        "no_load_velocity": "forward velocity without a load, in the unit of the motion",
        "no_load_velocity_error": "largest error of no_load_velocity, by estimate",
    }.items()
} | {
    "converged": (
        lambda result: value_of(result, "converged", bool),
        "whether every force and power is within the tolerance",
        bool,
    ),
    "reason": (
        lambda result: value_of(result, "reason", str),
        "why not, or why nothing is driven",
        str,
    ),
}
"""Columns of a line; numbers are negative where the motion propels the contact backward."""
COORDINATES: dict[str, tuple] = {
    "line": (lambda name, _: name, "name of the motion", str),
    "title": (lambda name, motion: motion.title or name, "title of the line", str),
    "panel": (lambda _, motion: motion.panel, "heading of its panels", str),
    "motion": (lambda _, motion: motion.motion, "what moves", str),
    "amplitude": (lambda _, motion: motion.amplitude, "amplitude of the motion"),
    "poisson": (lambda _, motion: motion.poisson, "Poisson's ratio"),
}
OF_POINT = {
    "velocity": "forward velocity, in equal parts from 0 to no_load_velocity",
    "force": "mean force that the motion pulls with, over mu times the mean normal load",
    "force_error": "largest error of force, by estimate",
    "power_out": f"force times velocity, {POWER}",
    "power_out_error": "largest error of power_out, by estimate",
    "power_in": f"mean work of the oscillation on the contact, {POWER}",
    "power_in_error": "largest error of power_in, by estimate",
    "efficiency": "power_out over power_in",
    "efficiency_error": "largest error of efficiency, by estimate",
}
"""Numbers of every point of a line; NaN where nothing is driven."""


def build(settings: Propulsion, answer: Callable) -> xr.Dataset:
    """Assemble the Dataset.

    answer(request) -> record, such as batches.answer with a store.
    """
    answers = Answers(answer)
    results = [answers(study.line(settings, motion)) for motion in settings.motions.values()]
    variables = table("line", ((result,) for result in results), LINE_COLUMNS)
    for name, text in OF_POINT.items():
        rows = [_padded(result, name, settings.points) for result in results]
        variables[name] = variable(("line", "point"), rows, text)
    coords = table("line", settings.motions.items(), COORDINATES)
    title = "What motions drive a Hertz contact with, from stall force to no-load velocity"
    more = {"tolerance": settings.tolerance}
    return finished(variables, coords, title, answers, settings, **more)


def report(dataset: xr.Dataset) -> Iterator[str]:
    """Lines of text: what every motion drives."""
    for index, name in enumerate(dataset["line"].values):
        one = dataset.isel(line=index)
        if not bool(one["converged"]) or str(one["reason"].values):
            yield f"{name}: {one['reason'].values}"
            continue
        best = float(one["efficiency"].max())
        yield (
            f"{name}: stall force {float(one['stall_force']):.4g}, no-load velocity "
            f"{float(one['no_load_velocity']):.4g}, efficiency up to {best:.3g}"
        )


def _padded(result: dict, name: str, count: int) -> np.ndarray:
    """The numbers of a line, NaN where it has no points."""
    found = [np.nan if value is None else value for value in result.get(name) or []]
    return np.array(found + [np.nan] * (count - len(found)))
