"""Tables of benchmarks, for the terminal and for the documentation."""


def markdown(rows):
    """Markdown of a list of dicts with the same keys, which head the columns."""
    lines = [list(rows[0]), ["---"] * len(rows[0]), *(map(str, row.values()) for row in rows)]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)
