"""A small configuration of the study of propulsion, and its results."""

import numpy as np
from stubs.studies_stub import SWEEPS

from microslip.config import load

EIGHT = {"motion": "elliptic:forward_cycles=2,phase=0", "amplitude": 1, "panel": "loops"}
BACK = {"motion": "elliptic:forward_cycles=2,phase=180", "amplitude": 1, "panel": "loops"}
STILL = {"motion": "normal:forward=1", "amplitude": 0.1, "panel": "normal", "title": "at $ rest"}
DRIVING = {"points": 3, "motions": {"eight": EIGHT, "back": BACK, "still": STILL}}


def configured(**changes):
    """Configuration of the study with some settings changed."""
    return load.from_mapping({"sweeps": SWEEPS, "propulsion": DRIVING | changes})


def propulsion_result(request):
    """Straight line from the force 0.2 to the velocity 0.5, at a power input of 0.1. It is backward
    at the phase 180, and zero for an oscillating load."""
    sign = -1.0 if "phase=180" in request["motion"] else 1.0
    velocity = np.linspace(0.0, 0.5, request["points"])
    if request["motion"].startswith("normal"):
        sign, velocity = 0.0, np.zeros(0)
    force = 0.2 * (1.0 - 2.0 * velocity)
    small = np.full(velocity.shape, 1e-3)
    arrays = {
        "velocity": sign * velocity,
        "force": sign * force,
        "force_error": small,
        "power_out": force * velocity,
        "power_out_error": small * velocity,
        "power_in": 0.1 + 0.0 * velocity,
        "power_in_error": small,
        "efficiency": force * velocity / 0.1,
        "efficiency_error": small,
    }
    return {name: values.tolist() for name, values in arrays.items()} | {
        "stall_force": sign * 0.2,
        "stall_force_error": 1e-3,
        "no_load_velocity": sign * 0.5,
        "no_load_velocity_error": 2e-3,
        "converged": True,
        "reason": "" if sign else "propels nothing: friction holds",
    }
