"""The accessor `dataset.microslip`.  It returns friction at any velocity and amplitude, with an
error bound."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np
import xarray as xr

from microslip.adaptive.point import solve
from microslip.datasets.catalogue import FORMS
from microslip.datasets.query import beyond, cells, inverse
from microslip.datasets.query.answers import (
    EXACT,
    FASTER,
    FRICTION,
    MAP,
    NARROWER,
    OUTSIDE,
    SLOWER,
    SOLVER,
    STATIC,
    STILL,
    WIDER,
    dataset_of,
)
from microslip.datasets.query.cells import Map
from microslip.datasets.query.coordinates import coordinate_array, evaluate, grid_axes
from microslip.datasets.query.nodes import nodes_of, poisson_within, refuse_values, tables_at
from microslip.datasets.query.solver import drive_of
from microslip.datasets.variables import variable
from microslip.foundation.arguments import real
from microslip.foundation.errors import InputError
from microslip.foundation.named_files import speaks_of_file
from microslip.motions.by_name import motion_named

Answer = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Friction, its error bound, and its source (an index into SOURCES), shape (n,) each."""


class Maps(NamedTuple):
    """Maps of a dataset at one Poisson's ratio.

    Attributes
    ----------
    poisson : float
        Poisson's ratio.
    moving, still : Table, CellTable or None
        Friction at velocities above 0, and at the velocity 0; None if the dataset has no such map.
    """

    poisson: float
    moving: Map | None
    still: Map | None


