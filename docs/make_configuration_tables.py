"""Make the tables of all configuration keys in config/README.md from microslip.config.settings.

``python docs/make_configuration_tables.py config/README.md`` replaces the tables.
"""

import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path

from pydantic.fields import FieldInfo

from microslip.config import settings
from microslip.config.settings import Allowed, Settings

SECTIONS: dict[str, type[Settings]] = {
    "Top level": settings.Configuration,
    "`sweeps`: a sweep": settings.Sweep,
    "`figures`: a figure": settings.Figure,
    "`accuracy`": settings.Accuracy,
    "`accuracy`: a point": settings.StudyPoint,
    "`accuracy`: `map`": settings.ModelMap,
    "`stability`": settings.Stability,
    "`stability`: a block of `axes`": settings.Block,
    "`claims`": settings.Claims,
}
"""Settings class of each table, keyed by heading."""
BEGIN, END = "<!-- keys: begin -->", "<!-- keys: end -->"
LONGEST = 60
"""Largest number of characters of a default in a table."""


def tables() -> str:
    """Return the Markdown of all tables in SECTIONS."""
    return "\n".join(line for title, model in SECTIONS.items() for line in _section(title, model))


def _section(title: str, model: type[Settings]) -> Iterator[str]:
    yield from ("", f"### {title}", "", " ".join(str(model.__doc__).split()), "")
    yield from ("| key | meaning | allowed | default |", "| --- | --- | --- | --- |")
    for key, field in model.model_fields.items():
        meaning = " ".join(str(field.description or "").split())
        yield f"| `{key}` | {meaning} | {_allowed(field)} | {_default(field)} |"


def _allowed(field: FieldInfo) -> str:
    texts = [item.text for item in field.metadata if isinstance(item, Allowed)]
    return (texts[0] if texts else "a mapping").replace("|", "\\|")


def _default(field: FieldInfo) -> str:
    if field.is_required():
        return "required"
    value = field.get_default(call_default_factory=True, validated_data={})
    if value is None or value in ((), {}):
        return "none"
    value = value[0] if isinstance(value, tuple) and len(value) == 1 else value
    text = json.dumps(value)
    return f"`{text}`" if len(text) <= LONGEST else "all"


def main(path: str) -> None:
    """Replace the tables between the marks in a file."""
    text = Path(path).read_text(encoding="utf-8")
    marked = f"{BEGIN}\n{tables()}\n\n{END}"
    new = re.sub(f"{BEGIN}.*{END}", lambda _: marked, text, flags=re.DOTALL)
    Path(path).write_text(new, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1])
