"""Datasets to figures.

The figures draw what the datasets hold and compute nothing: every curve, theory included, is a
variable of a dataset. One module draws one kind of figure; `style` holds the look, `data` the
checks on what a dataset holds.

    figure = draw("fig2_transverse_map", {"transverse": data.loaded("results/transverse.nc")})
    save(figure, "results/figures/fig2_transverse_map.pdf")

Importing this package is cheap: matplotlib is loaded by the first `draw` or `save`.
"""

from __future__ import annotations

import importlib
import json
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from microslip.config.records import MOTION_OF_SWEEP
from microslip.foundation.files import writing_beside

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_DRAWN: dict[str, tuple[str, ...]] = {
    "fig1_force_history": ("history", "transverse"),
    "fig2_transverse_map": ("maps", "transverse"),
    "fig3_traction_field": ("field", "continuous_bore"),
    "fig4_continuous_bore": ("steady", "continuous_bore"),
    "fig5_transients": ("transients", "continuous_bore"),
    "fig6_bore_map": ("maps", "bore"),
    "poisson": ("poisson", "transverse", "bore"),
    "drift_maps": ("drift", "drift_transverse", "drift_bore"),
    "drives": ("drives", "transverse", "drive_force", "drive_spring", "drive_body"),
    "pairs": ("pairs", "one_spring", "pair_spring", "pair_force"),
    "accuracy_profile": ("profile", "accuracy_cost"),
    "accuracy_vs_cost": ("work_precision", "accuracy_cost"),
    "accuracy_vs_work": ("work_precision", "accuracy_cost"),
    "model_map": ("model_map", "accuracy_cost"),
    "scaling": ("scaling", "accuracy_cost"),
    "stability_atlas": ("atlas", "stability"),
    "claims_static": ("claims_static", "claims"),
    "claims_patches": ("claims_patches", "claims"),
    "propulsion": ("propulsion", "propulsion"),
}
"""Every figure: the module beside this one that draws it, and the datasets it is drawn from."""
_MODULES = {name: module for name, (module, *_) in _DRAWN.items()} | {"fit": "fit"}
FIGURES = {name: tuple(datasets) for name, (_, *datasets) in _DRAWN.items()}
"""Every figure and its datasets, but for those of groups in `extended`, which have the names that
`figure_of` gives and all the datasets of their group, and of certified maps."""

SHORT_NAMES = {name.partition("_")[0]: name for name in FIGURES if name.startswith("fig")}
"""Figures of the paper by their numbers: fig1 to fig6."""

ON_DEMAND = {"fit": ("fit",)}
"""Figures that commands draw from their own results, not the workflow, and their datasets."""
CERTIFIED = "certified_"
"""Prefix of the names of certified maps; a figure of one has the name of its dataset."""
MOST_POISSONS = 4
"""Lines that the figure of Poisson's ratios can tell apart."""

FORMATS: dict[str, tuple[dict[str, None], str]] = {
    "png": ({"Software": None}, "Description"),
    "pdf": ({"Creator": None, "Producer": None, "CreationDate": None}, "Subject"),
}
"""File formats `save` can write: metadata that would otherwise hold dates or versions of libraries,
and the name of the one that says what the figure was made from."""
PROVENANCE: tuple[str, ...] = (
    "title",
    "references",
    "microslip_version",
    "source_digest",
    "results_digest",
)
PROVENANCE += ("configuration", "library_versions")

__all__ = ["FIGURES", "FORMATS", "draw", "save"]


def figure_of(group: str) -> str:
    """Name of the figure of a group of sweeps in `extended`."""
    return f"extended_{group}"


def modules_of(name: str) -> tuple[str, ...]:
    """Paths inside the package of the modules that draw a figure, besides what they import."""
    folder = "report/figures"
    return f"{folder}/drawing.py", f"{folder}/{_module_of(name)}.py"


def _module_of(name: str) -> str:
    if name.startswith(CERTIFIED):
        return "certified"
    return _MODULES.get(name, "groups")


