"""Draw figures from datasets and save them.

Figures show stored numbers only: every curve, including those from theory, is a variable of a
dataset. Each kind of figure has a module. The module `style` defines colours and fonts, and `data`
selects parts of datasets.

    figure = draw("fig2_transverse_map", {"transverse": data.loaded("results/transverse.nc")})
    save(figure, "results/figures/fig2_transverse_map.pdf")

Matplotlib is imported by the first call of `draw` or `save`.
"""

from __future__ import annotations

import importlib
import json
import os
import sys
from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from microslip.config.records import CERTIFIED
from microslip.foundation.files import writing_beside

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_DRAWN: dict[str, tuple[str, ...]] = {
    "fig1_force_history": ("history.draw", "transverse"),
    "fig2_transverse_map": ("maps.draw", "transverse"),
    "fig3_traction_field": ("field.draw", "continuous_bore"),
    "fig4_continuous_bore": ("steady.curves", "continuous_bore"),
    "fig5_transients": ("steady.transients", "continuous_bore"),
    "fig6_bore_map": ("maps.draw", "bore"),
    "poisson": ("poisson.draw", "transverse", "bore"),
    "drift_maps": ("drift.draw", "drift_transverse", "drift_bore"),
    "drives": ("drives.drives", "transverse", "drive_force", "drive_spring", "drive_body"),
    "accuracy_profile": ("accuracy.profile", "accuracy_cost"),
    "accuracy_vs_cost": ("work_precision.draw", "accuracy_cost"),
    "accuracy_vs_work": ("work_precision.draw", "accuracy_cost"),
    "model_map": ("model_map.draw", "accuracy_cost"),
    "stability_atlas": ("atlas.draw", "stability"),
    "claims_static": ("claims.static", "claims"),
    "claims_patches": ("claims.patches", "claims"),
    "fit": ("fit.draw", "fit"),
    "curve": ("curve.draw", "curve"),
}
"""For each figure, the module and function that draw it, and the names of its datasets."""

ON_DEMAND = ("fit", "curve")
"""Figures that commands draw from their own results."""
FIGURES = {name: tuple(keys) for name, (_, *keys) in _DRAWN.items() if name not in ON_DEMAND}
"""Figures of the workflow, with the names of the datasets.

Figures whose names depend on the configuration are not included. These are the figures for
certified maps and for groups in `extended`, see `figure_of`.
"""

SHORT_NAMES = {name.partition("_")[0]: name for name in FIGURES if name.startswith("fig")}
"""Full names of the paper's figures, keyed by their short names fig1 to fig6."""

MOST_POISSONS = 4
"""Maximum number of Poisson's ratios in the figure `poisson`."""

FORMATS: dict[str, tuple[dict[str, None], str]] = {
    "png": ({"Software": None}, "Description"),
    "pdf": ({"Creator": None, "Producer": None, "CreationDate": None}, "Subject"),
}
"""Formats of `save`, each with the metadata to omit (dates and versions) and the entry that
contains the provenance."""
PROVENANCE = ["title", "references", "microslip_version", "source_digest", "results_digest"]
PROVENANCE += ["configuration", "library_versions"]
"""Attributes of a dataset that describe its provenance."""

__all__ = ["FIGURES", "FORMATS", "draw", "save"]


def figure_of(group: str) -> str:
    """Return the name of the figure for a group of sweeps in `extended`."""
    return f"extended_{group}"


def modules_of(name: str) -> tuple[str, ...]:
    """Return the paths of the modules that draw a figure, relative to the package.

    Modules that these modules import are not included.
    """
    folder = "report/figures"
    return f"{folder}/drawing.py", f"{folder}/{_function_of(name)[0]}.py"


def _function_of(name: str) -> tuple[str, str]:
    """Return the names of the module and the function that draw a figure."""
    other = "certified.draw" if name.startswith(CERTIFIED) else "groups.draw"
    module, _, function = _DRAWN.get(name, (other,))[0].partition(".")
    return module, function


def draw(name: str, datasets: Mapping[str, xr.Dataset]) -> Figure:
    """Draw one figure.

    Parameters
    ----------
    name : str
        Name of the figure: a key of `FIGURES`, an entry of `ON_DEMAND`, a value that `figure_of`
        returns, or the name of a certified map.
    datasets : dict of xarray.Dataset
        The datasets of the figure by name, or all datasets of the group.

    Returns
    -------
    Figure
        A figure without a window and without global state.
    """
    import_matplotlib()
    from microslip.report.figures.style import style

    keys = _DRAWN[name][1:] if name in _DRAWN else datasets
    shown = [datasets[key] for key in keys]
    module, function = _function_of(name)
    draw_panels = getattr(importlib.import_module(f"microslip.report.figures.{module}"), function)
    with style():
        figure = draw_panels(name, *shown)
        for _ in range(2):  # the second pass converges; the layout is then fixed
            figure.get_layout_engine().execute(figure)
        figure.set_layout_engine("none")
        for finish in getattr(figure, "finishing", ()):
            finish()
    figure.made_from = made_from(shown)
    return figure


def import_matplotlib() -> None:
    """Import matplotlib with any value of MPLBACKEND in the environment.

    matplotlib cannot be imported if this variable has an unknown value. Figures of this package
    need no backend. Other figures of the process get the backend of the variable if it is known.
    """
    if "matplotlib" in sys.modules:
        return
    backend = os.environ.pop("MPLBACKEND", None)
    try:
        matplotlib = importlib.import_module("matplotlib")
    finally:
        if backend is not None:
            os.environ["MPLBACKEND"] = backend
    if backend:
        with suppress(ValueError):
            matplotlib.rcParams["backend"] = backend


def made_from(datasets: Iterable[xr.Dataset]) -> str:
    """Return the provenance of datasets: a JSON list of their attributes in `PROVENANCE`."""
    attributes = [{key: d.attrs[key] for key in PROVENANCE if key in d.attrs} for d in datasets]
    return json.dumps(attributes, sort_keys=True)


def save(figure: Figure, path: str | os.PathLike[str]) -> Path:
    """Write a figure atomically as `.png` (300 dpi) or `.pdf` and return its path.

    The metadata contain the provenance, see `made_from`, and no date, so that equal figures have
    equal bytes. A missing folder is created. Raises CacheError if the file cannot be written.
    """
    import_matplotlib()
    from microslip.report.figures.style import style

    path = Path(path)
    kind = path.suffix.lower().removeprefix(".")
    plain, key = FORMATS[kind]
    metadata = plain | {key: getattr(figure, "made_from", None)}
    with writing_beside(path) as beside, style():
        figure.savefig(beside, format=kind, metadata=metadata)
    return path
