"""Stored periods: unpacked tractions, slips and forces equal the computed ones."""

from unittest.mock import Mock

import numpy as np
import pytest
from stubs.unpacked_period import unpacked

import microslip
from microslip.answer.period import NoPeriodicState
from microslip.contact.contact import StepFailure
from microslip.sweeps import batch, period_codec

POINTS = [("transverse", "0.1", "0.6", "0"), ("transverse", "0.1", "0.6", "0.3")]
POINTS += [("bore", "0.05", "0.7", "0.3"), ("zigzag", "0.2", "1", "0")]
COUNTS = {"cells": 6, "angles": 4, "steps": 12}


def asked(point):
    place = dict(zip(("motion", "velocity", "amplitude", "poisson"), point, strict=True))
    return {"kind": "period", **place, **COUNTS}


@pytest.mark.parametrize("point", POINTS, ids=str)
def test_a_stored_period_is_the_computed_one_within_half_a_step(point, tmp_path):
    path = tmp_path / "batch.jsonl"
    batch.solve([asked(point)], path)
    (record,) = batch.read(path)
    result = unpacked(record["result"])
    motion, velocity, amplitude, poisson = point[0], *map(float, point[1:])
    truth = microslip.period(motion, velocity, amplitude, poisson=poisson, **COUNTS)
    for name in (*period_codec.HISTORIES, "forward_position", "lateral_position", "bound"):
        assert result[name] == pytest.approx(getattr(truth, name), abs=1e-7), name
    # the mirror symmetry of the state is as accurate as its convergence
    for name in ("traction_forward", "traction_lateral"):
        off = np.abs(result[name] - getattr(truth, name)) / truth.bound
        assert off.max() < 0.5 / period_codec.SHARES + 1e-3, name
    assert (result["slips"] == truth.slips).all()
    density = truth.dissipated_energy_density / truth.dissipated_energy_density.max()
    assert result["densities"] == pytest.approx(density, abs=1e-3)
    assert (result["mu_macro"], result["converged"]) == (truth.mu_macro, truth.converged)


@pytest.mark.parametrize(
    ("kind", "function"),
    [("period", "microslip.period"), ("patches", "microslip.answer.period.period")],
)
@pytest.mark.parametrize("error", [NoPeriodicState, StepFailure])
def test_where_there_is_no_state_a_result_says_so(kind, function, error, monkeypatch):
    monkeypatch.setattr(function, Mock(side_effect=error("no periodic state")), raising=False)
    result = batch.computed(asked(POINTS[0]) | {"kind": kind})[0]["result"]
    assert result["converged"] is False and result["reason"].endswith("no periodic state")
    assert ("crashed" in result) == (error is StepFailure)
