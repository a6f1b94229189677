"""The nodes of a map: what a dataset, or a part of one, knows, as a table for a Poisson's ratio.

Between two Poisson's ratios every node is interpolated as along the other axes: by a cubic through
the nearest ratios, or what fewer of them allow.  Its error holds those of the nodes and the largest
miss when ratios are left out, of two ratios how far their values are apart.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from microslip.datasets.query.answers import LOST, NEEDS
from microslip.datasets.query.interpolation import Axis, Table, largest_around
from microslip.foundation.arguments import is_real
from microslip.foundation.errors import InputError

if TYPE_CHECKING:
    from microslip.datasets.query.cells import CellNodes

SAME = 1e-12
"""Poisson's ratios that differ by less are one."""


@dataclass(frozen=True, eq=False)
class Nodes:
    """Values and their errors at the nodes of a map; NaN: not known.

    Attributes
    ----------
    poisson, amplitude, velocity : numpy.ndarray
        The axes, ascending, shapes (k,), (n,) and (m,); dimensionless.
    values, errors : numpy.ndarray
        mu_macro and the bound of its error, shape (k, n, m).
    """

    poisson: np.ndarray
    amplitude: np.ndarray
    velocity: np.ndarray
    values: np.ndarray
    errors: np.ndarray

    def table(self, poisson: float, *, still: bool = False) -> Table | None:
        """The map for a Poisson's ratio above velocity 0, or of that alone; None: there is none."""
        chosen = self.velocity == 0.0 if still else self.velocity > 0.0
        if not chosen.any():
            return None
        values, errors = self._at(poisson)
        columns = Axis(self.velocity[chosen])
        return Table(Axis(self.amplitude), columns, values[:, chosen], errors[:, chosen])

    def _at(self, poisson: float) -> tuple[np.ndarray, np.ndarray]:
        """Values and errors at a Poisson's ratio, shape (n, m)."""
        near = int(np.argmin(np.abs(self.poisson - poisson)))
        if abs(self.poisson[near] - poisson) <= SAME:
            return self.values[near], self.errors[near]
        axis = Axis(self.poisson)
        (cell,), (share,), (index,), (weights,) = axis.cubics(np.array([poisson]))
        value = np.tensordot(weights, self.values[index], 1)
        flat = self.values.reshape(len(self.poisson), -1)
        misses = axis.misses(flat).reshape(self.values.shape)
        # the misses of the nodes around the cell, as along the other axes
        around = misses[max(cell - 1, 0) : cell + 3].max(axis=0)
        left = 4.0 * share * (1.0 - share) * largest_around(around)
        return value, self.errors[index].max(axis=0) + left


def nodes_of(dataset: xr.Dataset, *, periodic: bool, poisson: float | None = None) -> Nodes:
    """The nodes that a dataset of a sweep, or a part of one, knows.

    Parameters
    ----------
    dataset : xarray.Dataset
        mu_macro and mu_macro_error over velocity, amplitude if the motion is periodic, and poisson;
        one of a single value may be a coordinate without a dimension.  Nodes that did not converge
        are not known; without `converged` these are those whose error is above the `tolerance` of
        the dataset's attributes.
    periodic : bool
        Whether the motion has an amplitude.
    poisson : float, optional
        What to take for Poisson's ratio where the dataset has lost it.

    Raises
    ------
    InputError
        With the name of what the dataset has lost, or of a dimension too many.
    """
    axes = ("poisson", "amplitude", "velocity") if periodic else ("poisson", "velocity")
    if "poisson" not in dataset.coords and poisson is not None:
        dataset = dataset.assign_coords(poisson=float(poisson))
    for name in ("mu_macro", "mu_macro_error", *axes):
        if name not in dataset.variables:
            raise InputError(name, None, LOST)
        if dataset[name].dtype.kind not in "iuf":
            raise InputError(name, f"of type {dataset[name].dtype}", f"{NEEDS} numbers there")
    if dataset["poisson"].ndim and dataset["poisson"].dims != ("poisson",):
        given = f"over {dataset['poisson'].dims}"
        raise InputError("poisson", given, f"{NEEDS} one, or an axis of them")
    chosen = dataset[["mu_macro", "mu_macro_error"]].assign(known=_known(dataset)).compute()
    for extra in (dim for dim in chosen.dims if dim not in axes):
        given = f"{chosen.sizes[extra]} entries"
        raise InputError(str(extra), given, f"{NEEDS} one of them: select it")
    for dim in axes:
        if dim not in chosen.dims:
            chosen = chosen.expand_dims(dim)
        if not chosen.sizes[dim]:
            raise InputError(dim, "no entry", f"{NEEDS} one at least, and none is selected")
    _refuse_contradictions(chosen, axes)
    chosen = chosen.drop_duplicates(list(axes)).sortby(list(axes)).transpose(*axes)
    values, errors = (
        chosen[name].where(chosen["known"]).values.astype(float)
        for name in ("mu_macro", "mu_macro_error")
    )
    if not periodic:
        values, errors = values[:, None], errors[:, None]
    amplitude = chosen["amplitude"].values.astype(float) if periodic else np.zeros(1)
    poissons, velocity = (chosen[dim].values.astype(float) for dim in ("poisson", "velocity"))
    nodes = Nodes(poissons, amplitude, velocity, values, errors)
    _refuse_impossible(nodes)
    return nodes


