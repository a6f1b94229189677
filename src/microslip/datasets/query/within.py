"""Answers from a map alone, for motions and pressures that no limit is known of."""

from __future__ import annotations

import numpy as np

from microslip.datasets.query.cells import Map


def within(
    table: Map | None, still: Map | None, velocity: np.ndarray, amplitude: np.ndarray
) -> tuple:
    """Values and bounds of their errors, shape (n,) each; NaN and infinity beyond the map.

    table, still: interpolation.Table of the map above velocity 0 and of its row at velocity 0, each
    None where there is none; amplitude: (n,), 0 for a motion that has none.
    """
    value, error = np.full(len(velocity), np.nan), np.full(len(velocity), np.inf)
    for part, chosen in ((table, velocity > 0.0), (still, velocity == 0.0)):
        if part is None:
            continue
        there = chosen & part.rows.holds(amplitude) & part.columns.holds(velocity)
        value[there], error[there] = part.at(amplitude[there], velocity[there])
    return value, error


def refuse_beyond(
    table: Map | None, still: Map | None, velocity: np.ndarray, amplitude: np.ndarray, what: str
) -> None:
    """Raise ValueError, naming the argument, for the first point beyond a map; as `within`."""
    outside = np.ones(len(velocity), bool)
    for part, chosen in ((table, velocity != 0.0), (still, velocity == 0.0)):
        if part is not None:
            held = part.rows.holds(amplitude) & part.columns.holds(velocity)
            outside[chosen & held] = False
    first = np.flatnonzero(outside)[:1]
    for v, a in zip(velocity[first], amplitude[first], strict=True):
        part = still if v == 0.0 else table
        advice = f"no limit of {what} is known: with a tolerance the solver is asked"
        if part is None:
            raise ValueError(f"velocity = {v:g}: the map has none such; {advice}")
        for name, axis, given in (("velocity", part.columns, v), ("amplitude", part.rows, a)):
            if not axis.holds(np.array(given)):
                low, high = axis.values[[0, -1]]
                raise ValueError(f"{name} = {given:g}: allowed is {low:g} to {high:g}; {advice}")