def draw(name: str, datasets: Mapping[str, xr.Dataset]) -> Figure:
    """Draw one figure.

    name: a key of `FIGURES` or `ON_DEMAND`, what `figure_of` gives for a group, or the name of a
    certified map. datasets: at
    least those that these list, by their key, or all of that group; others are ignored. Raises
    ValueError if the name is unknown, a dataset is of another motion, or a dataset, variable or
    dimension the figure needs is missing. The figure belongs to no window and no global state.
    """
    keys = _keys_of(name, datasets)
    missing = [key for key in keys if key not in datasets]
    if missing:
        given = ", ".join(map(repr, datasets)) or "none"
        raise ValueError(f"figure {name} needs the dataset {missing[0]!r}; given: {given}")
    for key in keys:
        motion, found = MOTION_OF_SWEEP.get(key), datasets[key].attrs.get("motion")
        if motion and found not in (motion, None):
            raise ValueError(f"figure {name}: dataset {key!r} is of {found!r}; allowed: {motion!r}")
    from microslip.report.figures.style import style

    module = importlib.import_module(f"microslip.report.figures.{_module_of(name)}")
    with style():
        figure = module.draw(name, *(datasets[key] for key in keys))
        if (layout := figure.get_layout_engine()) is not None:
            for _ in range(2):  # it settles, and is then fixed: every save gives the same
                layout.execute(figure)
            figure.set_layout_engine("none")
        for finish in getattr(figure, "finishing", ()):
            finish()
    figure.made_from = made_from(datasets[key] for key in keys)
    return figure


def _keys_of(name: str, datasets: Mapping[str, xr.Dataset]) -> tuple[str, ...]:
    """Keys of the datasets that a figure is drawn from."""
    if known := FIGURES.get(name) or ON_DEMAND.get(name):
        return known
    if name.startswith(CERTIFIED):
        return (name,)
    groups = {key: dataset.attrs.get("group") for key, dataset in datasets.items()}
    keys = tuple(key for key, group in groups.items() if group and figure_of(group) == name)
    if not keys:
        raise ValueError(
            f"unknown figure {name!r}; known figures: {', '.join(FIGURES)}, and extended_GROUP for "
            "the group of datasets that are given"
        )
    return keys


def made_from(datasets: Iterable[xr.Dataset]) -> str:
    """Provenance of datasets, as JSON: a list of their attributes in PROVENANCE."""
    found = [{key: d.attrs[key] for key in PROVENANCE if key in d.attrs} for d in datasets]
    return json.dumps(found, sort_keys=True)


def save(figure: Figure, path: str | os.PathLike[str]) -> Path:
    """Write a figure as `.png` (300 dpi) or `.pdf`, whole or not at all, and return its path.

    Its metadata say what made it, see `made_from`. The same figure gives the same bytes: no date is
    written. The folder is made if it is not there. Raises CacheError, one line that says what to
    do, on a full disk, a read-only folder and the like.
    """
    from microslip.report.figures.style import style

    path = Path(path)
    kind = path.suffix.lower().removeprefix(".")
    if kind not in FORMATS:
        raise ValueError(f"cannot write {path.name!r}: the name must end in .png or .pdf")
    plain, key = FORMATS[kind]
    metadata = plain | {key: getattr(figure, "made_from", None)}
    with writing_beside(path) as beside, style():
        _write(figure, kind, beside, metadata)
    return path


def _write(figure: Figure, kind: str, path: Path, metadata: Mapping[str, str | None]) -> None:
    """Write a figure as `savefig` does, but without a second layout."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.backends.backend_pdf import FigureCanvasPdf

    canvas, dpi = figure.canvas, figure.dpi
    try:
        if kind == "png":
            FigureCanvasAgg(figure).print_png(path, metadata=metadata)
        else:
            FigureCanvasPdf(figure).print_pdf(path, metadata=metadata)
    finally:
        figure.set_canvas(canvas)
        figure.dpi = dpi
