"""Tables of all keys of a configuration for config/README.md, from microslip.config.settings.

``python docs/make_configuration_tables.py config/README.md`` replaces the tables.
"""

import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from microslip.config.schema import allowed_values, options, schema

SECTIONS = {
    "Top level": "Root",
    "Every sweep": "SteadySweep",
    "`sweeps`: `transverse` and `bore`": "Sweep",
    "`extended`: a sweep": "ExtendedSweep",
    "`drives`: a sweep": "DriveSweep",
    "`adaptive`": "Adaptive",
    "`linear` and `log` of an axis": "Range",
    "`histories`: `transverse`": "ForceHistory",
    "`histories`: `field`": "TractionField",
    "`histories`: `transients`": "Transients",
    "`accuracy`": "Accuracy",
    "`accuracy`: a point": "StudyPoint",
    "`accuracy`: `map`": "ModelMap",
    "`stability`": "Stability",
    "`claims`": "Claims",
}
"""Pydantic models of the tables by heading."""
COMMON = "SteadySweep"
"""Model with the common keys of all sweeps; tables of other sweeps list their further keys."""
BEGIN, END = "<!-- keys: begin -->", "<!-- keys: end -->"
LONGEST = 100
"""Largest number of characters of a default in a table."""


def tables() -> str:
    """Markdown of all tables in SECTIONS."""
    return "\n".join(line for title, name in SECTIONS.items() for line in _section(title, name))


def _section(title: str, name: str) -> Iterator[str]:
    rule = schema() if name == "Root" else schema()["$defs"][name]
    yield from ("", f"### {title}", "", " ".join(rule["description"].split()), "")
    yield from ("| key | meaning | allowed | default |", "| --- | --- | --- | --- |")
    common = {} if name == COMMON else schema()["$defs"][COMMON]["properties"]
    for key, inner in rule["properties"].items():
        if common.get(key) == inner:
            continue
        meaning = " ".join(inner["description"].split())
        values = allowed_values(options(inner)).replace("|", "\\|")
        yield f"| `{key}` | {meaning} | {values} | {_default(key, inner, rule)} |"


def _default(key: str, inner: dict[str, Any], rule: dict[str, Any]) -> str:
    if key in rule.get("required", ()):
        return "required"
    text = json.dumps(inner["default"]) if "default" in inner else ""
    if text == "{}" and any("properties" in rule for rule in options(inner)):
        return "see below"
    return f"`{text}`" if 0 < len(text) <= LONGEST else "as in config.yaml" if text else "none"


def main(path: str) -> None:
    """Replace the tables between the marks in a file."""
    text = Path(path).read_text(encoding="utf-8")
    marked = f"{BEGIN}\n{tables()}\n\n{END}"
    new = re.sub(f"{BEGIN}.*{END}", lambda _: marked, text, flags=re.DOTALL)
    Path(path).write_text(new, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1])
