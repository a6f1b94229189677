"""Every refusal of the public functions names the argument in one line, before any run."""

import math

import numpy as np
import pytest

import microslip
from microslip.answer import refine
from microslip.foundation.errors import InputError

EIGHT = "elliptic:forward_cycles=2,phase=0"
PROBLEM = microslip.Problem(microslip.Transverse(), 0.1, 0.5)
FORCED = microslip.Problem(microslip.Transverse(), 0.0, 0.5, drive=microslip.Force(0.2))
PATH = {"forward": [0.0, 1.0]}
GOOD = {
    "solve": {"motion": "transverse", "velocity": 0.5, "amplitude": 0.5},
    "force": {"motion": "transverse", "velocity": None, "amplitude": 0.5, "force": 0.9},
    "history": {"motion": "transverse", "velocity": 0.5, "amplitude": 0.5},
    "period": {"motion": "bore", "velocity": 0.1, "amplitude": 1.0},
    "traction_field": {"motion": "continuous-bore", "velocity": 0.5},
    "response": PATH,
    "shakedown": {"motion": "transverse", "amplitude": 0.5, "force": 0.3},
    "propulsion": {"motion": EIGHT, "amplitude": 1.0},
    "iwan": {"pressure": "hertz"},
}
NUMBERS = (math.nan, math.inf, "1", True)
STEADY = {"motion": "continuous-bore", "amplitude": None}
ALONE = dict.fromkeys(("velocity", "amplitude"))
BAD = [
    *(("solve", "motion", {"motion": one}) for one in ("sideways", None, ["bore"])),
    ("solve", "motion", {"motion": microslip.Transverse, "velocity": None}),
    *(("solve", "velocity", {"velocity": one}) for one in (-1e-9, 1e-17, None, *NUMBERS)),
    *(("solve", "amplitude", {"amplitude": one}) for one in (-0.1, None, *NUMBERS)),
    ("solve", "amplitude", STEADY | {"amplitude": 1.0}),
    *(("solve", "poisson", {"poisson": one}) for one in (-0.01, 0.51, None, *NUMBERS)),
    *(("solve", "model", {"model": one}) for one in ("best", "", None, ["radial"], {}, 3)),
    ("solve", "model", {"model": "radial", "poisson": 0.1}),
    *(("solve", "model", {"model": one, "motion": "bore"}) for one in ("slider", "mdr", "radial")),
    *(("solve", "tolerance", {"tolerance": one}) for one in (0.0, 1e-9, 1.0, None, *NUMBERS)),
    ("solve", "tolerance", {"tolerance": None, "cells": 16}),
    *(("solve", "cells", {"cells": one}) for one in (0, 2, 7, 8.0, *NUMBERS)),
    *(("solve", "steps", {"steps": one}) for one in (0, 4, 9, 16.0, *NUMBERS)),
    *(("solve", "most_work", {"most_work": one}) for one in (0, -1.0, math.nan, "1", True)),
    *(("solve", "time_limit", {"time_limit": one}) for one in (0, math.nan, "1")),
    *(("solve", "progress", {"progress": one}) for one in (3, object, lambda: 0)),
    *(("solve", "method", {"method": one}) for one in ("none", None, np.ones(3))),
    ("solve", "method", {"method": "paper"}),
    ("solve", "method", {"method": "euler", "stiffness": 1.0}),
    ("solve", "velocity", {"motion": PROBLEM}),
    ("solve", "force", {"motion": PROBLEM, **ALONE, "force": 0.1}),
    ("solve", "force", {"force": 0.1}),
    ("solve", "mass", {"mass": 1.0}),
    ("solve", "stiffness", {"stiffness": 1e-300}),
    ("solve", "model", {"stiffness": 1.0, "model": "dahl"}),
    ("solve", "velocity", {"motion": "elliptic", "velocity": 0.0, "stiffness": 1.0}),
    ("force", "stiffness", {"stiffness": 1.0}),
    ("force", "force", {"force": -0.1}),
    ("force", "force", {"force": 0.9999}),
    ("force", "force", {"force": -0.99999, "motion": "elliptic:forward_cycles=2"}),
    ("force", "force", {"force": 0.9999, "motion": "normal", "mass": 1.0}),
    ("force", "force", STEADY | {"force": 1.0 - 1e-9}),
    ("history", "velocity", {"velocity": 0.0}),
    ("history", "start", {"start": "sticking"}),
    ("history", "start", {"start": "full-rotation"}),
    *(("history", name, {name: 0}) for name in ("cells", "steps", "periods", "travel")),
    *((name, "drive", {"motion": FORCED, **ALONE}) for name in ("history", "period")),
    ("period", "motion", STEADY),
    *(("period", name, {name: 0.0}) for name in ("velocity", "amplitude")),
    *(("period", name, {name: 7}) for name in ("cells", "angles", "steps")),
    ("period", "model", {"pressure": "ellipse"}),
    ("traction_field", "motion", {"motion": "bore", "amplitude": 1.0}),
    ("traction_field", "velocity", {"velocity": 0.0}),
    *(("response", "forward", {"forward": one}) for one in ([0.0], [0.0, np.nan], [0.0, 1e300])),
    ("response", "lateral", {"lateral": [0.0, 1.0, 2.0]}),
    ("response", "load", {"load": [1.0, -0.1]}),
    ("response", "indentation", {"load": [1, 1], "indentation": [1, 1]}),
    ("response", "pressure", {"load": [1, 2], "pressure": "ellipse"}),
    *(("response", "state", {"state": one}) for one in ("sticking", "", "full-rotation")),
    *(("response", name, {name: 3}) for name in ("progress", "tolerance", "poisson")),
    ("response", "progress", {"progress": abs}),
    ("history", "travel", {"travel": 5.0}),
    ("history", "periods", STEADY | {"periods": 3}),
    ("shakedown", "motion", STEADY),
    ("shakedown", "motion", {"motion": "transverse-bore"}),
    *(("shakedown", "force", {"force": one}) for one in (-0.1, math.nan, None)),
    ("shakedown", "force", {"motion": FORCED, "amplitude": None}),
    ("shakedown", "velocity", {"motion": PROBLEM, "amplitude": None}),
    *(("shakedown", "tolerance", {"tolerance": one}) for one in (0.5, None)),
    ("shakedown", "model", {"model": "rigid"}),
    ("propulsion", "motion", {"motion": "transverse"}),
    ("propulsion", "motion", {"motion": "elliptic:forward_cycles=6,lateral_cycles=2,phase=30"}),
    ("propulsion", "motion", {"motion": "normal:forward=1,normal_cycles=2"}),
    *(("propulsion", "amplitude", {"amplitude": one}) for one in (0.0, -1.0, None)),
    ("iwan", "pressure", {"pressure": "ring"}),
    ("iwan", "pressure", {"pressure": "ellipse", "poisson": 0.3}),
    ("iwan", "elements", {"elements": 0}),
    ("iwan", "tolerance", {"tolerance": 0.0}),
    ("iwan", "poisson", {"poisson": 0.6}),
    ("iwan", "elements", {"elements": 4, "tolerance": 0.1}),
]


@pytest.mark.parametrize(("function", "argument", "changes"), BAD)
def test_a_bad_argument_is_named(function, argument, changes, monkeypatch):
    monkeypatch.setattr(refine, "refine", None)
    call = microslip.solve if function == "force" else getattr(microslip, function)
    with pytest.raises(InputError) as error:
        call(**GOOD[function] | changes)
    assert error.value.argument == argument
    assert str(error.value).startswith(f"{argument} = ") and "\n" not in str(error.value)
