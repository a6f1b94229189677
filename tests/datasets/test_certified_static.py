"""Certified maps of the static limit over the amplitude, and over Poisson's ratio."""

import numpy as np
import pytest
import xarray as xr
from stubs import certified_stub

import microslip
from microslip.datasets import netcdf
from microslip.theory import paper

ERROR = 2e-3
STATIC = {"velocity": [0], "amplitude": [0, 1.5], "error": ERROR}


def record(request):
    """A record with the exact static limit at Poisson's ratio 0, and an invented one above."""
    amplitude, poisson = (float(request[name]) for name in ("amplitude", "poisson"))
    mu = float(paper.static_limit_transverse(amplitude)) * (1.0 - 0.1 * poisson**2)
    return certified_stub.record(request, mu, error=1e-5)


def built(**settings):
    map_ = certified_stub.configured("transverse", **STATIC | settings)
    return certified_stub.built(map_, record)


def test_the_closed_form_is_met_to_within_the_errors(tmp_path):
    path = tmp_path / "certified_transverse.nc"
    netcdf.write(path, built())
    with microslip.open_map(path) as dataset:
        amplitude = xr.DataArray(np.random.default_rng(2).uniform(0, 1.5, 500), dims="n")
        answer = dataset.microslip.at(0.0, amplitude)
        off = abs(answer.mu_macro - paper.static_limit_transverse(amplitude.values))
        assert bool((off <= answer.mu_macro_error).all())
        assert float(answer.mu_macro_error.max()) <= ERROR
        assert dataset.directions == "amplitude"
        assert dataset.points < 50


def test_over_poissons_ratio_it_answers_at_any():
    dataset = built(poisson=[0.0, 0.5])
    assert dataset.directions == "amplitude poisson"
    amplitude = xr.DataArray(np.linspace(0, 1.5, 200), dims="n")
    answer = dataset.microslip.at(0.0, amplitude, poisson=0.35)
    truth = paper.static_limit_transverse(amplitude.values) * (1.0 - 0.1 * 0.35**2)
    assert bool((abs(answer.mu_macro - truth) <= answer.mu_macro_error).all())


def test_what_slides_is_not_answered():
    with pytest.raises(ValueError, match="velocity = 0.1: allowed is 0"):
        built().microslip.at(0.1, 0.5)
