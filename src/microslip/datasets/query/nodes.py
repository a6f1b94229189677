"""Read the nodes of a map from a sweep's dataset, or from a selection of such a dataset.

Between Poisson's ratios, the value at each node is interpolated by a cubic through the four nearest
ratios, or by a polynomial of lower degree if there are fewer ratios.  The error is the sum of the
node errors and the interpolation error.  The interpolation error is estimated by leaving ratios out
(see `interpolation`).  With only two ratios, it is the difference between the two values.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from microslip.datasets.query.answers import LOST, NEEDS
from microslip.datasets.query.interpolation import Axis, Table, largest_around
from microslip.foundation.arguments import is_real
from microslip.foundation.errors import InputError

AXES = ("poisson", "amplitude", "velocity")
SAME = 1e-12
"""Difference below which two Poisson's ratios, or two values of friction, count as equal."""


def nodes_of(dataset: xr.Dataset, *, periodic: bool, poisson: float | None = None) -> xr.Dataset:
    """Read the nodes of a map from a sweep's dataset, or from a selection of such a dataset.

    Parameters
    ----------
    dataset : xarray.Dataset
        Dataset with mu_macro and mu_macro_error.  Their dimensions are velocity, poisson and, if
        the motion is periodic, amplitude.  An axis with only one value can be a coordinate without
        a dimension.  Values at nodes that did not converge are unknown.  Without a variable
        `converged`, these are the nodes with an error above the attribute `tolerance`.
    periodic : bool
        True if the motion has an amplitude.
    poisson : float, optional
        Poisson's ratio of the dataset, if the dataset lacks this coordinate.

    Returns
    -------
    xarray.Dataset
        mu_macro and mu_macro_error over AXES, which are ascending.  Unknown values are NaN.  The
        amplitude of a steady motion is 0.

    Raises
    ------
    InputError
        If a variable is missing or a dimension is not allowed.  The message contains the name.
    """
    axes = tuple(axis for axis in AXES if periodic or axis != "amplitude")
    if "poisson" not in dataset.coords and poisson is not None:
        dataset = dataset.assign_coords(poisson=float(poisson))
    for name in ("mu_macro", "mu_macro_error", *axes):
        if name not in dataset.variables:
            raise InputError(name, None, LOST)
        if dataset[name].dtype.kind not in "iuf":
            raise InputError(name, f"of type {dataset[name].dtype}", f"{NEEDS} numbers there")
    if dataset["poisson"].ndim and dataset["poisson"].dims != ("poisson",):
        dims = f"over {dataset['poisson'].dims}"
        raise InputError("poisson", dims, f"{NEEDS} one, or an axis of them")
    chosen = dataset[["mu_macro", "mu_macro_error"]].assign(is_known=_converged(dataset)).compute()
    for extra in (dim for dim in chosen.dims if dim not in axes):
        entries = f"{chosen.sizes[extra]} entries"
        raise InputError(str(extra), entries, f"{NEEDS} one of them: select it")
    for dim in axes:
        if dim not in chosen.dims:
            chosen = chosen.expand_dims(dim)
        if not chosen.sizes[dim]:
            raise InputError(dim, "no entry", f"{NEEDS} one at least, and none is selected")
    _refuse_contradictions(chosen, axes)
    if not periodic:
        chosen = chosen.expand_dims(amplitude=[0.0])
    nodes = chosen.drop_duplicates(list(axes)).sortby(list(axes)).transpose(*AXES)
    nodes = nodes[["mu_macro", "mu_macro_error"]].where(nodes["is_known"])
    _refuse_impossible(nodes)
    return nodes


def _refuse_contradictions(chosen: xr.Dataset, axes: tuple[str, ...]) -> None:
    """Raise InputError if two nodes at the same place differ by more than their errors.

    A join of datasets can contain such a pair of nodes.
    """
    value, error = (
        chosen[name].where(chosen["is_known"]) for name in ("mu_macro", "mu_macro_error")
    )
    for axis in (axis for axis in axes if chosen.indexes[axis].has_duplicates):
        low, high = (value - error).groupby(axis).max(), (value + error).groupby(axis).min()
        apart = (low > high).any([dim for dim in low.dims if dim != axis])
        if apart.any():
            allowed = "is there twice with mu_macro that differ by more than their errors: keep one"
            raise InputError(axis, float(low[axis][apart][0]), allowed)


