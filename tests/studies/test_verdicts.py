"""Verdicts from checks and from parts."""

import math
from itertools import product

import pytest

from microslip.studies.claims import verdicts
from microslip.studies.claims.verdicts import (
    FAILS,
    HOLDS,
    NOT,
    NOT_DECIDED,
    OPEN,
    PARTLY,
    WHOLLY,
    Check,
)


def check(margin, error=0.1, **place):
    return Check(0.0, 0.0, margin, error, ("run",), tuple(place.items()))


@pytest.mark.parametrize(
    ("margin", "error", "outcome"),
    [
        (0.2, 0.1, HOLDS),
        (-0.2, 0.1, FAILS),
        (0.1, 0.1, OPEN),
        (-0.1, 0.1, OPEN),
        (0.05, 0.1, OPEN),
        (0.0, 0.0, OPEN),
        (1e-9, 0.0, HOLDS),
        (1e9, math.inf, OPEN),
        (math.nan, 0.0, OPEN),
        (0.2, math.nan, OPEN),
    ],
)
def test_a_margin_decides_only_if_it_is_larger_than_its_error(margin, error, outcome):
    assert check(margin, error).outcome == outcome


@pytest.mark.parametrize(
    ("margins", "verdict"),
    [
        ([], NOT_DECIDED),
        ([0.05], NOT_DECIDED),
        ([0.2, 0.05], WHOLLY),
        ([-0.2, 0.05], NOT),
        ([0.2, -0.2], PARTLY),
        ([0.2, -0.2, 0.05], PARTLY),
    ],
)
def test_a_part_holds_if_nothing_decides_against_it(margins, verdict):
    assert verdicts.of_part([check(margin) for margin in margins]) == verdict


def completed(parts):
    """Yield the verdicts on a statement for all possible verdicts on its open parts."""
    open_ones = parts.count(NOT_DECIDED)
    decided = [part for part in parts if part != NOT_DECIDED]
    for rest in product((WHOLLY, PARTLY, NOT), repeat=open_ones):
        whole = {*decided, *rest}
        yield WHOLLY if whole == {WHOLLY} else NOT if whole == {NOT} else PARTLY


@pytest.mark.parametrize("count", [1, 2, 3])
def test_a_statement_is_decided_exactly_where_its_open_parts_cannot_change_it(count):
    for parts in product(range(4), repeat=count):
        possible = set(completed(list(parts)))
        expected = possible.pop() if len(possible) == 1 else NOT_DECIDED
        assert verdicts.of_claim(parts) == expected, parts
    assert verdicts.of_claim([]) == NOT_DECIDED


def test_what_shows_a_part_is_the_clearest_or_the_closest_check():
    checks = [check(m) for m in (0.3, 0.9, 0.05, -0.2, -0.7)]
    assert verdicts.decisive(checks, FAILS).margin == -0.7
    assert verdicts.tightest(checks).margin == 0.3
    assert verdicts.decisive(checks[:3], FAILS) is None
    assert verdicts.tightest(checks[2:]) is None


def test_where_a_part_holds_is_told_in_words():
    def row(amplitude, *margins):
        return [
            check(m, amplitude=amplitude, velocity=v)
            for v, m in zip((0.1, 1, 10), margins, strict=True)
        ]

    checks = row(1, 1, 1, 0) + row(2, 1, 1, 1) + row(3, -1, -1, 0) + row(4, 0, 0, 0)
    assert verdicts.where(checks) == "amplitude 1 to 2; not at amplitude 3; open at amplitude 4"
    mixed = row(1, -1, -1, 1) + row(2, -1, -1, 1) + row(3, 1, -1, 1)
    assert verdicts.where(mixed) == (
        "at amplitude 1 to 2 not for velocity 0.1 to 1; at amplitude 3 not for velocity 1"
    )
    assert verdicts.where([check(1.0)]) == verdicts.where([]) == ""
