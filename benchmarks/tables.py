"""Helpers of benchmarks: arguments, tables and their files, and JSON lines of an earlier run."""

import argparse
import json
from pathlib import Path


def markdown(rows):
    """Markdown table of a list of dicts; their common keys are the headings of the columns."""
    lines = [list(rows[0]), ["---"] * len(rows[0]), *(map(str, row.values()) for row in rows)]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)


def measured(rows):
    """Markdown table of pairs of a quantity and its value."""
    return markdown([{"what": what, "measured": value} for what, value in rows])


def parser_of(description):
    """Parser of a benchmark with the option --markdown of `publish`; description: its docstring."""
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
    """JSON lines of an earlier run, without incomplete lines."""
    lines = []
    for line in path.read_text("utf-8").splitlines() if path.exists() else ():
        try:
            lines.append(json.loads(line or "{}"))
        except json.JSONDecodeError:
            print("an incomplete line is computed again")
    return [line for line in lines if line]
