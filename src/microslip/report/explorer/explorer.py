"""The explorer: an interactive HTML page that needs no network.

This module lists the inputs of a page. The module `page` packs datasets and periods and writes the
page, and `contact_form` packs the data of the form for a real contact. The JavaScript files in this
folder run in the browser and draw with plotly.js.

Snakemake imports this module whenever it parses the workflow, so it has few imports.
"""

from __future__ import annotations

from collections.abc import Iterator

from microslip.config.settings import Configuration, Figure
from microslip.report.motions import MOTIONS
from microslip.sweeps.request import request_of

SCRIPTS = "data charts disc sweeps contact form link page"
ASSETS = ("page.html", "style.css", *(f"{name}.js" for name in SCRIPTS.split()))
"""Files of the page, besides the data and plotly.js. The scripts run in this order."""
CELLS, ANGLES, STEPS = 10, 12, 32
"""Resolution of a stored period: number of rings, number of points on half a ring, and number of
steps. This resolution is sufficient for a picture 300 pixels wide."""
PERIODS_PER_JOB = 150
"""Number of periods in one job. Such a job takes a few seconds."""
MOST_PERIODS = 1200
"""Maximum number of periods on a page. This number limits the size of a page to 15 MB. A period
takes about 7.6 kB."""


def maps_of(configuration: Configuration, figure: Figure) -> list[str]:
    """Return the names of the sweeps on a page for which periods are stored."""
    return [
        name
        for name in figure.sweep
        if (sweep := configuration.sweeps[name]).motion in MOTIONS
        and sweep.pressure == "hertz"
        and sweep.spans_a_map
        and not (sweep.is_certified or sweep.drives)
    ]


def period_requests(configuration: Configuration, *maps: str, name: str) -> list[dict]:
    """Return the requests for the periods of the map `name` at the smallest Poisson's ratio.

    The velocity varies fastest. The maps of a page share the maximum number of periods
    (`MOST_PERIODS`) equally. If a map has more points than its share, periods are computed only at
    every n-th value along each axis (n = 2, 3, ...).
    """
    sweep = configuration.sweeps[name]
    most = MOST_PERIODS // len(maps)
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
    """Yield log lines with the number of periods and with each period that did not converge.

    periods: list of records for each map, keyed by the map's name.
    """
    for name, records in periods.items():
        unconverged = [record for record in records if not record["result"]["converged"]]
        outcome = f"{len(unconverged)} not converged" if unconverged else "all converged"
        yield f"explorer: {name}: {len(records)} periods, {outcome}"
        for record in unconverged:
            request, result = record["request"], record["result"]
            where = f"amplitude {request['amplitude']}, velocity {request['velocity']}"
            yield f"  not converged: {where}: {result['reason']}"
