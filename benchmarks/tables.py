"""Helpers for benchmarks: arguments, tables and their files, and JSON lines of an earlier run."""

import argparse
import json
from pathlib import Path


def markdown(rows):
    """Return the Markdown table of a list of dicts, whose common keys are the column headings."""
    lines = [list(rows[0]), ["---"] * len(rows[0]), *(map(str, row.values()) for row in rows)]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)


ROUNDING = 1e-12
"""Numbers smaller than this fraction of their scale are rounding noise.  Sums of thousands of terms
of double precision lose three to four of their 16 digits."""


def number(value, form, error=0.0, scale=1.0):
    """Return a number as a string for a page, with a format such as ".1e".

    A number below its error, or below ROUNDING times its scale, is printed as 0, so that a page is
    the same for every processor and every version of the libraries.
    """
    return "0" if abs(value) <= max(abs(error), ROUNDING * abs(scale)) else format(value, form)


def measured(rows):
    """Return a Markdown table of (quantity, value) pairs."""
    return markdown([{"what": what, "measured": value} for what, value in rows])


def parser_of(description):
    """Return a parser with the option --markdown. description: the benchmark's docstring."""
    parser = argparse.ArgumentParser(description=description.partition("\n")[0])
    parser.add_argument("--markdown", type=Path, help="file that the table is written to")
    return parser


def publish(text, options):
    """Print a text and write it to the file of --markdown."""
    text = text.rstrip("\n") + "\n"
    print(text, end="")
    if options.markdown:
        options.markdown.write_text(text, encoding="utf-8")


def parsed(path):
    """Return the JSON lines of an earlier run, without incomplete lines."""
    lines = []
    for line in path.read_text("utf-8").splitlines() if path.exists() else ():
        try:
            lines.append(json.loads(line or "{}"))
        except json.JSONDecodeError:
            print("an incomplete line is computed again")
    return [line for line in lines if line]
