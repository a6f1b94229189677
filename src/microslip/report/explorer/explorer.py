"""The explorer: one page, for a browser without a network, that shows what is behind every point.

This module lists what a page needs, `payload` packs datasets, periods and certified maps, `si_form`
the data of the form for a real contact, `page` writes the page. It draws what datasets and stored
periods hold; all that it computes are answers from certified maps. The JavaScript beside these
modules runs in the browser; plotly.js draws.

Importing this package is cheap, since the workflow reads it whenever it is parsed.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import prod

from microslip.config.records import CertifiedMap, Configuration, Sweep
from microslip.foundation.canonical import number

SCRIPTS = "certified elliptic limits beyond contact data charts disc lines views form link page"
ASSETS = ("page.html", "style.css", *(f"{name}.js" for name in SCRIPTS.split()))
"""Parts of the page besides numbers and plotly.js, in the order in which scripts run."""
PAGES = PAGE, PAGE_OF_ALL = "explorer.html", "explorer_all.html"
MAPS = ("transverse", "bore")
"""Sweeps whose maps have periods, and motions that the form for a real contact knows."""
CELLS, ANGLES, STEPS = 10, 12, 32
"""Rings, points on half a ring, steps in a period: what a drawing of some 300 pixels can show."""
PERIODS_PER_JOB = 150
"""Periods that one job computes: a few seconds of work."""
MOST_PERIODS = 1250
"""Periods on a page; one takes some 6 kB of it, and all of it is to stay below 15 MB."""
MOST_POINTS = 5000
"""Points of a map with periods on a page; one takes some 260 bytes of it."""
MOST_OTHERS = 20_000
"""Points of all other sweeps together; one takes some 80 bytes."""


def sweeps_of(configuration: Configuration, page: str) -> list[str]:
    """Names of the sweeps that a page shows, a list."""
    return list(configuration.grids if page == PAGE_OF_ALL else configuration.sweeps)


def certified_of(configuration: Configuration) -> list[str]:
    """Names of the certified maps that a real contact is answered from, a list.

    One for each motion: over most of Poisson's ratios, and of several such the most exact.
    """
    found = []
    for motion in MAPS:
        known = [
            map_
            for map_ in configuration.certified.values()
            if (map_.sweep.motion, map_.sweep.pressure) == (motion, "hertz") and map_.velocity
        ]
        found += [map_.name for map_ in sorted(known, key=_preference)[:1]]
    return found


def _preference(map_: CertifiedMap) -> tuple[float, float]:
    ratios = map_.sweep.poisson
    return ratios[0] - ratios[-1], map_.error


def datasets_of(configuration: Configuration, page: str) -> list[str]:
    """Names of all datasets that a page is made of, a list."""
    return [*sweeps_of(configuration, page), *certified_of(configuration)]


def maps_of(configuration: Configuration) -> list[str]:
    """Names of the sweeps whose maps have periods, a list."""
    return [
        name
        for name in MAPS
        if name in configuration.sweeps and configuration.sweeps[name].spans_a_map
    ]


def refusal(configuration: Configuration, page: str = PAGE) -> str | None:
    """Why there can be no such page for a configuration, one line; None if there can."""
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
    others = sum(_count(configuration.grids[name]) for name in sweeps_of(configuration, page))
    if others > MOST_OTHERS:
        return (
            f"sweeps: {others:,} points have no room in {page}; allowed: up to {MOST_OTHERS:,}, "
            "at all of Poisson's ratios together"
        )
    return None


def _count(sweep: Sweep) -> int:
    """How many points a sweep has."""
    pulls = [values for _, values, _ in sweep.drives]
    axes = (sweep.velocity, sweep.amplitude, sweep.poisson, *pulls)
    return prod(len(axis) for axis in axes if axis)


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
        "motion": sweep.motion,
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


def report(periods: dict) -> Iterator[str]:
    """Lines of text: how many periods there are and, one each, those that did not converge.

    periods: dict of lists of records, by the names of maps.
    """
    for name, records in periods.items():
        bad = [record for record in records if not record["result"]["converged"]]
        failed = f"{len(bad)} not converged" if bad else "all converged"
        yield f"explorer: {name}: {len(records)} periods, {failed}"
        for record in bad:
            where = ", ".join(
                f"{dim} {record['request'][dim]}" for dim in ("amplitude", "velocity")
            )
            yield f"  not converged: {where}: {record['result']['reason']}"
