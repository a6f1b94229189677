"""Limits from theory in a dataset, as values that JSON can hold."""

from __future__ import annotations

from typing import Any

import xarray as xr

from microslip.report.figures import maps, style
from microslip.report.figures.data import limit
from microslip.sweeps.evaluate import plain
from microslip.theory.catalogue import FORMS, ClosedForm

FIGURES = {"transverse": "fig2_transverse_map", "bore": "fig6_bore_map"}
SPARE_COLOURS = (style.SKY, style.GREY)
NAMES = {
    name: form
    for forms in FORMS.values()
    for name, form in forms.items()
    if not name.startswith("mu_torque")
}
"""A form of every name that a limit of the friction may have."""


def limits_of(dataset: xr.Dataset, poisson: float) -> list[dict]:
    """The limits that a dataset at one of Poisson's ratios holds, on the axes of its points, and as
    a curve on its fine axis where it has one of its own.

    The curve of one that depends on both axes belongs to a single amplitude and is left out.
    """
    motion = dataset.attrs["motion"].partition(":")[0]
    own = FORMS.get(motion, {})
    known = [name for name in NAMES if name in dataset.variables]
    known.sort(key=lambda name: list(own).index(name) if name in own else len(own))
    return [_limit(dataset, motion, own.get(key, NAMES[key]), poisson) for key in known]


def _limit(dataset: xr.Dataset, motion: str, form: ClosedForm, poisson: float) -> dict:
    key = form.name
    looks = {}
    if motion in FIGURES:
        plan = maps.MAPS[FIGURES[motion]]
        looks = {overlay.variable: overlay for overlay in (*plan.static, plan.large)}
    spare = list(NAMES).index(key) % len(SPARE_COLOURS)
    look = looks.get(key, maps.Overlay(key, form.label, SPARE_COLOURS[spare], style.DOTTED))
    only_at_0 = poisson > 0 and form.exact and not form.any_poisson
    values = dataset[key]
    found = {
        "label": f"{look.label} for ν = 0" if only_at_0 else look.label,
        "long_name": values.attrs["long_name"],
        "color": look.color,
        "dash": "solid" if look.linestyle == style.SOLID else _dash(look.linestyle),
        "dims": list(values.dims),
        "values": plain(values.values),
    }
    if len(values.dims) == 1 and f"{key}_curve" in dataset:
        x, y = maps.curve(limit(dataset, key))
        found["curve"] = [plain(x), plain(y)]
    return found


def _dash(linestyle: Any) -> str:
    return ",".join(f"{2 * length:g}px" for length in linestyle[1])
