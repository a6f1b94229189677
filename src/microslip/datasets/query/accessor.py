"""`dataset.microslip.at(...)`: certified answers from the dataset of a sweep."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import xarray as xr

from microslip.datasets import certified_map
from microslip.datasets.query import beyond, cells, lazily
from microslip.datasets.query.answers import (
    EXACT,
    FASTER,
    MAP,
    NARROWER,
    OUTSIDE,
    SLOWER,
    SOLVER,
    STATIC,
    STILL,
    WIDER,
    answered,
)
from microslip.datasets.query.cells import CellNodes, Map
from microslip.datasets.query.coordinates import grid_axes, labelled
from microslip.datasets.query.drift import Drift
from microslip.datasets.query.inverse import Inverse
from microslip.datasets.query.nodes import Nodes, nodes_of, poisson_within, refuse_negative
from microslip.datasets.query.solver import pulled_by, solved
from microslip.foundation.arguments import real
from microslip.foundation.errors import InputError
from microslip.motions.by_name import motion_named
from microslip.theory.catalogue import FORMS

Answer = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Friction, its error and codes of SOURCES, shape (n,) each."""


def accessor(dataset: xr.Dataset) -> Friction | Drift:
    """The accessor `dataset.microslip`: Drift for certified maps over forces, else Friction."""
    return Drift(dataset) if certified_map.is_of_drift(dataset) else Friction(dataset)


