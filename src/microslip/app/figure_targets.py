"""Targets of the workflow that make a single figure, such as `snakemake fig2`."""

from __future__ import annotations

from microslip.app.plan import Plan
from microslip.app.sweep_command import TARGETS
from microslip.report.figures import drawing


def targets_of(plan: Plan) -> dict[str, str]:
    """Figures by the names of their targets: their own names, and fig1 to fig6.

    Names that are targets already, such as drives, are left out. Figures that the configuration has
    no data for have a target, too, which refuses with `why_no_figure`.
    """
    names = {name: name for name in (*drawing.FIGURES, *plan.figures)} | drawing.SHORT_NAMES
    return {name: figure for name, figure in names.items() if name not in TARGETS}


def why_no_figure(plan: Plan, figure: str) -> str:
    """Why a configuration leads to no such figure, a key of drawing.FIGURES, in one line."""
    configuration, names = plan.configuration, drawing.FIGURES[figure]
    known = {*configuration.sweeps, *configuration.drives, *plan.studies}
    missing = [name for name in names if name not in known]
    if missing:
        return f"{figure} needs the sweep {missing[0]}, which the configuration has not"
    return (
        f"{figure} cannot be drawn from {' and '.join(names)}: a map needs several velocities and "
        "amplitudes, and some figures need equal or several values of other axes"
    )
