"""The explorer: an interactive HTML page that needs no network.

This module lists the inputs of a page. `payload` packs datasets, periods and certified maps,
`si_form` packs the data of the form for a real contact, and `page` writes the page. The JavaScript
files in this folder run in the browser and draw with plotly.js. The page shows datasets and stored
periods, and evaluates certified maps.

Snakemake imports this module whenever it parses the workflow, so the module has few imports.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import prod

from microslip.config.records import CertifiedMap, Configuration, Sweep
from microslip.sweeps.evaluate import request_of

SCRIPTS = "certified elliptic limits beyond contact data charts disc lines views form link page"
ASSETS = ("page.html", "style.css", *(f"{name}.js" for name in SCRIPTS.split()))
"""Files of the page, besides the data and plotly.js. The scripts run in this order."""
PAGES = PAGE, PAGE_OF_ALL = "explorer.html", "explorer_all.html"
MAPS = ("transverse", "bore")
"""Sweeps with stored periods. The motions in the form for a real contact have the same names."""
CELLS, ANGLES, STEPS = 10, 12, 32
"""Resolution of a stored period: number of rings, points on half a ring, and steps. It is
sufficient for a picture of 300 pixels."""
PERIODS_PER_JOB = 150
"""Number of periods in one job. The job takes a few seconds."""
MOST_PERIODS = 1250
"""Maximum number of periods on a page of at most 15 MB. A period takes about 6 kB."""
MOST_POINTS = 5000
"""Maximum number of points of a map with periods. A point takes about 260 bytes."""
MOST_OTHERS = 20_000
"""Maximum number of points of all sweeps. A point without a period takes about 80 bytes."""


def sweeps_of(configuration: Configuration, page: str) -> list[str]:
    """Return the names of the sweeps on a page."""
    return list(configuration.grids if page == PAGE_OF_ALL else configuration.sweeps)


def certified_of(configuration: Configuration) -> list[str]:
    """Return the names of the certified maps for real contacts, at most one for each motion.

    A map over a wider range of Poisson's ratios is preferred, then a more accurate map.
    """
    names = []
    for motion in MAPS:
        candidates = [
            map_
            for map_ in configuration.certified.values()
            if (map_.sweep.motion, map_.sweep.pressure) == (motion, "hertz") and map_.velocity
        ]
        names += [map_.name for map_ in sorted(candidates, key=_preference)[:1]]
    return names


def _preference(map_: CertifiedMap) -> tuple[float, float]:
    ratios = map_.sweep.poisson
    return ratios[0] - ratios[-1], map_.error


def datasets_of(configuration: Configuration, page: str) -> list[str]:
    """Return the names of all datasets of a page."""
    return [*sweeps_of(configuration, page), *certified_of(configuration)]


def maps_of(configuration: Configuration) -> list[str]:
    """Return the names of the sweeps with stored periods."""
    return [
        name
        for name in MAPS
        if name in configuration.sweeps and configuration.sweeps[name].spans_a_map
    ]


def refusal(configuration: Configuration, page: str = PAGE) -> str | None:
    """Return a one-line reason why a configuration has no page, or None if it has a page."""
    names = maps_of(configuration)
    if not names:
        return (
            "sweeps: no map for the explorer; allowed: transverse or bore with two "
            "amplitudes and two velocities above 0"
        )
    for name in names:
        sweep = configuration.sweeps[name]
        count = len(sweep.amplitude) * len(sweep.velocity)
        if count > MOST_POINTS:
            return (
                f"sweeps.{name}: {count:,} points do not fit into the explorer; "
                f"allowed: up to {MOST_POINTS:,}"
            )
    others = sum(_count(configuration.grids[name]) for name in sweeps_of(configuration, page))
    if others > MOST_OTHERS:
        return (
            f"sweeps: {others:,} points do not fit into {page}; allowed: up to {MOST_OTHERS:,}, "
            "at all of Poisson's ratios together"
        )
    return None


def _count(sweep: Sweep) -> int:
    """Return the number of points of a sweep."""
    drives = [values for _, values, _ in sweep.drives]
    axes = (sweep.velocity, sweep.amplitude, sweep.poisson, *drives)
    return prod(len(axis) for axis in axes if axis)


def period_requests(configuration: Configuration, name: str) -> list[dict]:
    """Return the requests for a map's periods at the smallest Poisson's ratio.

    The velocity varies fastest. A map with more points than `MOST_PERIODS` has periods only at
    every n-th value of each axis.
    """
    sweep = configuration.sweeps[name]
    most = MOST_PERIODS // len(maps_of(configuration))
    axes = [[value for value in axis if value > 0] for axis in (sweep.amplitude, sweep.velocity)]
    every = 1
    while len(axes[0][::every]) * len(axes[1][::every]) > most:
        every += 1
    run = {"motion": sweep.motion, "poisson": sweep.poisson[0]}
    run |= {"cells": CELLS, "angles": ANGLES, "steps": STEPS}
    return [
        request_of("period", amplitude=amplitude, velocity=velocity, **run)
        for amplitude in axes[0][::every]
        for velocity in axes[1][::every]
    ]


def report(periods: dict) -> Iterator[str]:
    """Yield lines of a log: the number of periods, and each period that did not converge.

    periods: list of records for each map, keyed by the map's name.
    """
    for name, records in periods.items():
        unconverged = [record for record in records if not record["result"]["converged"]]
        outcome = f"{len(unconverged)} not converged" if unconverged else "all converged"
        yield f"explorer: {name}: {len(records)} periods, {outcome}"
        for record in unconverged:
            where = ", ".join(
                f"{dim} {record['request'][dim]}" for dim in ("amplitude", "velocity")
            )
            yield f"  not converged: {where}: {record['result']['reason']}"