class Friction(Inverse):
    """Friction at any point of a motion, from a dataset of one of its sweeps.

    Raises ValueError where the dataset is none of a sweep.
    """

    def __init__(self, dataset: xr.Dataset):
        try:
            motion = motion_named(dataset.attrs.get("motion"))
        except ValueError:
            raise ValueError(
                "no motion of microslip: allowed is the dataset of a sweep, with its attributes"
            ) from None
        if "force" in dataset.attrs.get("drive", ""):
            raise ValueError(
                "the contact of this dataset is pulled by a force, which is friction itself: "
                "allowed is one that is moved at a velocity or by a spring; here microslip.at of a "
                "certified map, and sel and interp"
            )
        self._dataset = dataset
        # Not the motion itself: it holds functions without a name, which cannot be pickled.
        self._motion, self._periodic = motion.name, motion.periodic
        self._pressure = dataset.attrs.get("pressure", "hertz")
        self._limits_known = beyond.known_of(dataset)
        self._known: tuple[tuple, Nodes | CellNodes] | None = None
        self._tables: dict[tuple[float, bool], Map | None] = {}

    def at(
        self,
        velocity: object,
        amplitude: object = None,
        *,
        poisson: float | None = None,
        tolerance: float | None = None,
    ) -> xr.Dataset:
        """Friction and a bound of its error, whatever the point.

        Between the nodes of a map the error holds what interpolation leaves (see `interpolation`,
        between Poisson's ratios `nodes`) and what the nodes themselves may be off; that of a
        certified map is the bound of its cell (see `cells`).  Beyond the map see `beyond`.  Next to
        a point that did not converge mu_macro is NaN, or its error infinite.

        The dataset may be a part of one, chosen or joined by xarray, lazy or not, as long as it has
        mu_macro, mu_macro_error, their coordinates and its attributes.  Without `converged`, nodes
        with an error above the attribute `tolerance` count as not converged.

        Parameters
        ----------
        velocity, amplitude : number, sequence or DataArray
            >= 0, no amplitude for continuous-bore.  A sequence becomes a dimension of the answer;
            DataArrays broadcast by their dimensions.  Where one is in chunks of dask, so is the
            answer, and what is asked is looked at when it is computed.
        poisson : number, optional
            Within the range of the dataset's; its only one unless told.
        tolerance : number, optional
            Where the bound is larger, the solver is asked.  Results are kept beside the dataset if
            it came from `open_map`; where nothing can be written, for as long as Python runs.

        Returns
        -------
        xarray.Dataset
            mu_macro, mu_macro_error and source, an index into SOURCES with its meanings in
            flag_meanings.  The attribute `note` counts the points outside the tabulated range whose
            error estimate is larger than that of the map, and names the remedy, `tolerance`.

        Raises
        ------
        InputError
            Naming the argument, for what is no such number, for what the dataset has lost, and for
            what no limit is proved for: of other motions and pressures than the paper's, all beyond
            the map, unless there is a tolerance.
        """
        if lazily.is_lazy(velocity, amplitude):
            settings = {"poisson": poisson, "tolerance": tolerance}
            velocities, amplitudes = self._labelled(velocity, amplitude)
            asked = {"amplitude": amplitudes, "velocity": velocities}
            return lazily.answered(self.at, self._dataset, asked, **settings)
        nodes = self._nodes(poisson)
        nu = poisson_within(nodes.poisson, poisson)
        velocities, amplitudes = self._points(velocity, amplitude)
        flat_velocity = velocities.values.ravel().astype(float)
        flat_amplitude = np.full(len(flat_velocity), np.nan)
        if amplitudes is not None:
            flat_amplitude = amplitudes.values.ravel().astype(float)
        if not self._limits_known or cells.is_static(self._dataset):
            answer = self._map_alone(nodes, flat_velocity, flat_amplitude, nu, tolerance)
        elif (table := self._table(nodes, nu)) is None:
            raise InputError("velocity", 0.0, "microslip.at needs nodes above 0 in the dataset")
        elif amplitudes is None:
            answer = self._steady(table, flat_velocity)
        else:
            answer = self._oscillating(table, flat_velocity, flat_amplitude, nu)
        value, error, source = answer
        error[np.isnan(value) | np.isnan(error)] = np.inf
        if tolerance is not None:
            tolerance = real("tolerance", tolerance, 0.0)
            if tolerance == 0.0:
                raise InputError("tolerance", tolerance, "allowed is a number above 0")
            point = flat_velocity, flat_amplitude
            self._solve((value, error, source), point, nu, tolerance)
        found = answered(self._motion, velocities, (value, error, source), nu)
        return found.assign_attrs(self._note(error, source))

    def on_grid(
        self, velocity: object = 49, amplitude: object = 49, **settings: float | None
    ) -> xr.Dataset:
        """Friction and a bound of its error on a regular grid, for figures and plain xarray.

        Parameters
        ----------
        velocity, amplitude : int or sequence
            How many of them, over the range of the map, velocities in equal ratios and amplitudes
            in equal steps; or which ones.  No amplitude counts for continuous-bore, and no velocity
            for a certified map of the static limit.
        **settings
            poisson and tolerance, as for `at`.

        Returns
        -------
        xarray.Dataset
            As `at` gives it, dims (amplitude, velocity).

        Raises
        ------
        InputError
            As `at` does, and for less than two of them.
        """
        wanted = {"velocity": [0.0] if cells.is_static(self._dataset) else velocity}
        if self._periodic:
            wanted["amplitude"] = amplitude
        return self.at(**grid_axes(self._dataset, wanted), **settings)

    # The question

    def _points(
        self, velocity: object, amplitude: object
    ) -> tuple[xr.DataArray, xr.DataArray | None]:
        velocities, amplitudes = self._labelled(velocity, amplitude)
        if amplitudes is None:
            return velocities, None
        # An outer product has the order of the datasets.
        amplitudes, velocities = xr.broadcast(amplitudes, velocities)
        return velocities, amplitudes

    def _labelled(
        self, velocity: object, amplitude: object
    ) -> tuple[xr.DataArray, xr.DataArray | None]:
        if (amplitude is None) == self._periodic:
            need = "none" if amplitude is not None else "a number"
            raise InputError("amplitude", amplitude, f"allowed for {self._motion} is {need}")
        velocities = labelled("velocity", velocity)
        return velocities, None if amplitude is None else labelled("amplitude", amplitude)

    def _nodes(self, poisson: float | None) -> Nodes | CellNodes:
        """The points of the map, read once for as long as the dataset stays the same.

        Reading them takes ten times as long as interpolating, and a dataset may be changed in
        place, so the digest of all data is compared.
        """
        digest = (_digest(self._dataset), poisson)
        if digest[0] is None or self._known is None or self._known[0] != digest:
            nodes: Nodes | CellNodes
            if cells.is_certified(self._dataset):
                nodes = cells.cells_of(self._dataset)
            else:
                nodes = nodes_of(self._dataset, periodic=self._periodic, poisson=poisson)
            if self._limits_known:
                refuse_negative(nodes)
            self._known, self._tables = (digest, nodes), {}
        return self._known[1]

    def _table(self, nodes: Nodes | CellNodes, nu: float, still: bool = False) -> Map | None:
        """The map for one Poisson's ratio, see Nodes.table."""
        if (nu, still) not in self._tables:
            self._tables[nu, still] = nodes.table(nu, still=still)
        return self._tables[nu, still]

    # Motions without known limits

    def _map_alone(
        self,
        nodes: Nodes | CellNodes,
        velocity: np.ndarray,
        amplitude: np.ndarray,
        nu: float,
        tolerance: float | None,
    ) -> Answer:
        """The map alone: NaN and an infinite error outside of it, or InputError."""
        value, error = np.full(len(velocity), np.nan), np.full(len(velocity), np.inf)
        rows, outside = np.nan_to_num(amplitude), np.ones(len(velocity), bool)
        table, still = self._table(nodes, nu), self._table(nodes, nu, still=True)
        for part, chosen in ((table, velocity > 0.0), (still, velocity == 0.0)):
            if part is not None:
                held = chosen & part.rows.holds(rows) & part.columns.holds(velocity)
                value[held], error[held] = part.at(rows[held], velocity[held])
                outside &= ~held
        if tolerance is None and outside.any():
            first = int(np.flatnonzero(outside)[0])
            part = still if velocity[first] == 0.0 else table
            self._refuse_outside(part, velocity[first], rows[first])
        return value, error, np.full(len(value), MAP)

    def _refuse_outside(self, part: Map | None, velocity: float, amplitude: float) -> None:
        what = self._motion if self._pressure == "hertz" else f"pressure {self._pressure}"
        if not beyond.is_alone(self._dataset):
            what = f"{what} under a spring or of several contacts"
        advice = f"no limit of {what} is known: with a tolerance the solver is asked"
        if part is None:
            raise ValueError(f"velocity = {velocity:g}: the map has none such; {advice}")
        axes = (("velocity", part.columns, velocity), ("amplitude", part.rows, amplitude))
        for name, axis, given in axes:
            if not axis.holds(np.array(given)):
                low, high = axis.values[[0, -1]]
                raise ValueError(f"{name} = {given:g}: allowed is {low:g} to {high:g}; {advice}")

    def _note(self, error: np.ndarray, source: np.ndarray) -> dict[str, str]:
        """{"note": text} where points outside the tabulated range have a larger error estimate."""
        about = self._dataset.attrs
        try:
            usual = float(about.get("error", about.get("tolerance", 0.0)))
        except (TypeError, ValueError):
            usual = 0.0
        wide = np.isin(source, OUTSIDE) & (error > max(usual, beyond.ROUNDING))
        if not wide.any():
            return {}
        count = f"{wide.sum()} of {len(wide)} points" if len(wide) > 1 else "the point"
        return {
            "note": f"{count} outside the tabulated range, error estimate up to "
            f"{error[wide].max():.2g}: microslip.at(..., tolerance=1e-3) computes them"
        }

    # Steady motion

    def _steady(self, table: Map, velocity: np.ndarray) -> Answer:
        inside = table.columns.holds(velocity)
        exact = FORMS[self._motion]["mu_forward_theory"].function
        value, error = np.array(exact(velocity), float), np.full(len(velocity), beyond.ROUNDING)
        value[inside], error[inside] = table.at(np.zeros(inside.sum()), velocity[inside])
        return value, error, np.where(inside, MAP, EXACT)

    # Oscillation

    def _oscillating(
        self, table: Map, velocity: np.ndarray, amplitude: np.ndarray, nu: float
    ) -> Answer:
        limits = beyond.LIMITS[self._motion]
        slowest, fastest = table.columns.values[[0, -1]]
        narrowest, widest = table.rows.values[[0, -1]]
        # Outward from the nearest point on the edge of the map; above it, first down to where the
        # limit for large amplitudes is the same.
        wide = amplitude > widest
        below = np.where(
            wide, limits.same_limit(velocity, np.fmax(amplitude, widest), widest), velocity
        )
        value, error = table.at(
            np.clip(amplitude, narrowest, widest), np.clip(below, slowest, fastest)
        )
        source = np.full(len(value), MAP)
        last = table.values[-1], table.errors[-1]
        held, ratio = np.fmin(amplitude, widest), np.full_like(value, nu)
        far = np.zeros_like(value)
        far[wide] = beyond.distances(limits, table.columns.values, *last, below[wide], widest)
        rules: tuple[tuple[np.ndarray, int, Callable, tuple, float], ...] = (
            (amplitude < narrowest, NARROWER, beyond.narrower, (amplitude,), narrowest),
            (below < slowest, SLOWER, beyond.slower, (below, held, ratio), slowest),
            (below > fastest, FASTER, beyond.faster, (below, held), fastest),
            (wide, WIDER, beyond.wider, (far, velocity, amplitude), widest),
        )
        for where, code, rule, coordinates, end in rules:
            if where.any():
                edge = beyond.Estimate(value[where], error[where])
                at = (part[where] for part in coordinates)
                value[where], error[where] = rule(limits, edge, *at, end)
                source[where] = code
        value, error = beyond.within_the_balance(limits, value, error, velocity, amplitude)
        slow = velocity == 0.0
        if slow.any():
            value[slow], error[slow] = limits.static(amplitude[slow], nu)
            source[slow] = STATIC
        still = amplitude == 0.0
        value[still], error[still], source[still] = 1.0, beyond.ROUNDING, STILL
        return value, error, source

    # The solver

    def _solve(
        self, answer: Answer, point: tuple[np.ndarray, ...], nu: float, tolerance: float
    ) -> None:
        """Replace what is not good enough by what the solver says."""
        value, error, source = answer
        path = self._dataset.encoding.get("source")
        settings = {"poisson": nu, "tolerance": tolerance, "pressure": self._pressure}
        settings |= pulled_by(self._dataset)
        folder = str(Path(path).parent) if path else "results"
        for k in np.flatnonzero(~(error <= tolerance)):
            velocity, amplitude = (float(part[k]) for part in point)
            size = None if np.isnan(amplitude) else amplitude
            found = solved(folder, self._motion, velocity, size, **settings)
            source[k] = SOLVER
            value[k], error[k] = np.nan, np.inf
            if found.converged:
                value[k], error[k] = found.mu_macro, found.mu_macro_error


READ = ("mu_macro", "mu_macro_error", "converged", "velocity", "amplitude", "poisson")
"""Variables that a map of nodes is made of; those of a certified map begin with "cell_"."""


def _digest(dataset: xr.Dataset) -> bytes | None:
    """Digest of what a map is made of; None if its numbers are not in memory."""
    found = hashlib.sha256(repr(sorted(dataset.attrs.items())).encode())
    for name, variable in dataset.variables.items():
        if name in READ or str(name).startswith("cell_"):
            if variable.chunks:
                return None
            found.update(f"|{name} {variable.dims} {variable.dtype} {variable.shape}|".encode())
            found.update(variable.values.tobytes())
    return found.digest()
