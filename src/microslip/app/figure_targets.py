"""Targets of the workflow, and the figures for which a configuration has data."""

from __future__ import annotations

import math
from collections.abc import Sequence

from microslip.config.records import Configuration
from microslip.report.figures import drawing
from microslip.studies import registry

TARGETS = {
    "all": "the datasets and figures of the configuration's sweeps (default)",
    "extended": "datasets and figures of other motions and pressures (key extended)",
    "drives": "datasets and figures of contacts driven by a force or a spring (key drives)",
    "certified": "maps with an error estimate everywhere, of the sweeps with the key adaptive",
    "accuracy": "accuracy and cost of all models and methods",
    "stability": "conditions under which methods fail",
    "claims": "check of the statements of the paper",
    "propulsion": "force of self-propelled motions, from stall to no load",
    "explorer": "interactive page of the maps; a click on a point shows its period",
    "explorer_all": "the same page with all other sweeps of the configuration",
}
"""Targets of the workflow for users, and the products of each."""


def drawable(configuration: Configuration) -> dict[str, tuple[str, ...]]:
    """Figures for which the configuration has data, and the names of the datasets of each
    figure."""
    datasets = _datasets(configuration)
    figures = {
        figure: names
        for figure, names in drawing.FIGURES.items()
        if datasets >= set(names) and _is_drawable(figure, names, configuration)
    }
    figures |= {drawing.figure_of(group): names for group, names in configuration.groups.items()}
    return figures | {name: (name,) for name in configuration.certified}


def _datasets(configuration: Configuration) -> set[str]:
    """Names of the datasets of all figures, except figures of groups and certified maps."""
    return {*configuration.sweeps, *configuration.drives, *registry.DATASETS.values()}


def _is_drawable(figure: str, names: tuple[str, ...], configuration: Configuration) -> bool:
    """True if the datasets of a figure contain enough points to draw it.

    A figure of a map needs several velocities and amplitudes.  A comparison needs datasets with
    the same amplitude and velocity.
    """
    if figure == "drives":
        reference, *drives, body = (configuration.grids[name] for name in names)
        same = {grid.amplitude for grid in (*drives, body)} == {body.amplitude}
        return (
            same
            and _has(reference.amplitude, body.amplitude)
            and _has(reference.velocity, body.velocity)
        )
    if figure == "pairs":
        return len({configuration.grids[name].amplitude for name in names}) == 1
    if figure not in ("fig2_transverse_map", "fig6_bore_map", "poisson"):
        return True
    grids = [configuration.sweeps[name] for name in names]
    if not all(grid.spans_a_map for grid in grids):
        return False
    few = all(1 < len(grid.poisson) <= drawing.MOST_POISSONS for grid in grids)
    return few or figure != "poisson"


def _has(axis: Sequence[float] | None, values: Sequence[float] | None) -> bool:
    """True if `values` has a single value, and an axis contains it up to rounding."""
    if axis is None or values is None:
        return False
    return len(values) == 1 and any(math.isclose(value, values[0]) for value in axis)


def why_no_figure(configuration: Configuration, figure: str) -> str:
    """The reason why a figure, a key of drawing.FIGURES, has no data in a configuration."""
    names = drawing.FIGURES[figure]
    missing = [name for name in names if name not in _datasets(configuration)]
    if missing:
        return f"{figure} needs the sweep {missing[0]}, which the configuration does not have"
    return (
        f"{figure} cannot be drawn from {' and '.join(names)}: a map needs several velocities and "
        "amplitudes, and some figures need equal or several values of other axes"
    )


def heading_of(configuration: Configuration, dataset: str) -> str:
    """Heading, in the report of a run, for the figures whose first dataset is this one."""
    headings = {
        "The paper's figures": configuration.sweeps,
        "Other motions and pressures": configuration.extended,
        "Drives": configuration.drives,
        "Certified maps": configuration.certified,
        "The paper's claims": ["claims"],
        "Self-propelled motions": ["propulsion"],
    }
    return next((text for text, names in headings.items() if dataset in names), "Methods")
