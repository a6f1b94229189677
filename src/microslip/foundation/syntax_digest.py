"""Digest of what a source says to Python: comments, docstrings, layout and hints do not count.

Hints are those of a function's arguments and of what it returns.  Those of a class's fields count,
since dataclasses and schemas are made of them.
"""

from __future__ import annotations

import ast
import hashlib

HINTS = {"annotation": ast.arg, "returns": ast.FunctionDef | ast.AsyncFunctionDef}
"""Fields of the syntax tree that hold a function's hints, and the nodes that carry them."""


def digest_of_source(text: str) -> str:
    """Digest of a module's syntax tree without what changes no result, and line numbers."""
    out = []
    _dump(ast.parse(text), out)
    return hashlib.sha256("".join(out).encode()).hexdigest()


def _dump(node, out):
    # ast.dump changes its output between Python versions. This one skips empty fields, which is
    # where they differ, so one results folder serves all of them.
    if isinstance(node, ast.AST):
        out.append(f"{type(node).__name__}(")
        for field, value in ast.iter_fields(node):
            if isinstance(value, list):
                value = [item for item in value if not _is_text(item)]
            if field in HINTS and isinstance(node, HINTS[field]):
                continue
            if value is not None and value != []:
                out.append(f"{field}=")
                _dump(value, out)
        out.append(")")
    elif isinstance(node, list):
        out.append("[")
        for item in node:
            _dump(item, out)
        out.append("]")
    else:
        out.append(f"{node!r},")


def _is_text(node):
    """Whether it is a docstring, or what is said of a constant or a field below it."""
    return (
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    )
