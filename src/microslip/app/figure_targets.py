"""Targets of the workflow, and the figures for which a configuration has data."""

from __future__ import annotations

from collections.abc import Callable

from microslip.config.records import Configuration, Sweep
from microslip.foundation.canonical import number
from microslip.report.figures import drawing
from microslip.studies import registry

TARGETS = {
    "all": "the datasets and figures of the configuration's sweeps (default)",
    "extended": "datasets and figures of other motions and pressures (key extended)",
    "drives": "datasets and figures of contacts driven by a force or a spring (key drives)",
    "certified": "maps with an error estimate everywhere, for sweeps with the key adaptive",
    "accuracy": "accuracy and cost of all models and methods",
    "stability": "conditions under which methods fail",
    "claims": "check of the statements of the paper",
    "explorer": "interactive page of the maps; a click on a point shows its period",
    "explorer_all": "the same page with all other sweeps of the configuration",
}
"""Targets of the workflow, each with a description of its products for users."""


def _span_maps(*grids: Sweep) -> bool:
    return all(grid.spans_a_map for grid in grids)


def _have_few_poissons(*grids: Sweep) -> bool:
    few = all(1 < len(grid.poisson) <= drawing.MOST_POISSONS for grid in grids)
    return few and _span_maps(*grids)


def _have_one_amplitude(*grids: Sweep) -> bool:
    return len({grid.amplitude for grid in grids}) == 1


def _share_a_point(reference: Sweep, *drives: Sweep) -> bool:
    pairs = [(reference.amplitude, drives[-1].amplitude), (reference.velocity, drives[-1].velocity)]
    points = [({*map(number, axis or ())}, [*map(number, values or ())]) for axis, values in pairs]
    return _have_one_amplitude(*drives) and all(
        len(values) == 1 and axis.issuperset(values) for axis, values in points
    )


CONDITIONS: dict[str, tuple[Callable[..., bool], str]] = {
    "fig2_transverse_map": (_span_maps, "several velocities and amplitudes"),
    "fig6_bore_map": (_span_maps, "several velocities and amplitudes"),
    "poisson": (
        _have_few_poissons,
        f"several velocities and amplitudes, and 2 to {drawing.MOST_POISSONS} Poisson's ratios",
    ),
    "drives": (
        _share_a_point,
        "in all others one amplitude, and in the last one velocity, both from the first",
    ),
}
"""Condition on a figure's sweeps, and a description of this condition for messages."""


def drawable(configuration: Configuration) -> dict[str, tuple[str, ...]]:
    """Return the figures for which the configuration has data, each with the names of its
    datasets."""
    figures = {
        figure: names
        for figure, names in drawing.FIGURES.items()
        if not why_no_figure(configuration, figure)
    }
    figures |= {drawing.figure_of(group): names for group, names in configuration.groups.items()}
    return figures | {name: (name,) for name in configuration.certified}


def why_no_figure(configuration: Configuration, figure: str) -> str | None:
    """Return the reason why a configuration lacks data for a figure, or None if it has the data.
    Figures are keys of drawing.FIGURES."""
    names = drawing.FIGURES[figure]
    datasets = {*configuration.sweeps, *configuration.drives, *registry.DATASETS.values()}
    for name in names:
        if name not in datasets:
            return f"{figure} needs the sweep {name}, which the configuration does not have"
    condition, text = CONDITIONS.get(figure, (None, ""))
    if condition is None or condition(*(configuration.grids[name] for name in names)):
        return None
    return f"{figure} cannot be drawn from {' and '.join(names)}; needed: {text}"


def heading_of(configuration: Configuration, dataset: str) -> str:
    """Return the report's heading for figures whose first dataset is `dataset`."""
    headings = {
        "The paper's figures": configuration.sweeps,
        "Other motions and pressures": configuration.extended,
        "Drives": configuration.drives,
        "Certified maps": configuration.certified,
        "The paper's claims": ["claims"],
    }
    return next((text for text, names in headings.items() if dataset in names), "Methods")
