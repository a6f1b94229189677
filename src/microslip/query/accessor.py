"""``dataset.friction.at(...)``: certified answers from the dataset of a sweep."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr

from microslip import hertz, theory
from microslip.scenes import scene_named
from microslip.stored import solve_stored

from . import beyond
from .interpolation import Axis, Table
from .within import refuse_beyond, within

SOURCES = (
    "map",
    "no vibration",
    "static limit",
    "between static limit and map",
    "between map and fast sliding",
    "between map and large amplitude",
    "between map and no vibration",
    "closed form",
    "solver",
)
"""Where an answer comes from, by its code in the variable `source`."""
(MAP, STILL, STATIC, SLOWER, FASTER, WIDER, NARROWER, EXACT, SOLVER) = range(len(SOURCES))


@xr.register_dataset_accessor("friction")
class Friction:
    """Friction at any point of a scene, from a dataset of one of its sweeps.

    Raises ValueError where the dataset is none of a sweep.
    """

    def __init__(self, dataset):
        try:
            self._motion = scene_named(dataset.attrs.get("scene"))
        except ValueError:
            raise ValueError(
                "no scene of microslip: allowed is the dataset of a sweep, with its attributes"
            ) from None
        self._dataset = dataset
        self._scene = self._motion.name
        self._pressure = dataset.attrs.get("pressure", "hertz")
        self._tables = {}  # by Poisson's ratio, each made when it is first asked

    def at(self, velocity, amplitude=None, *, poisson=None, tolerance=None):
        """Friction and a bound of its error, whatever the point.

        velocity >= 0, amplitude >= 0 (none for continuous-bore): numbers; sequences, each of which
        becomes a dimension of the answer; or DataArrays, which broadcast by their dimensions.
        poisson: one of the dataset's (its only one unless told).  tolerance: where the bound is
        larger, the solver is asked (results are kept beside the dataset if it came from
        `open_map`).  Returns a Dataset of mu_macro, mu_macro_error and source, an index into
        SOURCES with its meanings in flag_meanings.  Between the nodes of a map the error holds what
        interpolation leaves (see `interpolation`) and what the nodes themselves may be off; beyond
        the map see `beyond`.  Next to a point that did not converge mu_macro is NaN and its error
        infinite.  Raises ValueError, naming the argument, for what is no such number, and for what
        no limit is proved for: of other motions and pressures than the paper's, all beyond the map,
        unless there is a tolerance.
        """
        nu = self._one_poisson(poisson)
        velocity, amplitude = self._points(velocity, amplitude)
        flat_velocity = velocity.values.ravel().astype(float)
        flat_amplitude = np.full(len(flat_velocity), np.nan)
        if amplitude is not None:
            flat_amplitude = amplitude.values.ravel().astype(float)
        if not beyond.is_known(self._scene, self._pressure):
            answer = self._map_alone(flat_velocity, flat_amplitude, nu, tolerance)
        elif amplitude is None:
            answer = self._steady(flat_velocity, nu)
        else:
            answer = self._oscillating(flat_velocity, flat_amplitude, nu)
        value, error, source = answer
        if tolerance is not None:
            hertz.checked("tolerance", tolerance, low_open=True)
            point = flat_velocity, flat_amplitude
            self._solve((value, error, source), point, nu, tolerance)
        return self._answer(velocity, value, error, source)

    # The question

    def _one_poisson(self, poisson):
        known = np.atleast_1d(self._dataset["poisson"].values)
        if poisson is None and len(known) == 1:
            return float(known[0])
        if poisson is None or not np.isclose(known, poisson, rtol=0.0, atol=1e-12).any():
            raise ValueError(f"poisson = {poisson}: allowed is one of {known.tolist()}")
        return float(known[np.argmin(np.abs(known - poisson))])

    def _points(self, velocity, amplitude):
        if (amplitude is None) == self._motion.periodic:
            need = "none" if amplitude is not None else "a number"
            raise ValueError(f"amplitude = {amplitude}: allowed for {self._scene} is {need}")
        velocity = _labelled("velocity", velocity)
        if amplitude is None:
            return velocity, None
        # An outer product has the order of the datasets.
        amplitude, velocity = xr.broadcast(_labelled("amplitude", amplitude), velocity)
        return velocity, amplitude

    def _table(self, nu, still=False):
        """The map for one Poisson's ratio, above velocity 0 or of that alone (None: there is none).

        Nodes that did not converge are not known.
        """
        if (nu, still) not in self._tables:
            chosen = self._dataset[["mu_macro", "mu_macro_error", "converged"]]
            if "poisson" in chosen.dims:
                chosen = chosen.sel(poisson=nu, method="nearest")
            is_still = chosen["velocity"].values == 0
            chosen = chosen.isel(velocity=is_still if still else ~is_still).compute()
            if not chosen.sizes["velocity"]:
                return None
            dims = [dim for dim in ("amplitude", "velocity") if dim in chosen.dims]
            chosen = chosen.transpose(*dims).sortby(dims)
            good = chosen["converged"] == 1
            values, errors = (
                np.atleast_2d(chosen[name].where(good).values)
                for name in ("mu_macro", "mu_macro_error")
            )
            rows = chosen["amplitude"].values if "amplitude" in dims else np.zeros(1)
            self._tables[nu, still] = Table(
                Axis(rows), Axis(chosen["velocity"].values), values, errors
            )
        return self._tables[nu, still]

    # What no limit is known of

    def _map_alone(self, velocity, amplitude, nu, tolerance):
        rows = np.nan_to_num(amplitude)
        tables = self._table(nu), self._table(nu, still=True)
        if tolerance is None:
            what = self._scene if self._pressure == "hertz" else f"pressure {self._pressure}"
            refuse_beyond(*tables, velocity, rows, what)
        value, error = within(*tables, velocity, rows)
        return value, error, np.full(len(value), MAP)

    # Steady motion

    def _steady(self, velocity, nu):
        table = self._table(nu)
        inside = table.columns.holds(velocity)
        value, error = theory.bore_forward(velocity), np.full(velocity.shape, beyond.ROUNDING)
        value = np.array(value, float)
        value[inside], error[inside] = table.at(np.zeros(inside.sum()), velocity[inside])
        return value, error, np.where(inside, MAP, EXACT)

    # Oscillation

    def _oscillating(self, velocity, amplitude, nu):
        table, limits = self._table(nu), beyond.LIMITS[self._scene]
        slowest, fastest = table.columns.values[[0, -1]]
        narrowest, widest = table.rows.values[[0, -1]]
        if limits.static_needs_nu_0 and nu > 0.0 and (velocity < slowest).any():
            raise ValueError(
                f"velocity = {velocity.min():g}: allowed for nu = {nu:g} is {slowest:g} or more: "
                "the static limit is proved for nu = 0; microslip.solve computes it"
            )
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
        edge = (part[-1] for part in (table.values, table.errors))
        far = beyond.distances(limits, table.columns.values, *edge, below, widest)
        for where, code, rule, coordinates, end in (
            (amplitude < narrowest, NARROWER, beyond.narrower, (amplitude,), narrowest),
            (below < slowest, SLOWER, beyond.slower, (below, np.fmin(amplitude, widest)), slowest),
            (below > fastest, FASTER, beyond.faster, (below, np.fmin(amplitude, widest)), fastest),
            (wide, WIDER, beyond.wider, (far, velocity, amplitude), widest),
        ):
            if where.any():
                at = (part[where] for part in (value, error, *coordinates))
                value[where], error[where] = rule(limits, *at, end)
                source[where] = code
        value, error = beyond.within_the_balance(limits, value, error, velocity, amplitude)
        for where, code, known in (
            (velocity == 0.0, STATIC, limits.static(amplitude)),
            (amplitude == 0.0, STILL, np.ones_like(value)),
        ):
            value[where], error[where], source[where] = known[where], beyond.ROUNDING, code
        return value, error, source

    # The solver

    def _solve(self, answer, point, nu, tolerance):
        """Replace what is not good enough by what the solver says."""
        value, error, source = answer
        path = self._dataset.encoding.get("source")
        settings = {"poisson": nu, "tolerance": tolerance, "pressure": self._pressure}
        settings["results"] = str(Path(path).parent) if path else "results"
        for k in np.flatnonzero(~(error <= tolerance)):
            velocity, amplitude = (float(part[k]) for part in point)
            size = None if np.isnan(amplitude) else amplitude
            found = solve_stored(self._scene, velocity, size, **settings)
            source[k] = SOLVER
            value[k], error[k] = np.nan, np.inf
            if found.converged:
                value[k], error[k] = found.mu_macro, found.mu_macro_error

    # The answer

    def _answer(self, shape, value, error, source):
        def variable(values, long_name, **more):
            attributes = {"long_name": long_name} | more
            return shape.dims, values.reshape(shape.shape), attributes

        return xr.Dataset(
            {
                "mu_macro": variable(value, "mean forward friction force over mu F_z", units="1"),
                "mu_macro_error": variable(error, "bound of its error", units="1"),
                "source": variable(
                    source.astype(np.int8),
                    "where the answer comes from",
                    flag_values=np.arange(len(SOURCES), dtype=np.int8),
                    flag_meanings=" ".join(name.replace(" ", "_") for name in SOURCES),
                ),
            },
            coords=shape.coords,
            attrs={"scene": self._scene},
        )


def _labelled(name, given):
    """A DataArray of numbers >= 0; sequences get a dimension of their name."""
    try:
        array = given if isinstance(given, xr.DataArray) else np.asarray(given, float)
        hertz.checked(name, np.asarray(array, float))
    except (TypeError, ValueError) as error:
        if str(error).startswith(name):
            raise
        raise ValueError(f"{name} = {given!r}: allowed is a number >= 0") from None
    if isinstance(array, xr.DataArray):
        return array
    if array.ndim > 1:
        raise ValueError(f"{name}: allowed are {array.ndim} dimensions only with names (DataArray)")
    return xr.DataArray(
        array, dims=(name,) * array.ndim, coords={name: array} if array.ndim else {}
    )
