"""The dataset of a made-up sweep: Eq 6 with less of small amplitudes, known to within an error."""

import numpy as np
import xarray as xr

from microslip.theory import paper

FINE = {"velocity": np.geomspace(0.01, 10, 41), "amplitude": np.linspace(0.05, 4, 41)}


def eq6_map(error, velocity=FINE["velocity"], amplitude=FINE["amplitude"]):
    """Friction that rises with the velocity and falls with the amplitude."""
    v, a = np.meshgrid(velocity, amplitude)
    mu = paper.large_amplitude_transverse(v, a**2 / (1.0 + a))  # Eq 6 itself for large ones
    return map_of(mu, velocity, amplitude, error)


def map_of(mu, velocity, amplitude, error=0.0, **attributes):
    """The dataset of friction (amplitudes, velocities), all converged, known to within an error."""
    dims = ("amplitude", "velocity")
    return xr.Dataset(
        {
            "mu_macro": (dims, mu),
            "mu_macro_error": (dims, np.full(mu.shape, error)),
            "converged": (dims, np.ones(mu.shape, bool)),
        },
        {"velocity": velocity, "amplitude": amplitude, "poisson": 0.0},
        {"motion": "transverse"} | attributes,
    )
