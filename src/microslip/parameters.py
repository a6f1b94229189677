"""Names with numbers: "elliptic:forward=0.5,phase=90" is the name elliptic and two numbers."""

from __future__ import annotations

import difflib
import math


def split(text, what, names):
    """Name and numbers (dict) in a text; raises ValueError, beginning with ``what``, if the name is
    none of ``names`` or the numbers cannot be read."""
    name, colon, rest = text.partition(":")
    if name not in names:
        near = difflib.get_close_matches(name, names, n=1)
        hint = f"did you mean {near[0]}? " if near else ""
        raise ValueError(f"{what} = {name!r}: {hint}allowed is one of {', '.join(names)}")
    numbers = {}
    for part in rest.split(",") if colon else ():
        key, equals, value = (word.strip() for word in part.partition("="))
        if key in numbers:
            raise ValueError(f"{what} = {text!r}: {key} occurs twice; allowed: each number once")
        try:
            numbers[key] = float(value)
        except ValueError:
            numbers[key] = math.nan
        if not (key and equals and math.isfinite(numbers[key])):
            raise ValueError(f"{what} = {text!r}: allowed are numbers as in {name}:key=0.5")
    return name, numbers


def unknown(text, what, numbers, known):
    """One line about a number that a name does not take, "" if there is none."""
    strange = sorted(numbers.keys() - set(known))
    if not strange:
        return ""
    allowed = ", ".join(known) or "none"
    return f"{what} = {text!r}: unknown number {strange[0]}; allowed: {allowed}"


def refuse_shares(text, what, shares):
    """Raise ValueError, beginning with ``what``, for a share outside 0..1; shares: dict."""
    for key, share in shares.items():
        if not 0.0 <= share <= 1.0:
            raise ValueError(f"{what} = {text!r}: {key} = {share:g}: allowed is a share in 0..1")


def refuse_counts(text, what, counts, most):
    """... for what is no whole number from 1 to ``most``; counts: dict."""
    for key, count in counts.items():
        if count != round(count) or not 1 <= count <= most:
            raise ValueError(
                f"{what} = {text!r}: {key} = {count:g}: allowed is a whole number from 1 to {most}"
            )
