"""The explorer: one page, for a browser without a network, that shows what is behind every point.

`requests` says what a page needs, `payload` packs datasets, periods and certified maps, `si_form`
what the form for a real contact knows, `page` writes the page. It draws what datasets and stored
periods hold; all that it computes are answers from certified maps. The JavaScript beside these
modules runs in the browser; plotly.js draws.

Importing this package is cheap, since the workflow reads it whenever it is parsed.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from pathlib import Path

from microslip.foundation import source_digest
from microslip.report.explorer.requests import (
    PAGE,
    PAGE_OF_ALL,
    PAGES,
    PERIODS_PER_JOB,
    certified_of,
    datasets_of,
    maps_of,
    period_requests,
    refusal,
    sweeps_of,
)

__all__ = [
    "ASSETS",
    "PAGE",
    "PAGES",
    "PAGE_OF_ALL",
    "PERIODS_PER_JOB",
    "certified_of",
    "datasets_of",
    "digest",
]
__all__ += ["maps_of", "period_requests", "refusal", "report", "sweeps_of"]

ASSETS: tuple[str, ...] = (
    "page.html",
    "style.css",
    "certified.js",
    "elliptic.js",
    "limits.js",
    "beyond.js",
)
ASSETS += (
    "contact.js",
    "data.js",
    "charts.js",
    "disc.js",
    "lines.js",
    "views.js",
    "form.js",
    "link.js",
    "page.js",
)
"""Parts of the page besides numbers and plotly.js, in the order in which scripts run."""


def digest() -> str:
    """Digest of all that the page depends on besides datasets and periods."""
    parts = [Path(__file__).with_name(name).read_bytes() for name in ASSETS]
    parts.append(source_digest.of_modules("report/explorer", "sweeps/period_codec.py").encode())
    return hashlib.sha256(b"\0".join(parts)).hexdigest()


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
