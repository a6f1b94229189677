"""Digest of what a source says to Python: comments, docstrings and layout do not count."""

from __future__ import annotations

import ast
import hashlib


def digest_of_source(text: str) -> str:
    """Digest of a module's syntax tree without comments, docstrings, layout and line numbers."""
    out = []
    _dump(ast.parse(text), out)
    return hashlib.sha256("".join(out).encode()).hexdigest()


def _dump(node, out):
    # ast.dump changes its output between Python versions. This one skips empty fields, which is
    # where they differ, so one results folder serves all of them.
    if isinstance(node, ast.AST):
        out.append(f"{type(node).__name__}(")
        for field, value in ast.iter_fields(node):
            if field == "body" and _has_docstring(node):
                value = value[1:]
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


def _has_docstring(node):
    kinds = ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef
    if not isinstance(node, kinds) or not node.body:
        return False
    first = node.body[0]
    return (
        isinstance(first, ast.Expr)
        and isinstance(first.value, ast.Constant)
        and isinstance(first.value.value, str)
    )
