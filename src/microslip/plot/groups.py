"""The figure of a group of sweeps in `extended`: a map of each, or a line of each on one panel."""

from __future__ import annotations

import xarray as xr
from matplotlib.figure import Figure

from microslip.plot import lines, poisson, small_maps
from microslip.plot.data import require, sweep

NEEDED = ("velocity", "mu_macro", "mu_macro_error", "converged")


def draw(name: str, *datasets: xr.Dataset) -> Figure:
    """Draw maps where every dataset has two amplitudes and two velocities above 0, lines where none
    has; of maps at several of Poisson's ratios, what these change. Raises ValueError for a mixture
    of maps and lines."""
    if all(map(poisson.shows, datasets)) and all(map(small_maps.spans_a_map, datasets)):
        return poisson.draw(name, *datasets)
    shown = []
    for dataset in datasets:
        key = dataset.attrs.get("title", name)
        require(name, key, dataset, NEEDED)
        dims = tuple(dim for dim in ("amplitude", "velocity") if dim in dataset["mu_macro"].dims)
        shown.append(sweep(dataset, dims)[0])
    spanning = [small_maps.spans_a_map(dataset) for dataset in shown]
    if any(spanning) and not all(spanning):
        odd = shown[spanning.index(False)].attrs.get("title")
        raise ValueError(f"figure {name}: {odd!r} spans no map, as others of its group do")
    return (small_maps if all(spanning) else lines).draw(name, shown)
