"""Mean velocity under a force, from the certified map of a sweep over forces."""

from __future__ import annotations

from functools import partial

import numpy as np
import xarray as xr

from microslip.datasets import certified_map
from microslip.datasets.query.answers import dataset_of
from microslip.datasets.query.cells import CellTable, cells_of
from microslip.datasets.query.coordinates import coordinate_array, evaluate, grid_axes
from microslip.datasets.variables import attributes, flag_attributes
from microslip.foundation.errors import InputError
from microslip.sweeps.drift_coordinates import DriftCoordinates, velocity_of
from microslip.theory.drift_threshold import threshold

STATES = ("stays", "drifts", "undecided", "runs away")
"""States of a contact, in the order of the codes in the variable `state`.

A state is undecided if the force equals the threshold to within the threshold's error.
"""
(STAYS, DRIFTS, UNDECIDED, RUNS_AWAY) = range(len(STATES))
DRIFT = {
    "velocity": attributes(float, "mean forward velocity"),
    "velocity_error": attributes(float, "bound of its error"),
    "threshold": attributes(float, "force up to which the contact stays where it is"),
    "state": flag_attributes("what becomes of the contact", STATES),
}
"""Attributes of the variables of a result."""
THRESHOLD_ERROR = 1e-12
"""Rounding error of the closed forms for the force threshold."""


class Drift:
    """Mean velocity under a force, from the certified map of a sweep over forces.

    Raises ValueError if the dataset is not such a map.
    """

    def __init__(self, dataset: xr.Dataset):
        if not certified_map.is_of_drift(dataset):
            raise ValueError(
                "no certified map of drift: allowed is certified_NAME of a sweep over forces "
                "with the key adaptive"
            )
        self._dataset = dataset

    def at(self, force: object, amplitude: object) -> xr.Dataset:
        """Mean velocity under a force, with an error bound.

        The velocity is 0 for forces below the threshold and infinite for forces of at least 1.
        Between these forces the contact drifts, and its velocity is interpolated in the map.

        Parameters
        ----------
        force, amplitude : number, sequence or DataArray
            Dimensionless force and amplitude, at least 0.  A sequence becomes a dimension of the
            result; DataArrays broadcast by their dimensions.  If an argument is in dask chunks, so
            is the result.

        Returns
        -------
        xarray.Dataset
            Variables velocity, velocity_error, threshold and state.  `threshold` is the force up to
            which the contact stays at rest.  `state` is an index into STATES, listed in the
            attribute flag_meanings.

        Raises
        ------
        InputError
            If an argument is invalid, if the dataset lacks a variable, or if a contact drifts
            outside the range of the map.  The message names the argument or the variable.
        """
        table = cells_of(self._dataset)
        # The amplitude is the first dimension, as in the datasets.
        coordinates = {
            "amplitude": coordinate_array("amplitude", amplitude),
            "force": coordinate_array("force", force),
        }
        types = (float, float, float, np.int8)
        parts = evaluate(partial(_drift, table), coordinates, types)
        motion, poisson = self._dataset.attrs["motion"], self._dataset["poisson"]
        return dataset_of(parts, DRIFT, motion, poisson)

    def on_grid(self, force: object = 49, amplitude: object = 49) -> xr.Dataset:
        """Mean velocity on a regular grid, with an error bound.

        Parameters
        ----------
        force, amplitude : int or sequence
            Number of coordinates in equal steps over the range of the map, or the coordinates
            themselves.

        Returns
        -------
        xarray.Dataset
            Result of `at` with the dimensions (amplitude, force).

        Raises
        ------
        InputError
            If a number of coordinates is below 2, or if `at` raises InputError.
        """
        return self.at(**grid_axes(self._dataset, {"force": force, "amplitude": amplitude}))


def _drift(table: CellTable, amplitude: np.ndarray, force: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return the velocity, its error bound, the force threshold and the code of the state, (n,)
    each."""
    coordinates = table.coordinates
    assert isinstance(coordinates, DriftCoordinates)  # checked by Drift
    least = np.asarray(threshold(coordinates.motion, amplitude), float)
    state = np.full(len(force), DRIFTS, np.int8)
    state[force <= least + THRESHOLD_ERROR] = UNDECIDED
    state[(force < least - THRESHOLD_ERROR) | (force == 0.0)] = STAYS
    state[force >= 1.0] = RUNS_AWAY
    moves = (state == DRIFTS) | (state == UNDECIDED)
    _refuse_outside(coordinates, force[moves], amplitude[moves])
    velocity, error = np.zeros((2, len(force)))
    velocity[state == RUNS_AWAY] = np.inf
    scaled = coordinates.scaled(force[moves], amplitude[moves], least[moves])
    velocity[moves], error[moves] = velocity_of(*table.at_scaled(scaled))
    return velocity, error, least, state


def _refuse_outside(
    coordinates: DriftCoordinates, force: np.ndarray, amplitude: np.ndarray
) -> None:
    """Raise InputError for the first point outside the map, with the name of the argument."""
    low, high = coordinates.amplitude
    for name, values, ends in (
        ("force", force, (0.0, coordinates.force)),
        ("amplitude", amplitude, (low, high)),
    ):
        outside = values[(values < ends[0]) | (values > ends[1])]
        if outside.size:
            raise InputError(
                name,
                float(outside[0]),
                f"allowed is {ends[0]:g} to {ends[1]:g}, the range of the map, where the contact "
                "drifts; microslip.solve computes other points",
            )
