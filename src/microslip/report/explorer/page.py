"""The page as one file: markup, style, plotly.js, the scripts beside this module, numbers."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path

from plotly.offline import get_plotlyjs

from microslip.foundation.files import writing_beside
from microslip.report.explorer import payload
from microslip.report.explorer.explorer import ASSETS

FOLDER = Path(__file__).parent


def write(path: str | os.PathLike, datasets: dict, periods: dict, certified: Sequence = ()) -> None:
    """Write the page to `path`, whole or not at all.

    datasets, periods, certified: as for `payload.build`. The same ones give the same bytes. Raises
    ValueError as `payload.build` does, CacheError, one line that says what to do, where the system
    refuses.
    """
    text = page(payload.build(datasets, periods, certified))
    with writing_beside(path) as beside:
        beside.write_text(text, encoding="utf-8", newline="\n")


def page(content: dict) -> str:
    """Return the text of the page; content: as `payload.build` makes it."""
    template, style, *scripts = (
        (FOLDER / name).read_text(encoding="utf-8").rstrip() for name in ASSETS
    )
    # Inside a script "<" could end it; JSON has another way to write it.
    numbers = json.dumps(content, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")
    parts = {
        "style": style,
        "plotly": get_plotlyjs(),
        "numbers": numbers,
        "scripts": "\n".join(scripts),
    }
    # Cut once, so that nothing inside a part is taken for the place of another one.
    pieces = template.split("@@")
    pieces[1::2] = [parts[name] for name in pieces[1::2]]
    return "".join(pieces) + "\n"