class Friction:
    """Friction at any velocity and amplitude of a motion, from the dataset of a sweep.

    Raises ValueError if the dataset does not come from a sweep.
    """

    def __init__(self, dataset: xr.Dataset):
        name, periodic = dataset.attrs.get("motion"), True
        if not speaks_of_file(name):  # the motion's file need not exist here
            try:
                motion = motion_named(name)
            except ValueError:
                raise ValueError(
                    "no motion of microslip in the attributes: allowed is the dataset of a sweep"
                ) from None
            name, periodic = motion.name, motion.periodic
        if "force" in dataset.attrs.get("drive", ""):
            raise ValueError(
                "a dataset over a prescribed force has no friction map: allowed is one over a "
                "velocity or a spring; use microslip.at of a certified map, sel or interp"
            )
        self._dataset = dataset
        # Only the name of the motion is stored, because the motion contains lambdas, which cannot
        # be pickled.
        self._motion, self._periodic = name, periodic
        self._pressure = dataset.attrs.get("pressure", "hertz")
        self._has_limits = beyond.has_limits(dataset)
        self._read: tuple[tuple, Maps] | None = None

    def at(
        self,
        velocity: object,
        amplitude: object = None,
        *,
        poisson: float | None = None,
        tolerance: float | None = None,
    ) -> xr.Dataset:
        """Friction and its error bound at any point.

        Between the nodes of a map, the error bound is the sum of the interpolation error and the
        node errors.  See `interpolation` and, for interpolation between Poisson's ratios, `nodes`.
        In a certified map, each cell has its own error bound (see `cells`).  Outside the tabulated
        range, the error bound is the distance to the farther end of a bracket (see `beyond`).  Next
        to a point that did not converge, mu_macro is NaN or its error bound is infinite.

        The dataset can be a selection or a join of datasets, in memory or in dask chunks.  It must
        have mu_macro, mu_macro_error, their coordinates and the attributes.  If there is no
        variable `converged`, nodes with an error above the attribute `tolerance` count as not
        converged.

        Parameters
        ----------
        velocity, amplitude : number, sequence or DataArray
            Dimensionless velocity and amplitude, at least 0.  continuous-bore has no amplitude.  A
            sequence becomes a dimension of the result; DataArrays broadcast by their dimensions.
            If an argument is in dask chunks, so is the result; the argument is then checked when
            the result is computed.
        poisson : number, optional
            Poisson's ratio, within the range of the dataset.  It can be omitted if the dataset has
            only one Poisson's ratio.
        tolerance : number, optional
            Points with a larger error bound are computed by the solver.

        Returns
        -------
        xarray.Dataset
            Variables mu_macro, mu_macro_error and source.  `source` is an index into SOURCES,
            listed in the attribute flag_meanings.  If points outside the tabulated range have a
            larger error bound than the map, the attribute `note` gives their number and recommends
            a `tolerance`.

        Raises
        ------
        InputError
            If an argument is invalid, or if the dataset lacks a variable.  The message names the
            argument or the variable.
        ValueError
            If a point is outside the tabulated range, no tolerance is given, and no limits are
            proved for the motion, the pressure or the drive.
        """
        coordinates = self._coordinates(velocity, amplitude)
        maps = self._maps(poisson)
        if tolerance is not None:
            tolerance = real("tolerance", tolerance, 0.0)
            if tolerance == 0.0:
                raise InputError("tolerance", tolerance, "allowed is a number above 0")
        function = partial(self._friction, maps, tolerance)
        parts = evaluate(function, coordinates, (float, float, np.int8))
        poisson_ratio = variable((), maps.poisson, "Poisson's ratio")
        answer = dataset_of(parts, FRICTION, self._motion, poisson_ratio)
        if answer.chunks:
            return answer
        _, error, source = (part.values for part in parts)
        return answer.assign_attrs(self._note(error, source))

    def on_grid(
        self, velocity: object = 49, amplitude: object = 49, **settings: float | None
    ) -> xr.Dataset:
        """Friction and its error bound on a regular grid.

        Parameters
        ----------
        velocity, amplitude : int or sequence
            Number of coordinates over the range of the map, or the coordinates themselves.  From a
            number, velocities are logarithmically spaced and amplitudes are evenly spaced.  The
            amplitude is ignored for continuous-bore.  The velocity is ignored for a certified map
            of the static limit.
        **settings
            Arguments `poisson` and `tolerance` of `at`.

        Returns
        -------
        xarray.Dataset
            Result of `at` with the dimensions (amplitude, velocity).

        Raises
        ------
        InputError
            If a number of coordinates is below 2, or if `at` raises InputError.
        """
        axes = {"velocity": [0.0] if cells.is_static(self._dataset) else velocity}
        if self._periodic:
            axes["amplitude"] = amplitude
        return self.at(**grid_axes(self._dataset, axes), **settings)

    def solve_for(
        self,
        wanted: object,
        *,
        velocity: object = None,
        amplitude: object = None,
        poisson: float | None = None,
        within: tuple[float, float] | None = None,
    ) -> xr.Dataset:
        """Find the amplitude or the velocity at which friction has a requested value.

        Parameters
        ----------
        wanted : number, sequence or DataArray
            Value of mu_macro, at least 0.  A sequence becomes the dimension `wanted`.
        velocity, amplitude : number, sequence or DataArray
            The fixed coordinate.  The other coordinate is searched.  continuous-bore has no
            amplitude; omit both arguments to search its velocity.
        poisson : number, optional
            Poisson's ratio, see `at`.
        within : two numbers, optional
            Ends of the searched range.  Defaults to the range of the dataset.

        Returns
        -------
        xarray.Dataset
            The dimension `root` counts the intervals in which friction equals the requested value
            to within the error of friction.  The ends of the intervals are variables named after
            the searched coordinate, with the suffixes `_low` and `_high`.  The variable without a
            suffix is the coordinate at which the map has exactly the requested value, or NaN if the
            interval has no such coordinate.  `bounded` is True if both ends are inside the searched
            range.  `outcome` is an index into OUTCOMES, without the dimension `root`.

        Raises
        ------
        InputError
            If both or neither of velocity and amplitude are given, or if `at` raises InputError.
        """
        others = {"velocity": velocity, "amplitude": amplitude}
        others = {name: value for name, value in others.items() if value is not None}
        if len(others) != (1 if self._periodic else 0):
            allowed = "one of velocity and amplitude, and the other one is searched"
            allowed = allowed if self._periodic else "none, and the velocity is searched"
            raise InputError("solve_for", sorted(others), f"allowed is {allowed}")
        name = "velocity" if "velocity" not in others else "amplitude"
        ends = inverse.ends_of(self._dataset, name, within)
        maps = self._maps(poisson)

        def at(place: np.ndarray, other: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            points = {name: place} | dict.fromkeys(others, other)
            value, error, _ = self._friction(maps, None, **points)
            return value, error

        parts = [coordinate_array("wanted", wanted)]
        parts += [coordinate_array(name, value) for name, value in others.items()]
        parts = xr.broadcast(*parts)
        values, other = (part.values.ravel().astype(float) for part in (parts[0], parts[-1]))
        intervals, outcome = inverse.search(at, values, other, ends)
        return inverse.answer(name, parts[0], intervals, outcome, self._motion)

    # The map

    def _coordinates(self, velocity: object, amplitude: object) -> dict[str, xr.DataArray]:
        """Return labelled coordinates.  The amplitude is the first coordinate, as in the
        datasets."""
        if (amplitude is None) == self._periodic:
            need = "none" if amplitude is not None else "a number"
            raise InputError("amplitude", amplitude, f"allowed for {self._motion} is {need}")
        coordinates = {"velocity": coordinate_array("velocity", velocity)}
        if amplitude is None:
            return coordinates
        return {"amplitude": coordinate_array("amplitude", amplitude)} | coordinates

    def _friction(
        self,
        maps: Maps,
        tolerance: float | None,
        velocity: np.ndarray,
        amplitude: np.ndarray | None = None,
    ) -> Answer:
        """Return friction at n points from the map, the limits or the solver."""
        steady = amplitude is None
        if amplitude is None:
            amplitude = np.full(len(velocity), np.nan)
        if not self._has_limits or cells.is_static(self._dataset):
            answer = self._map_alone(maps, velocity, amplitude, tolerance)
        elif maps.moving is None:
            raise InputError("velocity", 0.0, "microslip.at needs nodes above 0 in the dataset")
        elif steady:
            answer = self._steady(maps.moving, velocity)
        else:
            answer = self._oscillating(maps.moving, velocity, amplitude, maps.poisson)
        value, error, source = answer
        error[np.isnan(value) | np.isnan(error)] = np.inf
        if tolerance is not None:
            self._solve(answer, (velocity, amplitude), maps.poisson, tolerance)
        return value, error, source

    def _maps(self, poisson: float | None) -> Maps:
        """Return the maps at a Poisson's ratio.  They are read again only if the dataset has
        changed.

        Reading takes ten times as long as interpolating.  A dataset can be changed in place, so
        changes are detected by a digest of all data.
        """
        digest, least = (_digest(self._dataset), poisson), 0.0 if self._has_limits else -1.0
        if digest[0] is None or self._read is None or self._read[0] != digest:
            if cells.is_certified(self._dataset):
                table = cells.cells_of(self._dataset)
                refuse_values(self._dataset, least)
                nu = poisson_within(table.ratios, poisson)
                table = replace(table, poisson=nu)
                maps = Maps(nu, None, table) if table.is_static else Maps(nu, table, None)
            else:
                nodes = nodes_of(self._dataset, periodic=self._periodic, poisson=poisson)
                refuse_values(nodes, least)
                nu = poisson_within(nodes["poisson"].values, poisson)
                maps = Maps(nu, *tables_at(nodes, nu))
            self._read = digest, maps
        return self._read[1]

    # Motions without known limits

    def _map_alone(
        self,
        maps: Maps,
        velocity: np.ndarray,
        amplitude: np.ndarray,
        tolerance: float | None,
    ) -> Answer:
        """Return friction from the map alone.

        If there is a tolerance, a point outside the map has the value NaN and an infinite error.
        Otherwise such a point raises ValueError.
        """
        value, error = np.full(len(velocity), np.nan), np.full(len(velocity), np.inf)
        rows, outside = np.nan_to_num(amplitude), np.ones(len(velocity), bool)
        for part, chosen in ((maps.moving, velocity > 0.0), (maps.still, velocity == 0.0)):
            if part is not None:
                inside = chosen & part.rows.holds(rows) & part.columns.holds(velocity)
                value[inside], error[inside] = part.at(rows[inside], velocity[inside])
                outside &= ~inside
        if tolerance is None and outside.any():
            first = int(np.flatnonzero(outside)[0])
            part = maps.still if velocity[first] == 0.0 else maps.moving
            self._refuse_outside(part, velocity[first], rows[first])
        return value, error, np.full(len(value), MAP)

    def _refuse_outside(self, part: Map | None, velocity: float, amplitude: float) -> None:
        case = self._motion if self._pressure == "hertz" else f"pressure {self._pressure}"
        if not beyond.is_alone(self._dataset):
            case = f"{case} under a spring"
        advice = f"no limit of {case} is known: with a tolerance the solver is asked"
        if part is None:
            raise ValueError(f"velocity = {velocity:g}: the map has none such; {advice}")
        axes = (("velocity", part.columns, velocity), ("amplitude", part.rows, amplitude))
        for name, axis, value in axes:
            if not axis.holds(np.array(value)):
                low, high = axis.values[[0, -1]]
                raise ValueError(f"{name} = {value:g}: allowed is {low:g} to {high:g}; {advice}")

    def _note(self, error: np.ndarray, source: np.ndarray) -> dict[str, str]:
        """Return {"note": text} if points outside the tabulated range have larger error bounds than
        the map, else {}."""
        about = self._dataset.attrs
        try:
            usual = float(about.get("error", about.get("tolerance", 0.0)))
        except (TypeError, ValueError):
            usual = 0.0
        wide = np.isin(source, OUTSIDE) & (error > max(usual, beyond.ROUNDING))
        if not wide.any():
            return {}
        count = f"{wide.sum()} of {wide.size} points" if wide.size > 1 else "the point"
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
        # Friction outside the map is estimated from the nearest point on the edge of the map. For
        # amplitudes above the map, this is the point on the edge that has the same limit for large
        # amplitudes.
        wide = amplitude > widest
        below = np.where(
            wide, limits.same_limit(velocity, np.fmax(amplitude, widest), widest), velocity
        )
        value, error = table.at(
            np.clip(amplitude, narrowest, widest), np.clip(below, slowest, fastest)
        )
        source = np.full(len(value), MAP)
        row, ratio = np.fmin(amplitude, widest), np.full_like(value, nu)
        far = np.zeros_like(value)
        edge = table.columns.values, *table.last_row
        far[wide] = beyond.distances(limits, *edge, below[wide], widest)
        rules: tuple[tuple[np.ndarray, int, Callable, tuple, float], ...] = (
            (amplitude < narrowest, NARROWER, beyond.narrower, (amplitude,), narrowest),
            (below < slowest, SLOWER, beyond.slower, (below, row, ratio), slowest),
            (below > fastest, FASTER, beyond.faster, (below, row), fastest),
            (wide, WIDER, beyond.wider, (far, velocity, amplitude), widest),
        )
        for where, code, rule, coordinates, end in rules:
            if where.any():
                near = beyond.Estimate(value[where], error[where])
                at = (part[where] for part in coordinates)
                value[where], error[where] = rule(limits, near, *at, end)
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
        """Replace results with an error above the tolerance by the solver's results, in place."""
        value, error, source = answer
        settings = {"poisson": nu, "tolerance": tolerance, "pressure": self._pressure}
        settings |= drive_of(self._dataset)
        for k in np.flatnonzero(~(error <= tolerance)):
            velocity, amplitude = (float(part[k]) for part in point)
            size = None if np.isnan(amplitude) else amplitude
            result = solve(self._motion, velocity, size, **settings)
            source[k] = SOLVER
            value[k], error[k] = np.nan, np.inf
            if result.converged:
                value[k], error[k] = result.mu_macro, result.mu_macro_error


READ = ("mu_macro", "mu_macro_error", "converged", "velocity", "amplitude", "poisson")
"""Variables that are included in the digest of a map, besides variables that begin with "cell_"."""


def _digest(dataset: xr.Dataset) -> bytes | None:
    """Return a digest of a map's attributes and variables, or None for dask chunks."""
    digest = hashlib.sha256(repr(sorted(dataset.attrs.items())).encode())
    for name, part in dataset.variables.items():
        if name in READ or str(name).startswith("cell_"):
            if part.chunks:
                return None
            digest.update(f"|{name} {part.dims} {part.dtype} {part.shape}|".encode())
            digest.update(part.values.tobytes())
    return digest.digest()
