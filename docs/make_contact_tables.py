"""Make the page of a prediction's inputs and outputs from microslip.si.inputs and .output.

``python docs/make_contact_tables.py docs/reference/contacts.md`` writes the page.
"""

import sys
from pathlib import Path

from microslip.si.inputs import INPUTS
from microslip.si.output import OUTPUTS, column

PAGE = """# Inputs and outputs of a prediction

The inputs are arguments of `microslip.predict`, options of `microslip predict` (with `-`
in place of `_`), and columns of a table of contacts.

| input | values | meaning |
|---|---|---|
{inputs}

The outputs are fields of the prediction.  `NAME_error` is the numerical error estimate.  If
an input is uncertain, `NAME_spread` is the standard uncertainty, and `NAME_low` and
`NAME_high` are the ends of the 95 % interval.  The unit is at the end of each name, as
in `friction_force_error_N`.

| output | meaning |
|---|---|
{outputs}
"""


def page() -> str:
    """Return the Markdown of the page."""
    inputs = [
        f"| `{name}` | {'text' if one.unit is None else one.range} | {one.help} |"
        for name, one in INPUTS.items()
    ]
    outputs = [
        f"| `{column(name, one.unit)}` | {one.sentence or name.replace('_', ' ')} |"
        for name, one in OUTPUTS.items()
    ]
    return PAGE.format(inputs="\n".join(inputs), outputs="\n".join(outputs))


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(page(), encoding="utf-8")
