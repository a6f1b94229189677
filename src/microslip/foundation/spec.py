"""Names with parameters: "elliptic:forward=0.5,phase=90" is the name elliptic with two
parameters."""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Iterable
from dataclasses import fields
from functools import cached_property
from typing import Any

from microslip.foundation.arguments import is_real, without_array
from microslip.foundation.errors import InputError, shown

NUMBER = re.compile(
    r"[+-]?(([0-9]+\.?[0-9]*|\.[0-9]+)(e[+-]?[0-9]+)?|inf|infinity|nan)", re.ASCII | re.IGNORECASE
)
WHOLE = re.compile(r"[+-]?[0-9]{1,18}", re.ASCII)
MINUS = "\N{MINUS SIGN}"
HALVES = {"diameter": "radius", "stroke": "amplitude", "peak_to_peak": "amplitude"}
"""For each quantity that is twice an argument, the name of this argument.  For example, a diameter
is twice a radius."""


def read(argument: str, text: str, whole: bool = False) -> float | int:
    """Read a number in Python notation from a string.

    Spaces around the number and a typographic minus are accepted.  Underscores, digits of other
    scripts and decimal commas are not accepted.

    Parameters
    ----------
    argument
        Name of the argument, for messages.
    text
        String with the number, which can be infinite or NaN.
    whole
        If True, accept only integers, and return an int.

    Raises
    ------
    InputError
        If the string is not such a number, or the number is outside the range of floats.
    """
    plain = text.strip().replace(MINUS, "-", 1)
    if not (WHOLE if whole else NUMBER).fullmatch(plain):
        point = plain.replace(",", ".")
        is_comma = not whole and point != plain and NUMBER.fullmatch(point)
        kind = "whole number" if whole else f"number{f' with a point: {point}' if is_comma else ''}"
        raise InputError(argument, text, f"allowed is a {kind}")
    if whole:
        return int(plain)
    number, digits = float(plain), plain.lower().partition("e")[0]
    if number == 0.0 and re.search("[1-9]", digits):
        problem = "nearer 0 than floating-point numbers can be"
        raise InputError(argument, text, f"{problem}; allowed is 0 or a number further from it")
    if math.isinf(number) and "i" not in digits:
        problem = "beyond the range of floating-point numbers"
        raise InputError(argument, text, f"{problem}; allowed is a number within it")
    return number


def near_miss(name: object, names: Iterable[str]) -> str:
    """Return 'did you mean NAME? ' for the most similar name, or '' if no name is similar.  If the
    name belongs to a quantity that is twice an argument, the hint says so.  For example, a diameter
    is twice a radius."""
    word = str(name).lstrip("-").replace("-", "_")
    half = re.sub("|".join(HALVES), lambda match: HALVES[match[0]], word)
    for one in names:
        if half != word and half == one.lstrip("-").replace("-", "_"):
            return f"{one} is half of it; "
    import difflib  # late, since most processes do not need it

    near = difflib.get_close_matches(str(name), names, n=1)
    return f"did you mean {near[0]}? " if near else ""


def split(text: str, what: str, names: Iterable[str]) -> tuple[str, str | None]:
    """Split a string such as "elliptic:phase=90" into the name and the part with the parameters.
    If the string has no colon, the second part is None.

    Raises InputError if the name is not in `names`.  The message is about the argument `what`.
    """
    name, colon, numbers = text.partition(":")
    if name not in names:
        hint = near_miss(name, names)
        raise InputError(what, text, f"{hint}allowed is one of {', '.join(names)}")
    return name, numbers if colon else None


def numbers_in(
    part: str | None, text: str, what: str, name: str, parameters: Iterable[str] | None = None
) -> dict[str, float]:
    """Read the parameters in the part of a string that follows the name, such as
    "forward=0.5,phase=90".  Returns the numbers, keyed by name, or an empty dict if the part is
    None.

    Raises InputError about the argument `what` if the part cannot be read, or if the part contains
    a name that is not in `parameters`.  The message contains the whole string, and an example that
    begins with the name.
    """
    numbers: dict[str, float] = {}
    for one in [] if part is None else part.split(","):
        key, equals, value = (word.strip() for word in one.partition("="))
        if key in numbers:
            raise InputError(what, text, f"{key} occurs twice; allowed: each number once")
        problem = "allowed are numbers"
        try:
            numbers[key] = read(key, value)
        except InputError as error:
            numbers[key] = math.nan
            if NUMBER.fullmatch(value):  # a number out of range
                problem = f"{error.allowed},"
        if not (key and equals and math.isfinite(numbers[key])):
            raise InputError(what, text, f"in it {one!r}: {problem} as in {name}:key=0.5")
    if parameters is not None and (unknown := sorted(numbers.keys() - set(parameters))):
        allowed = ", ".join(parameters) or "none"
        raise InputError(what, text, f"unknown number {unknown[0]}; allowed: {allowed}")
    return numbers


def refuse_strange(record: Any, what: str) -> None:
    """Raise InputError about the argument `what` if a numeric field of a dataclass is not finite.

    Numeric fields are those whose default is a number.  An array that contains a single number is
    replaced by this number; see `arguments.without_array`.
    """
    for field in fields(record):
        if isinstance(field.default, int | float):
            value = without_array(getattr(record, field.name))
            if not (is_real(value) and abs(value) <= sys.float_info.max):
                raise InputError(what, value, f"allowed for {field.name} is a finite number")
            object.__setattr__(record, field.name, value)


def refuse_outside(text: str, what: str, key: str, number: object, limits: tuple) -> None:
    """Raise InputError about the argument `what` unless `number` is a number within its limits.

    limits: smallest and largest number.  A third element replaces the description "a number" in the
    message.
    """
    (low, high, kind), value = (*limits, "a number")[:3], without_array(number)
    if not (is_real(value) and low <= value <= high):
        word = f"{value:g}" if isinstance(value, float) else shown(value)
        raise InputError(what, text, f"{key} = {word}: allowed is {kind} in {low:g}..{high:g}")


def name_of(cls: type) -> str:
    """Return the name of a class for use in strings, such as "continuous-bore" for ContinuousBore.
    A class in a user's file has the attribute `text_name`."""
    name = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "-", cls.__name__).lower()
    return vars(cls).get("text_name", name)


class Named:
    """Base class of motions, pressures and other dataclasses whose fields are numbers."""

    @cached_property
    def name(self) -> str:
        """Name of the class, followed by the parameters that differ from their defaults.  The
        parameters are rounded to 12 digits."""
        record: Any = self
        name, values = name_of(type(self)), ((f, getattr(self, f.name)) for f in fields(record))
        words = [f"{field.name}={value:.12g}" for field, value in values if value != field.default]
        mark = "," if ":" in name else ":"
        return f"{name}{mark}{','.join(words)}" if words else name

    def __str__(self) -> str:
        return self.name


class NamedByText(Named):
    """Base class of objects that contain arrays.  Objects with equal names are equal.

    Attributes
    ----------
    text : str
        Name of the object, with a digest of the arrays.
    """

    text: str

    @property
    def name(self) -> str:
        return self.text

    def __eq__(self, other: object) -> bool:
        return isinstance(other, type(self)) and other.text == self.text

    def __hash__(self) -> int:
        return hash(self.text)
