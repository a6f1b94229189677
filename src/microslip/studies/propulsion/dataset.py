"""The dataset propulsion: a line for every motion, from stall force to no-load velocity."""

from collections.abc import Callable, Iterator

import numpy as np
import xarray as xr

from microslip.config.settings import Propulsion
from microslip.datasets.variables import variable
from microslip.studies.propulsion import propulsion as study
from microslip.studies.tables import Answers, columns, finished, value_of

GROUPS: dict = {}
"""All of it is over lines and their points."""

POWER = "over mu times the mean normal load, u_lim and omega"
OF_LINE = {
    "stall_force": "load that stops the motion, over mu times the mean normal load",
    "stall_force_error": "largest error of stall_force, by estimate",
    "no_load_velocity": "forward velocity without a load, in the unit of the motion",
    "no_load_velocity_error": "largest error of no_load_velocity, by estimate",
}
"""Numbers of a line; negative where the motion propels the contact backward."""
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
    answers, motions = Answers(answer), list(settings.motions.values())
    titles = [motion.title or name for name, motion in settings.motions.items()]
    results = [answers(study.line(settings, motion)) for motion in motions]
    lines: dict[str, tuple] = {
        name: ([value_of(result, name) for result in results], text)
        for name, text in OF_LINE.items()
    }
    lines["converged"] = (
        [value_of(result, "converged", bool) for result in results],
        "whether every force and power is within the tolerance",
        bool,
    )
    reasons = [value_of(result, "reason", str) for result in results]
    lines["reason"] = (reasons, "why not, or why nothing is driven", str)
    points = {
        name: ([_padded(result, name, settings.points) for result in results], text)
        for name, text in OF_POINT.items()
    }
    coords = {
        "line": variable("line", list(settings.motions), "name of the motion", str),
        "title": variable("line", titles, "title of the line", str),
        "panel": variable("line", [m.panel for m in motions], "heading of its panels", str),
        "motion": variable("line", [m.motion for m in motions], "what moves", str),
        "amplitude": variable("line", [m.amplitude for m in motions], "amplitude of the motion"),
        "poisson": variable("line", [m.poisson for m in motions], "Poisson's ratio"),
    }
    variables = columns("line", lines) | columns(("line", "point"), points)
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
