"""References in docs/measured: their points, proved bounds, and error estimates."""

import pytest
from stubs.benchmark import ROOT, module

import microslip
from microslip.theory import exact

SEEDS = [3, pytest.param(5, marks=pytest.mark.long)]
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
    path = ROOT / "docs" / "measured" / f"references-{request.param}.csv"
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
