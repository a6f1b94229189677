"""Write the page as one file with markup, style, plotly.js, scripts and data."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path

from plotly.offline import get_plotlyjs

from microslip.foundation.files import write_atomically
from microslip.report.explorer import payload
from microslip.report.explorer.explorer import ASSETS

FOLDER = Path(__file__).parent


def write(path: str | os.PathLike, datasets: dict, periods: dict, certified: Sequence = ()) -> None:
    """Write the page atomically. Equal arguments give equal bytes.

    datasets, periods, certified: arguments of `payload.build`. Raises CacheError if the file cannot
    be written.
    """
    write_atomically(Path(path), page(payload.build(datasets, periods, certified)).encode())


def page(content: dict) -> str:
    """Return the text of the page. content: result of `payload.build`."""
    template, style, *scripts = (
        (FOLDER / name).read_text(encoding="utf-8").rstrip() for name in ASSETS
    )
    # A "<" could end the script, so it is escaped.
    numbers = json.dumps(content, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")
    parts = {
        "style": style,
        "plotly": get_plotlyjs(),
        "numbers": numbers,
        "scripts": "\n".join(scripts),
    }
    # The template is split only once, so that a part can contain "@@".
    pieces = template.split("@@")
    pieces[1::2] = [parts[name] for name in pieces[1::2]]
    return "".join(pieces) + "\n"
