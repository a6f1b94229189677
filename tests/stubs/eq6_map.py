"""Dataset of a sweep: Eq 6, reduced at small amplitudes, with an error estimate."""

import numpy as np
import xarray as xr

from microslip.config.quantities import AXES
from microslip.datasets.interpolation import checksums, scene_of
from microslip.theory import paper

FINE = {"velocity": np.geomspace(0.01, 10, 41), "amplitude": np.linspace(0.05, 4, 41)}


def places(count, decades=(-3, 1), amplitude=(0, 3), seed=3):
    """Velocities, random in these decades, and amplitudes in a range, as arrays of equal length."""
    rng = np.random.default_rng(seed)
    return (
        xr.DataArray(10 ** rng.uniform(*decades, count), dims="n"),
        xr.DataArray(rng.uniform(*amplitude, count), dims="n"),
    )


def eq6_map(error, velocity=FINE["velocity"], amplitude=FINE["amplitude"]):
    """Friction that increases with velocity and decreases with amplitude."""
    v, a = np.meshgrid(velocity, amplitude)
    mu = paper.large_amplitude_transverse(v, a**2 / (1.0 + a))  # Eq 6 itself for large amplitudes
    return map_of(mu, velocity, amplitude, error)


def map_of(mu, velocity, amplitude, error=0.0, poisson=0.0, **attributes):
    """Dataset of friction (amplitudes, velocities) with an error estimate; all points converged."""
    dims = ("amplitude", "velocity")
    dataset = xr.Dataset(
        {
            "mu_macro": (dims, mu),
            "mu_macro_error": (dims, np.full(mu.shape, error)),
            "converged": (dims, np.ones(mu.shape, bool)),
        },
        {"velocity": velocity, "amplitude": amplitude, "poisson": poisson},
        {"motion": "transverse"} | attributes,
    )
    return with_checksums(dataset)


def with_checksums(dataset, name="mu_macro"):
    """The dataset with checksums of its present points."""
    value, error = dataset[name], dataset[f"{name}_error"].values
    axes = [dataset[one] for one in AXES if one in dataset.coords]
    codes = checksums(axes, value.values, error, scene_of(dataset.attrs))
    return dataset.assign(checksum=dataset.converged * codes.reshape(value.shape))
