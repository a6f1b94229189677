"""Build the dataset propulsion: for every motion, a line from stall force to no-load velocity."""

from collections.abc import Callable, Iterator

import numpy as np
import xarray as xr

from microslip.config.settings import Propulsion
from microslip.datasets.variables import variable
from microslip.studies.propulsion import propulsion as study
from microslip.studies.tables import Answers, finished, table, value_of

GROUPS: dict = {}
"""Groups of the dataset. There are no groups, because all variables are in one table."""

LINE_COLUMNS: dict[str, tuple] = {
    "stall_force": ("load that stops the motion, divided by mu times the mean normal load", float),
    "stall_force_error": ("error estimate of stall_force", float),
    "no_load_velocity": ("forward velocity without a load, in the unit of the motion", float),
    "no_load_velocity_error": ("error estimate of no_load_velocity", float),
    "converged": ("every force and power is within the tolerance", bool),
    "reason": ("reason why not, or why the motion propels nothing", str),
}
"""Results of a line: name -> (long_name, type). Numbers are negative if the motion propels
backward."""
COORDINATES: dict[str, tuple] = {
    "line": (lambda name, _: name, "name of the motion", str),
    "title": (lambda name, motion: motion.title or name, "title of the line", str),
    "panel": (lambda _, motion: motion.panel, "heading of the panels of the line", str),
    "motion": (lambda _, motion: motion.motion, "motion", str),
    "amplitude": (lambda _, motion: motion.amplitude, "amplitude of the motion"),
    "poisson": (lambda _, motion: motion.poisson, "Poisson's ratio"),
}
POWER = "divided by mu times the mean normal load, u_lim and omega"
POINT_COLUMNS = {
    "velocity": "forward velocity, in equal steps from 0 to no_load_velocity",
    "force": "mean propelling force, divided by mu times the mean normal load",
    "force_error": "error estimate of force",
    "power_out": f"force times velocity, {POWER}",
    "power_out_error": "error estimate of power_out",
    "power_in": f"mean power of the oscillation, {POWER}",
    "power_in_error": "error estimate of power_in",
    "efficiency": "power_out divided by power_in",
    "efficiency_error": "error estimate of efficiency",
}
"""Results at every point of a line: name -> long_name. They are NaN if the motion does not propel
the body."""


def build(settings: Propulsion, answer: Callable) -> xr.Dataset:
    """Build the dataset of the study.

    answer: function that returns the record of a request, such as batches.answer with a store.
    """
    answers = Answers(answer)
    results = [answers(study.line(settings, motion)) for motion in settings.motions.values()]
    variables = {}
    for name, (text, kind) in LINE_COLUMNS.items():
        values = [value_of(result, name, kind) for result in results]
        variables[name] = variable("line", values, text, kind)
    for name, text in POINT_COLUMNS.items():
        rows = np.full((len(results), settings.points), np.nan)
        for row, result in zip(rows, results, strict=True):
            numbers = result.get(name) or []
            row[: len(numbers)] = numbers
        variables[name] = variable(("line", "point"), rows, text)
    variables |= table("line", settings.motions.items(), COORDINATES)
    title = "Propulsion of a Hertz contact by self-propelled motions, from stall force to no load"
    more = {"tolerance": settings.tolerance}
    return finished(variables, title, answers, settings, COORDINATES, **more)


def report(dataset: xr.Dataset) -> Iterator[str]:
    """Yield lines of text: stall force, no-load velocity and efficiency of every motion."""
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
