"""Convert entries of docstrings, "name: description; other: description", to lists.

A name must be a parameter of the function or a field of the dataclass. Other text with a colon is
not changed.
"""

import dataclasses
import inspect
import re


def _names(what, obj):
    """Return the names that a docstring can describe as ``name: ...``."""
    if dataclasses.is_dataclass(obj):
        return [field.name for field in dataclasses.fields(obj)]
    try:
        return list(inspect.signature(obj).parameters)
    except (TypeError, ValueError):
        return []


def _paragraphs(lines):
    """Yield (text, plain) of paragraphs. Plain paragraphs become one line, others are unchanged."""
    for block in "\n".join(lines).split("\n\n"):
        if block.strip():
            plain = not block.startswith(" ") and not re.search(r"^( {2,}|[-*|] )", block, re.M)
            yield (" ".join(block.split()), True) if plain else (block, False)


def _as_list(text, names):
    """Return the lines of a paragraph, with its entries as a list, and results and errors apart."""
    name = "|".join(sorted(map(re.escape, names), key=len, reverse=True)) or "(?!)"
    group = rf"(?:{name})(?: (?:>=?|<=?) [\d.]+)?(?: \([^()]*\))?"
    many = rf"{group}(?:,? (?:and )?{group})*"
    parts = re.split(rf"(?:^|(?<=[;.]) )({many}): ", text)
    out = [parts[0], ""] if parts[0] else []
    last = len(parts) // 2 - 1
    for number, (names_of_entry, entry) in enumerate(zip(parts[1::2], parts[2::2], strict=True)):
        # Text after the last entry belongs to all entries.
        words = "[A-Z]" if number == last else "(?:Returns?|Raises|Allowed) "
        entry, *after = re.split(rf"(?<=\.) (?={words})", entry, maxsplit=1)
        out.append(f"- **{names_of_entry}**: {entry.rstrip(';. ')}")
        if after:
            out += ["", *after, ""]
    return [*out, ""]


def _process(app, what, name, obj, options, lines):
    names, out = _names(what, obj), []
    for text, plain in _paragraphs(lines):
        # Single backticks mark code; bars and double stars are escaped.
        text = re.sub(r"(?<!`)`([^`]+)`(?!`)", r"``\1``", text)
        text = re.sub(r"\||\*\*(?=\w)" if plain else r"\*\*(?=\w)", r"\\\g<0>", text)
        out += _as_list(text, names) if plain else [*text.split("\n"), ""]
    lines[:] = out


def _signature(app, what, name, obj, options, signature, result):
    """Omit the signature of dataclasses, whose fields are listed below."""
    return ("", None) if dataclasses.is_dataclass(obj) else (signature, result)


def setup(app):
    app.connect("autodoc-process-docstring", _process)
    app.connect("autodoc-process-signature", _signature)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
