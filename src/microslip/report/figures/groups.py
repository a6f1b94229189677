"""The figure of a group of sweeps in `extended`: a map of each, or a line of each on one panel."""

from __future__ import annotations

import xarray as xr
from matplotlib.figure import Figure

from microslip.report.figures import lines, poisson, small_maps
from microslip.report.figures import style as look
from microslip.report.figures.data import at_each_poisson, require, sweep

NEEDED = ("velocity", "mu_macro", "mu_macro_error", "converged")


def draw(name: str, *datasets: xr.Dataset) -> Figure:
    """Draw maps where every dataset has two amplitudes and two velocities above 0, lines where none
    has.

    Every Poisson's ratio of every dataset is drawn: where there is room, as what it changes; else a
    map or a line of its own. Raises ValueError for a mixture of maps and lines.
    """
    spanning = all(map(small_maps.spans_a_map, datasets))
    if spanning and all(map(poisson.shows, datasets)) and poisson.has_room(datasets):
        return poisson.draw(name, *datasets)
    shown, titles = [], []
    for dataset in datasets:
        key = dataset.attrs.get("title", name)
        require(name, key, dataset, NEEDED)
        dims = tuple(dim for dim in ("amplitude", "velocity") if dim in dataset["mu_macro"].dims)
        parts = [sweep(part, dims) for part in at_each_poisson(dataset)]
        for part, ratio in parts:
            shown.append(part)
            of = rf", $\nu = {look.number(ratio)}$" if len(parts) > 1 else ""
            titles.append(look.literal(dataset.attrs.get("title", "")) + of)
    spans = [small_maps.spans_a_map(dataset) for dataset in shown]
    if any(spans) and not all(spans):
        odd = shown[spans.index(False)].attrs.get("title")
        raise ValueError(f"figure {name}: {odd!r} spans no map, as others of its group do")
    return (small_maps if all(spans) else lines).draw(name, shown, titles)
