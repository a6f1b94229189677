"""Mean velocity under a force, from the certified map of a sweep over forces."""

from __future__ import annotations

import numpy as np
import xarray as xr

from microslip.datasets import certified_map
from microslip.datasets.query import lazily
from microslip.datasets.query.cells import cells_of
from microslip.datasets.query.coordinates import grid_axes, labelled
from microslip.datasets.variables import flags, link_errors, variable
from microslip.foundation.errors import InputError
from microslip.sweeps.drift_coordinates import DriftCoordinates, velocity_of
from microslip.theory.drift_threshold import threshold

STATES = ("stays", "drifts", "undecided", "runs away")
"""States of a contact, by their code in the variable `state`; undecided: the force equals the
threshold within the error of the threshold."""
(STAYS, DRIFTS, UNDECIDED, RUNS_AWAY) = range(len(STATES))
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
        if lazily.is_lazy(force, amplitude):
            asked = {"amplitude": labelled("amplitude", amplitude)}
            asked |= {"force": labelled("force", force)}
            return lazily.answered(self.at, self._dataset, asked)
        found = cells_of(self._dataset)
        # An outer product has the order of the datasets.
        given = labelled("amplitude", amplitude), labelled("force", force)
        amplitudes, forces = xr.broadcast(*given)
        rows = amplitudes.values.ravel().astype(float)
        flat = forces.values.ravel().astype(float)
        coordinates = found.cells.coordinates
        assert isinstance(coordinates, DriftCoordinates)  # as __init__ demands
        least = np.asarray(threshold(coordinates.motion, rows), float)
        state = np.full(len(flat), DRIFTS, np.int8)
        state[flat <= least + THRESHOLD_ERROR] = UNDECIDED
        state[(flat < least - THRESHOLD_ERROR) | (flat == 0.0)] = STAYS
        state[flat >= 1.0] = RUNS_AWAY
        moves = (state == DRIFTS) | (state == UNDECIDED)
        _refuse_beyond(coordinates, flat[moves], rows[moves])
        velocity, error = np.zeros((2, len(flat)))
        velocity[state == RUNS_AWAY] = np.inf
        scaled = coordinates.scaled(flat[moves], rows[moves], least[moves])
        velocity[moves], error[moves] = velocity_of(*found.cells.at_scaled(scaled))
        texts = {
            "velocity": (velocity, "mean forward velocity"),
            "velocity_error": (error, "bound of its error"),
            "threshold": (least, "force up to which the contact stays where it is"),
        }
        answer = {
            name: variable(forces.dims, values.reshape(forces.shape), text)
            for name, (values, text) in texts.items()
        }
        codes = state.reshape(forces.shape)
        answer["state"] = flags(forces.dims, codes, "what becomes of the contact", STATES)
        about = {"motion": self._dataset.attrs["motion"]}
        answered = xr.Dataset(answer, coords=forces.coords, attrs=about)
        return link_errors(answered.assign_coords(poisson=self._dataset["poisson"]))

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