def _refuse_contradictions(chosen: xr.Dataset, axes: tuple[str, ...]) -> None:
    """Raise InputError for equal nodes, as after a join, with mu_macro beyond their errors."""
    value, error = (chosen[name].where(chosen["known"]) for name in ("mu_macro", "mu_macro_error"))
    for axis in (axis for axis in axes if chosen.indexes[axis].has_duplicates):
        low, high = (value - error).groupby(axis).max(), (value + error).groupby(axis).min()
        apart = (low > high).any([dim for dim in low.dims if dim != axis])
        if apart.any():
            said = "is there twice with mu_macro that differ by more than their errors"
            raise InputError(axis, float(low[axis][apart][0]), f"{said}: keep one")


def _refuse_impossible(nodes: Nodes) -> None:
    """Coordinates, or values by more than their errors, that no sweep can have."""
    for name, top in (("poisson", 0.5 + SAME), ("amplitude", np.inf), ("velocity", np.inf)):
        axis = getattr(nodes, name)
        wrong = axis[~(np.isfinite(axis) & (axis >= 0.0) & (axis <= top))]
        if wrong.size:
            allowed = "0 to 0.5" if name == "poisson" else "a finite number >= 0"
            raise InputError(name, float(wrong[0]), f"in the dataset; allowed is {allowed}")
    if (nodes.errors < 0.0).any():
        least = float(np.nanmin(nodes.errors))
        raise InputError("mu_macro_error", least, "in the dataset; allowed is 0 or more")


def refuse_values(nodes: Nodes | CellNodes, least: float) -> None:
    """Raise InputError for mu_macro outside `least` to 1 by more than its error.

    The force is at most mu F_z, so that mu_macro is at least -1.  It is at least 0 for motions that
    cannot propel the contact.
    """
    off = np.fmax(nodes.values - 1.0, least - nodes.values) > nodes.errors + SAME
    if off.any():
        allowed = f"in the dataset; allowed is {least:g} to 1"
        raise InputError("mu_macro", float(nodes.values[off][0]), allowed)


def _known(dataset: xr.Dataset) -> xr.DataArray:
    """Which nodes converged."""
    if "converged" in dataset:
        return dataset["converged"] == 1  # not what a join has filled in
    if "tolerance" not in dataset.attrs:
        raise InputError("converged", None, LOST)
    tolerance = dataset.attrs["tolerance"]
    try:
        return dataset["mu_macro_error"] <= float(tolerance)
    except (TypeError, ValueError):
        allowed = f"{NEEDS} a number there, or the variable converged"
        raise InputError("tolerance", tolerance, allowed) from None


def poisson_within(known: np.ndarray, poisson: float | None) -> float:
    """The Poisson's ratio that is asked for, a float within the range of those known, ascending."""
    low, high = float(known[0]), float(known[-1])
    many = high > low
    allowed = f"allowed is {low:g}" + (f" to {high:g}" if many else ", the dataset's only one")
    if poisson is None and many:
        raise InputError("poisson", None, f"{allowed}: the dataset has more than one")
    if not (poisson is None or is_real(poisson)):
        raise InputError("poisson", poisson, f"{allowed}, one number")
    try:
        nu = low if poisson is None else float(poisson)
    except OverflowError:  # a whole number of more than 308 digits
        nu = np.inf
    if not low - SAME <= nu <= high + SAME:
        raise InputError("poisson", poisson, f"{allowed}; microslip.solve computes any")
    return nu