def _refuse_impossible(nodes: xr.Dataset) -> None:
    """Raise InputError if a coordinate or an error is outside its allowed range."""
    for name, top in (("poisson", 0.5 + SAME), ("amplitude", np.inf), ("velocity", np.inf)):
        axis = nodes[name].values
        wrong = axis[~(np.isfinite(axis) & (axis >= 0.0) & (axis <= top))]
        if wrong.size:
            allowed = "0 to 0.5" if name == "poisson" else "a finite number >= 0"
            raise InputError(name, float(wrong[0]), f"in the dataset; allowed is {allowed}")
    least = float(nodes["mu_macro_error"].min())
    if least < 0.0:
        raise InputError("mu_macro_error", least, "in the dataset; allowed is 0 or more")


def refuse_values(nodes: xr.Dataset, least: float) -> None:
    """Raise InputError if mu_macro is outside the range `least` to 1 by more than its error.

    `least` is -1, or 0 for motions that cannot propel the contact.
    """
    values = nodes["mu_macro"].values
    off = np.fmax(values - 1.0, least - values) > nodes["mu_macro_error"].values + SAME
    if off.any():
        allowed = f"in the dataset; allowed is {least:g} to 1"
        raise InputError("mu_macro", float(values[off][0]), allowed)


def _converged(dataset: xr.Dataset) -> xr.DataArray:
    """Return True for nodes that converged."""
    if "converged" in dataset:
        return dataset["converged"] == 1  # a join fills gaps with NaN
    if "tolerance" not in dataset.attrs:
        raise InputError("converged", None, LOST)
    tolerance = dataset.attrs["tolerance"]
    try:
        return dataset["mu_macro_error"] <= float(tolerance)
    except (TypeError, ValueError):
        allowed = f"{NEEDS} a number there, or the variable converged"
        raise InputError("tolerance", tolerance, allowed) from None


def poisson_within(ratios: np.ndarray, poisson: float | None) -> float:
    """Check a Poisson's ratio against the range of a map.

    Parameters
    ----------
    ratios : numpy.ndarray
        Poisson's ratios of the map, ascending.
    poisson : float, optional
        Requested Poisson's ratio.  None selects the only ratio of the map.
    """
    low, high = float(ratios[0]), float(ratios[-1])
    many = high > low
    allowed = f"allowed is {low:g}" + (f" to {high:g}" if many else ", the dataset's only one")
    if poisson is None and many:
        raise InputError("poisson", None, f"{allowed}: the dataset has more than one")
    if not (poisson is None or is_real(poisson)):
        raise InputError("poisson", poisson, f"{allowed}, one number")
    try:
        nu = low if poisson is None else float(poisson)
    except OverflowError:  # an integer of more than 308 digits
        nu = np.inf
    if not low - SAME <= nu <= high + SAME:
        raise InputError("poisson", poisson, f"{allowed}; microslip.solve computes any")
    return nu


def tables_at(nodes: xr.Dataset, poisson: float) -> tuple[Table | None, Table | None]:
    """Return the maps of velocities above 0 and of the velocity 0 at a Poisson's ratio.

    nodes: see `nodes_of`.  A map is None if it has no nodes.
    """
    amplitude, velocity = (np.asarray(nodes[axis], float) for axis in ("amplitude", "velocity"))
    values, errors = _values_at(nodes, poisson)

    def part(chosen: np.ndarray) -> Table | None:
        if not chosen.any():
            return None
        return Table(Axis(amplitude), Axis(velocity[chosen]), values[:, chosen], errors[:, chosen])

    return part(velocity > 0.0), part(velocity == 0.0)


def _values_at(nodes: xr.Dataset, poisson: float) -> tuple[np.ndarray, np.ndarray]:
    """Return values and errors at a Poisson's ratio, shape (amplitudes, velocities) each."""
    values, errors = (np.asarray(nodes[name], float) for name in ("mu_macro", "mu_macro_error"))
    ratios = np.asarray(nodes["poisson"], float)
    near = int(np.argmin(np.abs(ratios - poisson)))
    if abs(ratios[near] - poisson) <= SAME:
        return values[near], errors[near]
    axis = Axis(ratios)
    (cell,), (share,), (index,), (weights,) = axis.cubics(np.array([poisson]))
    misses = axis.misses(values.reshape(len(ratios), -1)).reshape(values.shape)
    # the largest miss at the nodes around the cell, as along the other axes
    around = misses[max(cell - 1, 0) : cell + 3].max(axis=0)
    error = 4.0 * share * (1.0 - share) * largest_around(around)
    return np.tensordot(weights, values[index], 1), errors[index].max(axis=0) + error
