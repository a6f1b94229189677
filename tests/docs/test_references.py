"""The references in docs/measured are of the sample and within what is proved, and claims hold."""

import sys
from functools import cache
from pathlib import Path

import pytest

import microslip
from microslip.theory import bounds

ROOT = Path(__file__).parents[2]
SEED = 3
TABLE = ROOT / "docs" / "measured" / f"references-{SEED}.csv"
PROVED = {
    "transverse": bounds.largest_drop_transverse,
    "bore": bounds.largest_drop_bore,
    "longitudinal": bounds.largest_drop_longitudinal,
}
LEAST = 24
"""Points of a kind that are cheap to solve, spread over the table."""


@cache
def module(name):
    """A module of the folder of benchmarks, which no package holds."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(ROOT / "benchmarks")
        __import__(name)
    return sys.modules[name]


@pytest.fixture(scope="module")
def sample():
    """(point, what is known of it) of every row."""
    blind_points = module("blind_points")
    known = module("known_references").read(TABLE, SEED)
    return [(blind_points.point(SEED, k), known[k]) for k in sorted(known)]


def test_references_are_within_what_is_proved(sample):
    """Whoever compares another code with the table is not sent astray by a wrong row."""
    judged = 0
    for point, known in sample:
        assert abs(known["reference"]) <= 1.0 + known["uncertainty"], point
        assert known["by"] in ("tighter", "finer")
        if point["pressure"] == "hertz" and point["motion"] in PROVED:
            drop = PROVED[point["motion"]](point["velocity"], point["amplitude"])
            assert 1.0 - known["reference"] <= drop + known["uncertainty"], point
            judged += drop < 1.0
    assert judged > len(sample) / 10


def test_references_are_more_certain_than_what_they_judge(sample):
    uncertain = [point for point, known in sample if known["uncertainty"] > point["tolerance"]]
    assert not uncertain


def test_claims_hold_against_them(sample):
    cheap = [
        (point, known)
        for point, known in sample
        if (point["motion"], point["pressure"]) == ("transverse", "hertz")
        and (point["poisson"], point["tolerance"]) == (0.0, 1e-2)
    ]
    tried = cheap[:: len(cheap) // LEAST]
    assert len(tried) >= LEAST
    for point, known in tried:
        given = {name: value for name, value in point.items() if name != "stratum"}
        found = microslip.solve(**given)
        assert found.converged, point
        assert abs(found.mu_macro - known["reference"]) <= found.mu_macro_error, point


def test_a_row_of_another_point_ends_the_run(tmp_path):
    known_references = module("known_references")
    copy = tmp_path / TABLE.name
    head, row = TABLE.read_text().splitlines()[:2]
    copy.write_text(f"{head}\n{row}\n")
    k, known = known_references.read(copy, SEED).popitem()
    again = tmp_path / "again.csv"
    known_references.write(again, {k: known}, SEED)
    assert again.read_text() == copy.read_text()
    for seed in (SEED + 1, SEED + 2):
        with pytest.raises(SystemExit, match=f"point {k} is not that of seed {seed}"):
            known_references.read(copy, seed)
