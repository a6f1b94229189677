"""Datasets of drives with values of closed forms."""

import numpy as np
import xarray as xr

from microslip.datasets.catalogue import DRIFT_FORMS, FORMS

FORCES = np.linspace(0.1, 0.9, 9)


def drift(motion):
    """Map of the velocity of a rigid contact under a force: 0 below the threshold."""
    amplitude = np.linspace(0.25, 3.0, 6)
    force, across = np.meshgrid(FORCES, amplitude)
    rigid = DRIFT_FORMS[motion].function(force, across)
    held = FORMS[motion]["mu_static"].function(amplitude)
    fine = np.linspace(0.25, 3.0, 50)
    moves = force > held[:, None]
    dims = ("amplitude", "force")
    return xr.Dataset(
        {
            "velocity": (dims, np.where(moves, rigid, 0.0)),
            "velocity_error": (dims, np.full(force.shape, 1e-3)),
            "converged": (dims, np.ones(force.shape, np.int8)),
            "velocity_large_amplitude": (dims, rigid),
            "mu_static": ("amplitude", held),
            "mu_static_curve": ("amplitude_curve", FORMS[motion]["mu_static"].function(fine)),
        },
        {"amplitude": amplitude, "force": FORCES, "amplitude_curve": fine, "poisson": 0.0},
        {"motion": motion, "title": motion},
    )


def pulled():
    """Datasets of the figure of drives: friction v / (1 + v), 0.1 less on the softest spring."""
    velocity, stiffness, mass = np.geomspace(1e-3, 10, 7), np.array([0.1, 10.0]), [0.1, 1.0, 10.0]
    mu = velocity / (1 + velocity)
    both = np.stack([mu - 0.1, mu])[:, None]
    dims = ("stiffness", "amplitude", "velocity")
    body = np.full((3, 2, 1, 1), 0.5)
    marks = {"mu_macro_error": 1e-3, "converged": 1}

    def dataset(dims, values, coords):
        every = {key: (dims, np.full(values.shape, value)) for key, value in marks.items()}
        return xr.Dataset({"mu_macro": (dims, values)} | every, coords | {"poisson": 0.0})

    one = {"amplitude": [1.0]}
    return {
        "transverse": dataset(("amplitude", "velocity"), mu[None], one | {"velocity": velocity}),
        "drive_force": xr.Dataset(
            {
                "velocity": (("amplitude", "force"), FORCES[None] / (1 - FORCES[None])),
                "velocity_error": (("amplitude", "force"), np.full((1, 9), 1e-3)),
                "converged": (("amplitude", "force"), np.ones((1, 9))),
            },
            one | {"force": FORCES, "poisson": 0.0},
        ),
        "drive_spring": dataset(dims, both, one | {"stiffness": stiffness, "velocity": velocity}),
        "drive_body": dataset(
            ("mass", *dims), body, one | {"mass": mass, "stiffness": stiffness, "velocity": [0.1]}
        ),
    }
