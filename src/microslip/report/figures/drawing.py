"""Draw figures from datasets and save them.

Figures show stored numbers only: every curve, including theoretical ones, is a variable of a
dataset. The kind of figure determines the function that draws it. The module `style` defines
colours and fonts.

    figure = draw("map", {"transverse": loaded("results/transverse.nc")})
    save(figure, "results/figures/fig2_transverse_map.pdf")

Matplotlib is imported by the first call of `draw` or `save`.
"""

from __future__ import annotations

import importlib
import json
import os
import sys
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from microslip.config.kinds import KINDS
from microslip.foundation.files import CacheError, writing_beside

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

DRAWN = {kind: one.draw for kind, one in KINDS.items() if one.draw}
DRAWN |= {"fit": "predictions.fit", "curve": "predictions.curve"}
"""Module and function that draw each kind of figure.  The kinds fit and curve are drawn by
commands, from the results of the command."""
FORMATS: dict[str, tuple[dict[str, None], str]] = {
    "png": ({"Software": None}, "Description"),
    "pdf": ({"Creator": None, "Producer": None, "CreationDate": None}, "Subject"),
}
"""File formats of `save`. For each format: the metadata to omit (dates and versions), and the
metadata entry that contains the provenance."""
PROVENANCE = ["title", "references", "microslip_version", "source_digest", "results_digest"]
PROVENANCE += ["configuration", "library_versions"]
"""Attributes of a dataset that describe its provenance."""


def modules_of(kind: str) -> tuple[str, ...]:
    """Return the paths of the modules that draw a kind of figure, relative to the package.

    Modules that these modules import are not included.
    """
    return "report/figures/drawing.py", f"report/figures/{DRAWN[kind].partition('.')[0]}.py"


def draw(kind: str, datasets: Mapping[str, xr.Dataset]) -> Figure:
    """Draw one figure.

    Parameters
    ----------
    kind : str
        Kind of figure, which is a key of `DRAWN`.
    datasets : dict of xarray.Dataset
        The datasets of the figure by name, each including its groups.

    Returns
    -------
    Figure
        A figure without a window and without global state.
    """
    import_matplotlib()
    from microslip.report.figures.style import style

    module, _, function = DRAWN[kind].partition(".")
    draw_panels = getattr(importlib.import_module(f"microslip.report.figures.{module}"), function)
    with style():
        figure = draw_panels(*datasets.values())
        for _ in range(2):  # the second pass converges; the layout is then fixed
            figure.get_layout_engine().execute(figure)
        figure.set_layout_engine("none")
        for finish in getattr(figure, "finishing", ()):
            finish()
    attributes = [one.attrs for one in datasets.values()]
    made = [{key: one[key] for key in PROVENANCE if key in one} for one in attributes]
    figure.made_from = json.dumps(made, sort_keys=True)
    return figure


def import_matplotlib() -> None:
    """Import matplotlib, even if the environment variable MPLBACKEND has an unknown value.

    With such a value, an ordinary import would fail. Figures of this package need no backend. If
    matplotlib knows the backend that the variable names, other figures in the process use this
    backend.
    """
    if "matplotlib" in sys.modules:
        return
    backend = os.environ.pop("MPLBACKEND", "")
    import matplotlib

    if backend:
        os.environ["MPLBACKEND"] = backend
        with suppress(ValueError):
            matplotlib.rcParams["backend"] = backend


def save(figure: Figure, path: str | os.PathLike[str]) -> Path:
    """Write a figure atomically as `.png` (300 dpi) or `.pdf`, and return the path of the file.

    The metadata contain the provenance of the datasets as a JSON list, but no date, so that
    identical figures give byte-identical files. A missing folder is created. Raises CacheError if
    the file cannot be written.
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


def loaded(path: str | os.PathLike[str]) -> xr.Dataset:
    """Read a file, including its groups, into one dataset for `draw`.

    Raises CacheError if the file is missing or damaged.
    """
    from microslip.datasets.netcdf import whole

    try:
        return whole(path)
    except (OSError, RuntimeError, ValueError) as error:
        why = " ".join(str(getattr(error, "strerror", None) or error).split())
        raise CacheError(
            f"cannot read the dataset {path}: {why}; allowed: a netCDF file that the workflow made;"
            " remove it and run again: finished points are kept"
        ) from error
