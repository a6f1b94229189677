"""Response of a contact to a prescribed path: forces at every row, with their errors.

The path need not be periodic.  It begins in full slip, without tangential tractions, or at the end
of another response.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any

import numpy as np

from microslip.adaptive.choice import choose_model
from microslip.adaptive.history import STARTS, tractions_at_start
from microslip.adaptive.period import ON_BOUND
from microslip.contact.contact import Contact, March
from microslip.contact.coulomb import project
from microslip.contact.path import LONG_STROKE, Path, make_path
from microslip.estimate.ladder import LOAD, ladder_for
from microslip.estimate.refine import READING_SAFETY, SMALLEST_SHARE
from microslip.estimate.richardson import WEIGHTS, extrapolate
from microslip.foundation.arguments import SMALLEST_TOLERANCE, real
from microslip.foundation.errors import InputError
from microslip.motions.problem import Problem
from microslip.motions.samples import SampledPath
from microslip.pressures.by_name import pressure_named
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Pressure
from microslip.solver.discretise import contact_of
from microslip.solver.snapshots import bounds_at_phases

Progress = Callable[[int, int], None]
STEP_SHARE = 0.05
"""Largest sum of the step residuals in a march, divided by the tolerance; see refine.RUN_SHARE."""
MOST_VALUES = 2e7
"""Largest number of tractions in memory at the same time.  Longer paths are marched in pieces."""
STEPS = LOAD.steps / 2.0
"""Number of time steps for a path of length u_lim, divided by the level.  For a stroke of u_lim,
half a period is 2 u_lim long and has as many steps as in LOAD, the ladder for oscillating loads."""


@dataclass(frozen=True, eq=False)
class Response:
    """Dimensionless forces at the rows of a path.

    Attributes
    ----------
    force_forward, force_lateral : np.ndarray, shape (rows,)
        Forces divided by mu F_z of the reference load, positive in the direction of the
        displacement that they resist.
    torque : np.ndarray, shape (rows,)
        Torque divided by its value at full slip under the reference load.
    force_error : np.ndarray, shape (rows, 3)
        Estimated errors of the forward force, the lateral force and the torque, with that of the
        resolution of a pressure on a grid.
    dissipated_energy, dissipated_energy_error : np.ndarray, shape (rows,)
        Energy dissipated by friction since the first row and its estimated error, both divided by
        mu F_z u_lim.
    stick_fraction : np.ndarray, shape (rows,)
        Fraction of the contact area that sticks in the last step before the row.  It is NaN in the
        first row and without contact.  Its resolution is limited by the mesh.
    tolerance : float
        Requested largest force error.
    converged : bool
        Whether every force error is within the tolerance.
    reason : str
        Reason why the response is not converged, otherwise empty.
    model : str
        Name of the model.
    cells, angles : int
        Resolution of the finest march.
    """

    force_forward: np.ndarray
    force_lateral: np.ndarray
    torque: np.ndarray
    force_error: np.ndarray
    dissipated_energy: np.ndarray
    dissipated_energy_error: np.ndarray
    stick_fraction: np.ndarray
    tolerance: float
    converged: bool
    reason: str
    model: str
    cells: int
    angles: int
    problem: Problem = field(repr=False)
    start: str = field(repr=False)

    @property
    def columns(self) -> dict[str, tuple[str, np.ndarray]]:
        """Unit and values of every column, by name.

        The column `force_error` is the larger error of the two force components.
        """
        columns = {
            "force_forward": self.force_forward,
            "force_lateral": self.force_lateral,
            "torque": self.torque,
            "force_error": self.force_error[:, :2].max(axis=1),
            "torque_error": self.force_error[:, 2],
            "dissipated_energy": self.dissipated_energy,
            "dissipated_energy_error": self.dissipated_energy_error,
            "stick_fraction": self.stick_fraction,
        }
        return {name: ("1", values) for name, values in columns.items()}

    @property
    def attributes(self) -> dict[str, object]:
        """Attributes of the dataset."""
        names = ("model", "tolerance", "reason")
        return {name: getattr(self, name) for name in names} | {"converged": int(self.converged)}

    def to_xarray(self) -> Any:
        """Convert the columns to an xarray.Dataset with the dimension `row`."""
        return import_module("microslip.datasets.of_records").to_xarray(self)

    def __str__(self) -> str:
        """The lines that `microslip response` prints."""
        return str(import_module("microslip.datasets.of_records").response_text(self))


def response(
    forward: np.ndarray,
    lateral: np.ndarray | None = None,
    angle: np.ndarray | None = None,
    load: np.ndarray | None = None,
    *,
    indentation: np.ndarray | None = None,
    state: Response | str | None = None,
    pressure: str | Pressure = HERTZ,
    poisson: float = 0.0,
    tolerance: float = 1e-3,
    progress: Progress | None = None,
) -> Response:
    """Compute the forces of a contact that follows a prescribed path.

    Parameters
    ----------
    forward : array_like, shape (rows,)
        Forward displacement, in u_lim.  All quantities change linearly between rows.
    lateral : array_like or None, shape (rows,)
        Lateral displacement, in u_lim.
    angle : array_like or None, shape (rows,)
        Rotation about the contact normal, in u_lim / a.
    load : array_like or None, shape (rows,)
        Normal load divided by the reference load, >= 0.  Defaults to the reference load.
    indentation : array_like or None, shape (rows,)
        Indentation divided by the indentation under the reference load, >= 0.  Give either this or
        `load`.
    state : Response, str or None
        State in the first row.  A Response stands for the state at its end.  The other states are
        "full-slip", "full-rotation" and None, which means no tangential tractions.
    pressure : str or Pressure
        Pressure, see `microslip.solve`.  If the load changes, the indenter must be axisymmetric.
    poisson : float
        Poisson's ratio, 0 to 0.5.
    tolerance : float
        Largest accepted error of the forces divided by mu F_z, and of the torque divided by its
        value at full slip.
    progress : callable or None
        Called as `progress(rows, total)` during the marches.

    Returns
    -------
    Response
        The forces.  If the finest level does not reach the tolerance, `converged` is False and
        `reason` says why.

    Raises
    ------
    InputError
        If an argument is invalid.  The message names the argument.
    """
    columns = {
        "forward": forward,
        "lateral": lateral,
        "angle": angle,
        "load": load,
        "indentation": indentation,
    }
    path, first, start = SampledPath.of_columns(columns), 0, state
    if isinstance(state, Response):
        path, first, start = _joined(state, path)
    elif state is None:
        start = STARTS[0]
    if not isinstance(start, str) or start not in STARTS:
        allowed = f"allowed is a Response or one of {', '.join(STARTS)}"
        raise InputError("state", state, allowed)
    if start == "full-rotation" and not path.rotates:
        raise InputError("state", start, "allowed for paths that rotate")
    poisson = real("poisson", poisson, 0.0, 0.5)
    tolerance = real("tolerance", tolerance, SMALLEST_TOLERANCE, 1.0)
    if progress is not None and not callable(progress):
        raise InputError("progress", progress, "allowed is a function of two arguments")
    pressure = pressure if isinstance(pressure, Pressure) else pressure_named(pressure)
    problem = Problem(path, poisson=poisson, pressure=pressure)
    return _refined(_Marches(problem, start, tolerance, progress), first)


def _joined(before: Response, path: SampledPath) -> tuple[SampledPath, int, str]:
    """Append a path to the path of an earlier response.

    Returns the joined path, the index of the first row of the appended path, and the start state of
    the earlier response.
    """
    old = before.problem.motion
    assert isinstance(old, SampledPath)
    height = None
    if old.height is not None or path.height is not None:
        if old.height is None or path.height is None or old.by_load != path.by_load:
            allowed = "allowed is a response whose load or indentation is prescribed likewise"
            raise InputError("state", "a Response", allowed)
        if not np.isclose(old.height[-1], path.height[0], rtol=1e-9):
            name = "load" if path.by_load else "indentation"
            allowed = f"allowed in the first row is where the state ended: {old.height[-1]:.12g}"
            raise InputError(name, float(path.height[0]), allowed)
        height = np.concatenate([old.height, path.height[1:]])
    shift = old.rows[-1] - path.rows[0]
    rows = np.concatenate([old.rows, path.rows[1:] + shift])
    return SampledPath(rows, height, path.by_load), len(old.rows) - 1, before.start


class _Marches:
    """Marches along a path at the levels of its ladder.  No march is repeated.

    Attributes
    ----------
    rows : dict of int to np.ndarray
        Values at every row for each level, shape (rows, 5): forward force, lateral force, torque,
        dissipated energy, and a bound on the sum of the residuals since the start.
    stick : dict of int to np.ndarray
        Stick fraction at every row for each level.
    """

    def __init__(self, problem: Problem, start: str, tolerance: float, progress: Progress | None):
        self.problem, self.start, self.progress = problem, start, progress
        self.model = choose_model(problem)
        self.tolerance = tolerance
        self.ladder = ladder_for(problem, self.model, tolerance)
        self.rows: dict[int, np.ndarray] = {}
        self.stick: dict[int, np.ndarray] = {}

    def at(self, level: int) -> np.ndarray:
        """Values of `rows` at a level."""
        if level not in self.rows:
            self.rows[level], self.stick[level] = self._march(level)
        return self.rows[level]

    def _march(self, level: int) -> tuple[np.ndarray, np.ndarray]:
        problem = self.problem
        contact = contact_of(problem, self.model, self.ladder.resolution(level))
        counts = _steps(problem, level)
        step_tolerance = STEP_SHARE * self.tolerance / (2 * counts.sum())
        state = tractions_at_start(contact, self.start)
        out, stick = np.zeros((len(counts) + 1, 5)), np.full(len(counts) + 1, np.nan)
        initial, work = _stored_energy(contact, state), 0.0
        for first, last in _pieces(counts, state.size):
            path = make_path(
                problem.displacement, _phases(first, counts[first:last]), depth=problem.depth
            )
            march = contact.march(path, state, step_tolerance)
            ends, rows = np.cumsum([0, *counts[first:last]]), slice(first + 1, last + 1)
            tractions, bounds = _tractions(contact, path, march, ends)
            mean_forces = 0.5 * (march.forces[1:] + march.forces[:-1])
            works = np.sum(mean_forces * np.diff(path.positions, axis=0), axis=1)
            works = work + np.concatenate([[0.0], np.cumsum(works)])[ends]
            stored = np.array([_stored_energy(contact, one) for one in tractions])
            out[first, :3] = march.forces[0]
            out[rows, :3] = march.forces[ends[1:]]
            out[rows, 3] = (works - (stored - initial))[1:]
            out[rows, 4] = out[first, 4] + march.residual
            stick[rows] = _stick_fraction(contact, tractions, bounds)[1:]
            work, state = works[-1], march.state
            if self.progress is not None:
                self.progress(last, len(counts))
        out[:, 2] /= problem.pressure.torque
        return out, stick


def _refined(marches: _Marches, first: int) -> Response:
    """The response from row `first` on, refined until the force errors are within the tolerance."""
    tolerance, reason = marches.tolerance, ""
    for level in marches.ladder.levels(tolerance):
        three = [_from_row(marches.at(one), first) for one in (level // 4, level // 2, level)]
        limit = extrapolate([one[:, :4] for one in three])
        error = np.maximum(limit.error, SMALLEST_SHARE * tolerance)
        error += sum(abs(w) * one[:, 4:] for w, one in zip(WEIGHTS, three, strict=True))
        largest = float(error[:, :3].max())
        if largest <= tolerance:
            break
    else:
        reason = f"the error is still {largest:.1e} with {level} cells"
    for reading in marches.problem.readings:
        other = _Marches(reading, marches.start, tolerance, marches.progress).at(level)
        apart = READING_SAFETY * np.abs(_from_row(other, first) - three[-1])[:, :4]
        error = error + apart
        if not reason and error[:, :3].max() > tolerance:
            reason = f"the file's own resolution leaves {apart[:, :3].max():.1e} open"
    finest = marches.ladder.resolution(level)
    forward, lateral, torque = limit.value[:, :3].T
    return Response(
        force_forward=forward,
        force_lateral=lateral,
        torque=torque,
        force_error=error[:, :3],
        dissipated_energy=limit.value[:, 3],
        dissipated_energy_error=error[:, 3],
        stick_fraction=marches.stick[level][first:],
        tolerance=tolerance,
        converged=not reason,
        reason=reason,
        model=marches.model,
        cells=finest.cells,
        angles=finest.angles,
        problem=marches.problem,
        start=marches.start,
    )


def _from_row(values: np.ndarray, first: int) -> np.ndarray:
    """Values of _Marches.rows from row `first` on; the energy is counted from that row."""
    out = values[first:].copy()
    out[:, 3] -= out[0, 3]
    return out


def _steps(problem: Problem, level: int) -> np.ndarray:
    """Number of time steps between rows, shape (rows - 1,)."""
    path = problem.motion
    assert isinstance(path, SampledPath)
    lengths = np.minimum(path.lengths(problem.pressure), LONG_STROKE)
    return np.maximum(np.ceil(STEPS * level * lengths), 1).astype(int)


def _pieces(counts: np.ndarray, size: int) -> Iterator[tuple[int, int]]:
    """First and last row of each piece of a path; `size` is the number of values in a state."""
    ends, first = np.cumsum(counts), 0
    while first < len(counts):
        values_before = ends[first - 1] if first else 0
        last = int(np.searchsorted(ends, values_before + MOST_VALUES / (2 * size)))
        last = min(max(last, first + 1), len(counts))
        yield first, last
        first = last


def _phases(row: int, counts: np.ndarray) -> np.ndarray:
    """Phases of the steps after row `row`; `counts` are the numbers of steps between rows."""
    parts = [row + k + np.arange(1, count + 1) / count for k, count in enumerate(counts)]
    return np.concatenate([[row], *parts])


def _tractions(
    contact: Contact, path: Path, march: March, ends: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Tractions and friction bounds after the steps `ends`."""
    assert march.fields is not None  # true for all compiled contacts
    fields = np.moveaxis(march.fields[:: path.stages.shape[1]][ends], 1, 0)
    bounds = bounds_at_phases(contact, path)
    bounds = bounds if len(bounds) == 1 else bounds[ends]
    return np.moveaxis(project(fields, bounds), 1, 0), bounds


def _stored_energy(contact: Contact, state: np.ndarray) -> float:
    """Elastic energy of tractions, divided by mu F_z u_lim."""
    return 0.5 * float(np.vdot(contact.weight * state, contact.displacement(state)))


def _stick_fraction(contact: Contact, tractions: np.ndarray, bounds: np.ndarray) -> np.ndarray:
    """Fraction of the contact area whose tractions are below the friction bound."""
    size = np.hypot(tractions[:, 0], tractions[:, 1])
    bounds = np.broadcast_to(bounds, size.shape)
    area = np.where(bounds > 0.0, contact.weight, 0.0)
    sticking = np.where(size < ON_BOUND * bounds, area, 0.0)
    axes = tuple(range(1, size.ndim))
    with np.errstate(invalid="ignore"):
        return sticking.sum(axes) / area.sum(axes)
