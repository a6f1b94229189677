"""Mean velocity under a force, from the certified map of a sweep over forces."""

from __future__ import annotations

from functools import partial

import numpy as np
import xarray as xr

from microslip.datasets import certified_map
from microslip.datasets.query.answers import dataset_of
from microslip.datasets.query.cells import CellTable, cells_of
from microslip.datasets.query.coordinates import evaluate, grid_axes, labelled
from microslip.datasets.variables import attributes, flag_attributes
from microslip.foundation.errors import InputError
from microslip.sweeps.drift_coordinates import DriftCoordinates, velocity_of
from microslip.theory.drift_threshold import threshold

STATES = ("stays", "drifts", "undecided", "runs away")
"""States of a contact, by their code in the variable `state`; undecided: the force equals the
threshold within the error of the threshold."""
(STAYS, DRIFTS, UNDECIDED, RUNS_AWAY) = range(len(STATES))
DRIFT = {
    "velocity": attributes(float, "mean forward velocity"),
    "velocity_error": attributes(float, "bound of its error"),
    "threshold": attributes(float, "force up to which the contact stays where it is"),
    "state": flag_attributes("what becomes of the contact", STATES),
}
"""Attributes of the variables of an answer."""
THRESHOLD_ERROR = 1e-12
"""Error of the closed forms for thresholds."""


class Drift:
    """Mean velocity under a force, from the certified map of a sweep over forces.

    Raises ValueError for another dataset.
    """

    def __init__(self, dataset: xr.Dataset):
        if not certified_map.is_of_drift(dataset):
            raise ValueError(
                "no certified map of drift: allowed is certified_NAME of a sweep over forces that "
                "says adaptive"
            )
        self._dataset = dataset

    def at(self, force: object, amplitude: object) -> xr.Dataset:
        """Mean velocity under a force and a bound of its error.

        The map answers where the contact drifts.  Below the threshold it stays where it is, and
        from the force 1 on it runs away, whatever the map.

        Parameters
        ----------
        force, amplitude : number, sequence or DataArray
            >= 0.  A sequence becomes a dimension of the answer; DataArrays broadcast by their
            dimensions.  Where one is in chunks of dask, so is the answer.

        Returns
        -------
        xarray.Dataset
            velocity, velocity_error, threshold of the force, and state, an index into STATES with
            its meanings in flag_meanings.

        Raises
        ------
        InputError
            Naming the argument, for what is no such number, for what the dataset has lost, and for
            what drifts beyond the largest force or the amplitudes of the map.
        """
        table = cells_of(self._dataset).cells
        # An outer product has the order of the datasets.
        coordinates = {
            "amplitude": labelled("amplitude", amplitude),
            "force": labelled("force", force),
        }
        types = (float, float, float, np.int8)
        parts = evaluate(partial(_drift, table), coordinates, types)
        motion, poisson = self._dataset.attrs["motion"], self._dataset["poisson"]
        return dataset_of(parts, DRIFT, motion, poisson)

    def on_grid(self, force: object = 49, amplitude: object = 49) -> xr.Dataset:
        """Velocity and a bound of its error on a regular grid, for figures and plain xarray.

        Parameters
        ----------
        force, amplitude : int or sequence
            How many of them, in equal steps over the range of the map; or which ones.

        Returns
        -------
        xarray.Dataset
            As `at` gives it, dims (amplitude, force).

        Raises
        ------
        InputError
            As `at` does, and for less than two of them.
        """
        return self.at(**grid_axes(self._dataset, {"force": force, "amplitude": amplitude}))


def _drift(table: CellTable, amplitude: np.ndarray, force: np.ndarray) -> tuple[np.ndarray, ...]:
    """Velocity, its error bound, threshold of the force and code of the state, shape (n,) each."""
    coordinates = table.coordinates
    assert isinstance(coordinates, DriftCoordinates)  # as Drift demands
    least = np.asarray(threshold(coordinates.motion, amplitude), float)
    state = np.full(len(force), DRIFTS, np.int8)
    state[force <= least + THRESHOLD_ERROR] = UNDECIDED
    state[(force < least - THRESHOLD_ERROR) | (force == 0.0)] = STAYS
    state[force >= 1.0] = RUNS_AWAY
    moves = (state == DRIFTS) | (state == UNDECIDED)
    _refuse_beyond(coordinates, force[moves], amplitude[moves])
    velocity, error = np.zeros((2, len(force)))
    velocity[state == RUNS_AWAY] = np.inf
    scaled = coordinates.scaled(force[moves], amplitude[moves], least[moves])
    velocity[moves], error[moves] = velocity_of(*table.at_scaled(scaled))
    return velocity, error, least, state


def _refuse_beyond(coordinates: DriftCoordinates, force: np.ndarray, amplitude: np.ndarray) -> None:
    """Raise InputError, naming the argument, for the first place beyond the map that drifts."""
    low, high = coordinates.amplitude
    for name, values, ends in (
        ("force", force, (0.0, coordinates.force)),
        ("amplitude", amplitude, (low, high)),
    ):
        beyond = values[(values < ends[0]) | (values > ends[1])]
        if beyond.size:
            raise InputError(
                name,
                float(beyond[0]),
                f"allowed is {ends[0]:g} to {ends[1]:g} where the contact drifts: the map ends "
                "there, and microslip.solve goes on",
            )
