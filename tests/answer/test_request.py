"""Friction values are clipped to their physical range."""

import math

import pytest

from microslip.answer.answer import Estimate
from microslip.answer.request import within_friction
from microslip.scene.by_name import motion_named
from microslip.scene.problem import Problem

SIDEWAYS = Problem(motion_named("transverse"), 0.1, 1.0)
PROPELLED = Problem(motion_named("elliptic:forward_cycles=2,phase=0"), 0.1, 1.0)


@pytest.mark.parametrize(("problem", "least"), [(SIDEWAYS, 0.0), (PROPELLED, -1.0)])
def test_an_error_is_at_most_what_is_possible(problem, least):
    assert within_friction(problem, Estimate(1.02, {"resolution": 0.03})).value == 1.0
    unknown = within_friction(problem, Estimate(0.0, {"periodicity": 1e200}))
    assert unknown.value - unknown.error == least and unknown.value + unknown.error == 1.0
    assert math.isnan(within_friction(problem, Estimate(math.nan)).value)
