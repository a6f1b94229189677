"""Helpers of benchmarks: lines of an earlier run, tables, and their output files."""

import json
from pathlib import Path


def markdown(rows):
    """Markdown of a list of dicts with the same keys, which head the columns."""
    lines = [list(rows[0]), ["---"] * len(rows[0]), *(map(str, row.values()) for row in rows)]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)


def measured(rows):
    """Markdown of pairs of what was measured and what it came to."""
    return markdown([{"what": what, "measured": value} for what, value in rows])


def add_markdown(parser):
    """The option --markdown, for `publish`."""
    parser.add_argument("--markdown", type=Path, help="file to write the table to")


def publish(text, options):
    """Print a text, and write it to the file of --markdown."""
    text = text.rstrip("\n") + "\n"
    print(text, end="")
    if options.markdown:
        options.markdown.write_text(text, encoding="utf-8")


def parsed(path):
    """Lines of JSON that an earlier run wrote; what an interruption cut short is left out."""
    found = []
    for line in path.read_text("utf-8").splitlines() if path.exists() else ():
        try:
            found.append(json.loads(line or "{}"))
        except json.JSONDecodeError:
            print("a line that is cut short is computed again")
    return [line for line in found if line]
