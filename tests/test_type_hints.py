"""Every public function of the package says what it takes and what it returns."""

import ast
from pathlib import Path

import pytest

import microslip

PACKAGE = Path(microslip.__file__).parent
MODULES = sorted(path.relative_to(PACKAGE) for path in PACKAGE.rglob("*.py"))
FUNCTIONS = ast.FunctionDef | ast.AsyncFunctionDef


def public_functions(body, of_class=False):
    """(function, whether its first argument is the object or the class) of those defined in the
    body of a module or of a public class, under conditions, too."""
    for node in body:
        if isinstance(node, FUNCTIONS):
            if not node.name.startswith("_") or (of_class and node.name == "__init__"):
                yield node, of_class and not is_static(node)
        elif isinstance(node, ast.ClassDef):
            if not node.name.startswith("_"):
                yield from public_functions(node.body, of_class=True)
        else:
            for block in ("body", "orelse", "handlers", "finalbody"):
                yield from public_functions(getattr(node, block, ()), of_class)


def is_static(function):
    return any(isinstance(d, ast.Name) and d.id == "staticmethod" for d in function.decorator_list)


def missing(text):
    """What public functions in a source leave open, such as "line 3: f: x, return"."""
    found = []
    for function, bound in public_functions(ast.parse(text).body):
        given = function.args
        named = [*given.posonlyargs, *given.args][bound:] + given.kwonlyargs
        named += filter(None, (given.vararg, given.kwarg))
        lacking = [one.arg for one in named if one.annotation is None]
        if function.returns is None and function.name != "__init__":
            lacking.append("return")
        if lacking:
            found.append(f"line {function.lineno}: {function.name}: {', '.join(lacking)}")
    return found


def test_public_functions_have_all_their_hints():
    texts = {path: (PACKAGE / path).read_text(encoding="utf-8") for path in MODULES}
    assert not [f"{path}: {said}" for path, text in texts.items() for said in missing(text)]


def test_the_package_says_that_it_has_hints():
    assert (PACKAGE / "py.typed").is_file()  # type checkers of other packages look for it


@pytest.mark.parametrize(
    ("source", "found"),
    [
        ("def f(x: int, *, y: int = 1) -> None: ...", []),
        ("def f(x, /, y: int, *rest, z, **more) -> None: ...", ["line 1: f: x, z, rest, more"]),
        ("async def f(x: int): ...", ["line 1: f: return"]),
        ("if True:\n def f(): ...", ["line 2: f: return"]),
        ("try: ...\nexcept OSError:\n def f(): ...", ["line 3: f: return"]),
        ("def _f(x): ...", []),
        ("def f() -> None:\n def inner(x): ...", []),
        ("class A:\n def __init__(self, x): ...", ["line 2: __init__: x"]),
        ("class A:\n def __init__(self, x: int): ...\n def __call__(self, x): ...", []),
        ("class A:\n def f(self) -> int: ...\n @classmethod\n def g(cls) -> int: ...", []),
        ("class A:\n @staticmethod\n def f(x) -> int: ...", ["line 3: f: x"]),
        ("class A:\n class B:\n  def f(self, x) -> int: ...", ["line 3: f: x"]),
        ("class _A:\n def f(self, x): ...", []),
    ],
)
def test_what_is_missing_is_found(source, found):
    assert missing(source) == found
