"""References in docs/measured: their points, proved bounds, and error estimates."""

import pytest
from stubs.benchmark import ROOT, module

import microslip
from microslip.theory import exact

SEED = 3
MEASURED = ROOT / "docs" / "measured"
TABLE = MEASURED / f"references-{SEED}.csv"
SEEDS = [SEED, pytest.param(5, marks=pytest.mark.long)]
DRIVES = {"force", "stiffness", "contacts"}
PROVED = {
    "transverse": exact.largest_drop_transverse,
    "bore": exact.largest_drop_bore,
    "longitudinal": exact.largest_drop_longitudinal,
}
LEAST = 24
"""Number of cheap points that are solved."""


@pytest.fixture(scope="module", params=SEEDS)
def sample(request):
    """List of (point, reference) of a table."""
    blind_points = module("blind_points")
    path = MEASURED / f"references-{request.param}.csv"
    references = module("known_references").read(path, request.param)
    return [(blind_points.point(request.param, k), references[k]) for k in sorted(references)]


def test_references_are_within_proved_bounds(sample):
    judged = 0
    for point, reference in sample:
        assert reference["by"] in ("tighter", "finer")
        if "force" in point:
            continue
        assert abs(reference["reference"]) <= 1.0 + reference["uncertainty"], point
        alone = not DRIVES & point.keys()
        if alone and point["pressure"] == "hertz" and point["motion"] in PROVED:
            drop = PROVED[point["motion"]](point["velocity"], point["amplitude"])
            assert 1.0 - reference["reference"] <= drop + reference["uncertainty"], point
            judged += drop < 1.0
    assert judged > len(sample) / 30


def test_references_are_more_certain_than_the_tolerance(sample):
    for point, reference in sample:
        size = max(1.0, abs(reference["reference"])) if "force" in point else 1.0
        assert reference["uncertainty"] <= point["tolerance"] * size, point


def test_estimates_cover_the_differences_from_them(sample):
    cheap = [
        (point, reference)
        for point, reference in sample
        if (point["motion"], point["pressure"]) == ("transverse", "hertz")
        and (point["poisson"], point["tolerance"]) == (0.0, 1e-2)
        and not DRIVES & point.keys()
    ]
    solved = cheap[:: len(cheap) // LEAST]
    assert len(solved) >= LEAST
    for point, reference in solved:
        arguments = {name: value for name, value in point.items() if name != "stratum"}
        result = microslip.solve(**arguments)
        assert result.converged, point
        assert abs(result.mu_macro - reference["reference"]) <= result.mu_macro_error, point


def test_a_row_of_another_point_ends_the_run(tmp_path):
    known_references = module("known_references")
    copy = tmp_path / TABLE.name
    head, row = TABLE.read_text().splitlines()[:2]
    copy.write_text(f"{head}\n{row}\n")
    k, reference = known_references.read(copy, SEED).popitem()
    again = tmp_path / "again.csv"
    known_references.write(again, {k: reference}, SEED)
    assert again.read_text() == copy.read_text()
    for seed in (SEED + 1, SEED + 2):
        with pytest.raises(SystemExit, match=f"point {k} is not that of seed {seed}"):
            known_references.read(copy, seed)
