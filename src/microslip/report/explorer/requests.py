"""Which periods the page needs: one for every point of the maps that moves and oscillates."""

from microslip.config.records import Configuration
from microslip.foundation.canonical import number

MAPS = ("transverse", "bore")
CELLS, ANGLES, STEPS = 10, 12, 32
"""Rings, points on half a ring, steps in a period: what a drawing of some 300 pixels can show."""
MOST_PERIODS = 1250
"""Periods on a page; one takes some 6 kB of it, and all of it is to stay below 15 MB."""
MOST_POINTS = 5000
"""Points of a map on a page; one takes some 260 bytes of it."""


def maps_of(configuration: Configuration) -> list[str]:
    """Names of the sweeps that the page shows as maps, a list."""
    return [
        name
        for name in MAPS
        if name in configuration.sweeps and configuration.sweeps[name].spans_a_map
    ]


def refusal(configuration: Configuration) -> str | None:
    """Why there can be no page for a configuration, one line; None if there can."""
    names = maps_of(configuration)
    if not names:
        return (
            "sweeps: the explorer has nothing to show; allowed: transverse or bore with two "
            "amplitudes and two velocities above 0"
        )
    for name in names:
        sweep = configuration.sweeps[name]
        count = len(sweep.amplitude) * len(sweep.velocity)
        if count > MOST_POINTS:
            return (
                f"sweeps.{name}: {count:,} points have no room in the explorer; "
                f"allowed: up to {MOST_POINTS:,}"
            )
    return None


def period_requests(configuration: Configuration, name: str) -> list[dict]:
    """List the requests for periods of the points of a map, amplitude by amplitude.

    Where there are more points than a page can hold, every second, third, ... of both axes has
    one. Of several Poisson's ratios it is the smallest, as in the figures.
    """
    sweep = configuration.sweeps[name]
    most = MOST_PERIODS // len(maps_of(configuration))
    axes = [[value for value in axis if value > 0] for axis in (sweep.amplitude, sweep.velocity)]
    every = 1
    while len(axes[0][::every]) * len(axes[1][::every]) > most:
        every += 1
    common = {
        "kind": "period",
        "scene": sweep.scene,
        "poisson": number(sweep.poisson[0]),
        "cells": CELLS,
        "angles": ANGLES,
        "steps": STEPS,
    }
    return [
        common | {"amplitude": number(amplitude), "velocity": number(velocity)}
        for amplitude in axes[0][::every]
        for velocity in axes[1][::every]
    ]
