"""References in docs/measured: their points and error estimates."""

import pytest
from stubs.benchmark import ROOT, module

import microslip

SEEDS = [3, pytest.param(5, marks=pytest.mark.long)]
DRIVES = {"force", "stiffness", "contacts"}
LEAST = 24
"""Number of cheap points that are solved."""


@pytest.fixture(scope="module", params=SEEDS)
def sample(request):
    """List of (point, reference) of a table."""
    blind_points = module("blind_points")
    path = ROOT / "docs" / "measured" / f"references-{request.param}.csv"
    references = module("known_references").read(path, request.param)
    return [(blind_points.point(request.param, k), references[k]) for k in sorted(references)]


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
