"""Forces of a contact along a path.

`history` integrates an oscillation or a steady motion in time, at one resolution.  `response`
integrates along a prescribed path, which need not be periodic. The resolution is refined until the
errors of the forces are within the tolerance.

`iwan` builds an Iwan model.  If Poisson's ratio is above 0, `iwan` compares this model with the
response of the full contact.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from functools import cache
from importlib import import_module
from typing import Any

import numpy as np

from microslip.answer import limits
from microslip.answer.answer import Answer
from microslip.answer.ladder import LOAD, ladder_for
from microslip.answer.refine import READING_SAFETY, SMALLEST_SHARE, WEIGHTS, extrapolate
from microslip.contact.contact import Contact, StepFailure, forward_slip, full_slip
from microslip.contact.path import LONG_STROKE, make_path
from microslip.foundation.arguments import refuse_progress
from microslip.foundation.errors import InputError
from microslip.periodic.discretise import Resolution, contact_of, tractions_at_phases
from microslip.periodic.run import unsolved
from microslip.scene.by_name import pressure_named
from microslip.scene.hertz import HERTZ
from microslip.scene.motion import NORMAL, PLANE, Motion
from microslip.scene.pressure import Pressure
from microslip.scene.problem import Problem
from microslip.scene.samples import SampledPath
from microslip.theory.masing import Iwan, with_elements, with_tolerance

STARTS = ("stress-free", "full-slip", "full-rotation")
"""Names of the initial states."""
CELLS, ANGLES, STEPS = 32, 16, 256
"""Default resolution of a history: the number of rings or squares, the number of angles, and the
number of steps in a period."""
STEP_TOLERANCE = 1e-7
"""Tolerance of a step in a history or a period, as a force divided by mu F_z."""
LONGEST_PHASE = 1e12
"""Largest rotation of a steady motion, in u_lim / a.  At larger rotations, successive phases could
be equal because of rounding."""
ON_BOUND = 1.0 - 1e-4
"""A point counts as slipping if its traction is at least this fraction of the friction bound."""
STEP_SHARE = 0.05
"""Largest sum of the step residuals in a response, divided by the tolerance.  See also
request.RUN_SHARE.
"""
MOST_VALUES = 2e7
"""Largest number of tractions in memory at the same time.  Longer paths are integrated in
pieces."""
PATH_STEPS = LOAD.steps / 2.0
"""At level n, a path of length u_lim has n times this number of time steps.  The ladder `LOAD` is
used for oscillating loads.  With this value, the steps at a stroke of u_lim are as long as the
steps of `LOAD`.  At this stroke, half a period is 2 u_lim long."""
FORCES = ("force_forward", "force_lateral", "torque")
"""Names of the forces in a History, a Response and a Period."""
COLUMNS = (
    *(*FORCES, "force_error", "torque_error"),
    *("dissipated_energy", "dissipated_energy_error", "stick_fraction"),
)
"""Names of the columns of a Response."""
ENERGY, RESIDUAL, STICK = 3, 4, 5
"""Indices of the columns that follow the three forces in the rows of a response."""


def tractions_at_start(contact: Contact, start: str) -> np.ndarray:
    """Return the tractions of a contact in the initial state `start`, one of STARTS."""
    if start == "full-rotation":
        return full_slip(contact, contact.lateral_position, -contact.forward_position)
    return float(start == "full-slip") * forward_slip(contact)


def refuse_start(name: str, start: object, rotates: bool, other: str = "") -> None:
    """Raise InputError if `start` is not an initial state of the motion.

    `name` is the name of the argument, and `other` lists further allowed values.
    """
    if not isinstance(start, str) or start not in STARTS:
        raise InputError(name, start, f"allowed is {other}one of {', '.join(STARTS)}")
    if start == "full-rotation" and not rotates:
        raise InputError(name, start, "allowed for motions that rotate")


# Histories


class History(Answer):
    """Forces along a path.  All arrays are dimensionless and have the shape (steps + 1,).

    Attributes
    ----------
    phase : np.ndarray
        Phase omega t; for steady motions, the angle of rotation in u_lim / a.
    displacement_forward : np.ndarray
        Forward displacement in u_lim.
    force_forward, force_lateral : np.ndarray
        Forces on the flat divided by mu F_z; positive in the sphere's direction of motion.
    torque : np.ndarray
        Torque divided by its full-slip value.
    """

    axes = ("phase",)

    def __str__(self) -> str:
        """Return the number of steps, the range of the phase and the final forces as text."""
        first, last = self.phase[0], self.phase[-1]
        lines = [f"{len(self.phase) - 1} steps from phase {first:.6g} to {last:.6g}; at the end:"]
        return "\n".join(lines + [f"{name} = {self.values[name][-1]:.6g}" for name in FORCES])


def history(
    motion: str | Motion | Problem,
    velocity: float | None = None,
    amplitude: float | None = None,
    *,
    pressure: str | Pressure = HERTZ,
    poisson: float = 0.0,
    model: str = "auto",
    cells: int | None = None,
    steps: int | None = None,
    start: str = "stress-free",
    periods: int | None = None,
    travel: float | None = None,
) -> History:
    """Compute the force history of an oscillation or a steady motion from an initial state.

    Parameters
    ----------
    motion, velocity, amplitude, pressure, poisson, model
        See `microslip.solve`; the velocity must be above 0.
    cells : int or None
        Number of rings, or of squares along a side, at least 2.  Defaults to 32.
    steps : int or None
        Number of steps in a period; for steady motions, number of steps over the whole travel.
        Defaults to 256.
    start : str
        "stress-free" (full stick), "full-slip" (forward slip everywhere) or "full-rotation"
        (rotational slip everywhere).
    periods : int or None
        Number of periods of an oscillation.  Defaults to 3.
    travel : float or None
        Travel of a steady motion, in u_lim.  Defaults to 5.

    Returns
    -------
    History
        The forces at every step, including the initial state.

    Raises
    ------
    InputError
        If an argument is invalid.  The message names the argument.
    microslip.contact.contact.StepFailure
        If a step is not solved.
    """
    problem = limits.problem_of(motion, velocity, amplitude, pressure=pressure, poisson=poisson)
    velocity, periodic = problem.velocity, problem.motion.periodic
    if velocity <= 0.0:
        raise InputError("velocity", velocity, "a history needs velocity > 0")
    refuse_start("start", start, problem.motion.rotates)
    cells = CELLS if cells is None else limits.within("cells", cells, low=2, kind="whole")
    steps = STEPS if steps is None else limits.within("steps", steps, low=1, kind="whole")
    unused, value = ("travel", travel) if periodic else ("periods", periods)
    if value is not None:
        kind = "a steady motion" if periodic else "an oscillation"
        raise InputError(
            unused, value, f"allowed is none for {problem.motion.name}, only for {kind}"
        )
    periods = 3 if periods is None else periods
    periods = limits.within("periods", periods, high=limits.LIMITS["periods"].high // steps)
    travel = 5.0 if travel is None else limits.within("travel", travel)
    if not periodic and travel / velocity > LONGEST_PHASE:
        allowed = f"allowed is at least {LONGEST_PHASE:g} times less than the travel, {travel:g}"
        raise InputError("velocity", velocity, allowed)
    resolution = Resolution(cells, ANGLES, steps=0)
    contact = contact_of(problem, limits.choose_model(problem, model), resolution)
    end, count = (2 * np.pi * periods, steps * periods) if periodic else (travel / velocity, steps)
    phases = np.linspace(0.0, end, count + 1)
    path = make_path(problem.displacement, phases, depth=problem.depth)
    march = contact.march(path, tractions_at_start(contact, start), STEP_TOLERANCE)
    failure = unsolved(march, STEP_TOLERANCE)
    if failure:
        raise StepFailure(f"velocity = {velocity!r}: {failure}")
    place = {"phase": path.phase, "displacement_forward": path.positions[:, 0]}
    return History(problem, place | named_forces(problem, march.forces))


def named_forces(problem: Problem, forces: np.ndarray) -> dict[str, np.ndarray]:
    """Return the forces by name.  The torque is divided by the torque under full slip."""
    forward, lateral, torque = forces.T
    return dict(zip(FORCES, (forward, lateral, torque / problem.pressure.torque), strict=True))


# Responses


class Response(Answer):
    """Dimensionless forces of a contact at each point of a prescribed path, one point per row.

    Attributes
    ----------
    force_forward, force_lateral : np.ndarray, shape (rows,)
        Forces divided by mu F_z, where F_z is the reference load.  They are positive in the
        direction of the displacement that they resist.
    torque : np.ndarray, shape (rows,)
        Torque divided by its value at full slip under the reference load.
    force_error : np.ndarray, shape (rows, 3)
        Estimated errors of the forward force, the lateral force and the torque.  For a pressure on
        a grid, they include the error due to the resolution of the grid.
    dissipated_energy, dissipated_energy_error : np.ndarray, shape (rows,)
        Energy dissipated by friction since the first row and its estimated error, both divided by
        mu F_z u_lim.
    stick_fraction : np.ndarray, shape (rows,)
        Fraction of the contact area that sticks in the last step before the row.  It is NaN in the
        first row, and in rows without contact.  Its resolution is limited by the mesh.
    tolerance : float
        Largest accepted force error, as requested.
    converged : bool
        Whether every force error is within the tolerance.
    reason : str
        Reason why the response has not converged, otherwise empty.
    model : str
        Name of the model.
    cells, angles : int
        Numbers of cells and of angles in the finest run.
    """

    @property
    def columns(self) -> dict[str, tuple[str, np.ndarray]]:
        """Dictionary that maps the name of every column to the unit and the values of the column.

        The column `force_error` contains the larger of the errors of the two force components.
        """
        errors = self.force_error
        values = {"force_error": errors[:, :2].max(axis=1), "torque_error": errors[:, 2]}
        return {name: ("1", {**self.values, **values}[name]) for name in COLUMNS}

    @property
    def attributes(self) -> dict[str, object]:
        """Attributes of the dataset that `to_xarray` returns."""
        names = ("model", "tolerance", "reason")
        return {name: getattr(self, name) for name in names} | {"converged": int(self.converged)}

    def to_xarray(self) -> Any:
        """Convert the columns to an xarray.Dataset with the dimension `row`."""
        return import_module("microslip.datasets.of_records").to_xarray(self)

    def __str__(self) -> str:
        """Return the text that `microslip response` prints."""
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
    progress: Callable[[int, int], None] | None = None,
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
        State of the contact in the first row: "full-slip", "full-rotation", or None for no
        tangential tractions.  If a Response is given, the path continues from its last row.
    pressure : str or Pressure
        Pressure, see `microslip.solve`.  If the load changes, the indenter must be axisymmetric.
    poisson : float
        Poisson's ratio, 0 to 0.5.
    tolerance : float
        Largest accepted error. It applies to the forces divided by mu F_z, and to the torque
        divided by its value at full slip.
    progress : callable or None
        Called as `progress(rows, total)` during each run, where `rows` is the number of finished
        rows.

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
    columns = forward, lateral, angle, load, indentation
    path = SampledPath.of_columns(dict(zip((*PLANE, *NORMAL), columns, strict=True)))
    first, start = 0, STARTS[0] if state is None else state
    if isinstance(state, Response):
        path, first, start = _joined(state, path)
    refuse_start("state", start, path.rotates, "a Response or ")
    tolerance = limits.within("tolerance", tolerance, high=1.0)
    refuse_progress(progress, 2)
    problem = Problem(path, poisson=poisson, pressure=pressure_named(pressure))
    for name in ("pressure", "poisson"):
        if isinstance(state, Response) and getattr(problem, name) != getattr(state.problem, name):
            raise InputError(name, str(getattr(problem, name)), "allowed is that of the state")
    model = limits.choose_model(problem)
    ladder = ladder_for(problem, model, tolerance)

    @cache
    def rows(level: int, problem: Problem = problem) -> np.ndarray:
        contact = contact_of(problem, model, ladder.resolution(level))
        out = _marched(problem, contact, level, str(start), tolerance, progress)[first:]
        out[:, ENERGY] -= out[0, ENERGY]
        return out

    for level in ladder.levels(tolerance):
        three = [rows(one) for one in (level // 4, level // 2, level)]
        limit = extrapolate([one[:, :RESIDUAL] for one in three])
        error = np.maximum(limit.error, SMALLEST_SHARE * tolerance)
        error += sum(abs(w) * one[:, RESIDUAL, None] for w, one in zip(WEIGHTS, three, strict=True))
        largest, reason = error[:, :ENERGY].max(), ""
        if largest <= tolerance:
            break
        reason = f"the error is still {largest:.1e} with {level} cells"
    for reading in problem.readings:
        apart = READING_SAFETY * np.abs(rows(level, reading) - three[-1])[:, :RESIDUAL]
        error = error + apart
        if not reason and error[:, :ENERGY].max() > tolerance:
            reason = f"the file's own resolution leaves {apart[:, :ENERGY].max():.1e} open"
    finest = ladder.resolution(level)
    values = {
        **dict(zip(FORCES, limit.value.T, strict=False)),
        "force_error": error[:, :ENERGY],
        "dissipated_energy": limit.value[:, ENERGY],
        "dissipated_energy_error": error[:, ENERGY],
        "stick_fraction": three[-1][:, STICK],
        "tolerance": tolerance,
        "model": model,
        "cells": finest.cells,
        "angles": finest.angles,
        "start": start,
    }
    return Response(problem, values, reason=reason)


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


def _marched(
    problem: Problem,
    contact: Contact,
    level: int,
    start: str,
    tolerance: float,
    progress: Callable[[int, int], None] | None,
) -> np.ndarray:
    """Integrate along a path, and return the values at every row as an array of shape (rows, 6).

    The six columns are the forward force, the lateral force, the torque, the dissipated energy, the
    residual bound, and the stick fraction.  The residual bound is an upper bound on the sum of all
    residuals since the start.
    """
    path = problem.motion
    assert isinstance(path, SampledPath)
    lengths = np.minimum(path.lengths(problem.pressure), LONG_STROKE)
    counts = np.maximum(np.ceil(PATH_STEPS * level * lengths), 1).astype(int)
    step_tolerance = STEP_SHARE * tolerance / (2 * counts.sum())
    state, work = tractions_at_start(contact, start), 0.0
    initial = 0.5 * contact.energy(state)
    out = np.zeros((len(counts) + 1, 6))
    out[0, STICK] = np.nan
    for first, last in _pieces(counts, state.size):
        between = counts[first:last]
        ends, rows = np.cumsum([0, *between]), slice(first + 1, last + 1)
        parts = [first + k + np.arange(1, n + 1) / n for k, n in enumerate(between)]
        phases = np.concatenate([[first], *parts])
        piece = make_path(problem.displacement, phases, depth=problem.depth)
        march = contact.march(piece, state, step_tolerance)
        tractions, bounds = tractions_at_phases(contact, piece, march, ends)
        mean_forces = 0.5 * (march.forces[1:] + march.forces[:-1])
        works = np.sum(mean_forces * np.diff(piece.positions, axis=0), axis=1)
        works = work + np.concatenate([[0.0], np.cumsum(works)])[ends]
        energies = np.array([0.5 * contact.energy(one) for one in tractions])
        out[first, :ENERGY] = march.forces[0]
        out[rows, :ENERGY] = march.forces[ends[1:]]
        out[rows, ENERGY] = (works - (energies - initial))[1:]
        out[rows, RESIDUAL] = out[first, RESIDUAL] + march.residual
        out[rows, STICK] = _stick_fraction(contact, tractions, bounds)[1:]
        work, state = works[-1], march.state
        if progress is not None:
            progress(last, len(counts))
    out[:, 2] /= problem.pressure.torque
    return out


def _pieces(counts: np.ndarray, size: int) -> Iterator[tuple[int, int]]:
    """Yield the first and the last row of each piece into which a path is divided.  A state has
    `size` values."""
    ends, first = np.cumsum(counts), 0
    while first < len(counts):
        values_before = ends[first - 1] if first else 0
        last = int(np.searchsorted(ends, values_before + MOST_VALUES / (2 * size)))
        last = min(max(last, first + 1), len(counts))
        yield first, last
        first = last


def _stick_fraction(contact: Contact, tractions: np.ndarray, bounds: np.ndarray) -> np.ndarray:
    """Return the fraction of the contact area whose tractions are below the friction bound."""
    size = np.hypot(tractions[:, 0], tractions[:, 1])
    area = np.where(bounds > 0.0, contact.weight, 0.0)
    sticking = np.where(size < ON_BOUND * bounds, area, 0.0)
    axes = tuple(range(1, size.ndim))
    with np.errstate(invalid="ignore"):
        return sticking.sum(axes) / area.sum(axes)


TOLERANCE = 1e-3
"""Default limit on the error due to the number of elements.  The full contact in the comparison has
the same tolerance."""
BEYOND_FULL_SLIP = 1.2
"""In the comparison, the loop reverses when the magnitude of the displacement reaches this value,
in u_lim.  At nu = 0.5, the force at this displacement is within 2e-4 of full friction."""
ROWS = 13
"""Number of rows in the initial loading of the comparison.  There is one row for every 0.1 u_lim.
A branch of the loop has twice as many intervals as the initial loading.  With 49 rows instead, the
computed difference is up to 7 % larger."""


def iwan(
    pressure: str | Pressure = HERTZ,
    *,
    poisson: float = 0.0,
    elements: int | None = None,
    tolerance: float | None = None,
) -> Iwan:
    """Build the Iwan model (parallel springs with sliders) of a contact that moves along a line.

    At nu = 0, a model with many elements is exact.  At nu > 0, the model is compared with the full
    contact along an initial loading and a loop. The largest difference is included in the error.

    Parameters
    ----------
    pressure : str or Pressure
        Pressure as for `microslip.solve`: an axisymmetric indenter, or an ellipse at nu = 0.
    poisson : float
        Poisson's ratio, 0 to 0.5.
    elements : int or None
        Number of elements.
    tolerance : float or None
        Largest error due to the number of elements, divided by mu F_z.  Defaults to 1e-3.  Give
        either this or `elements`.

    Returns
    -------
    Iwan
        The elements.  Displacements are divided by u_lim, and forces by mu F_z.

    Raises
    ------
    InputError
        If an argument is invalid.
    """
    record = pressure_named(pressure)
    poisson = limits.within("poisson", poisson)
    if not (record.is_indenter or (record.hertzian and not poisson)):
        allowed = "allowed is an axisymmetric indenter such as hertz, or an ellipse at nu = 0"
        raise InputError("pressure", record.name, allowed)
    shape = record if record.is_indenter else HERTZ  # an ellipse has the loading curve of a sphere
    if elements is not None and tolerance is not None:
        raise InputError("elements", elements, "allowed only without a tolerance")
    if elements is not None:
        model = with_elements(shape, limits.within("elements", elements))
    else:
        accepted = TOLERANCE if tolerance is None else tolerance
        model = with_tolerance(shape, limits.within("tolerance", accepted, high=1.0))
    if not poisson:
        return model
    return dataclasses.replace(model, poisson_error=_poisson_error(shape, poisson))


def _poisson_error(pressure: Pressure, poisson: float) -> float:
    """Return the largest difference between two forces: the force of the full contact, and the
    force of the model.

    The model is exact at nu = 0.  The path consists of an initial loading, followed by a loop that
    reaches full slip in each direction.
    """
    rise = np.linspace(0.0, BEYOND_FULL_SLIP, ROWS)
    # Half the displacement since a turning point.
    half = np.linspace(0.0, BEYOND_FULL_SLIP, 2 * ROWS - 1)[1:]
    path = np.concatenate([rise, BEYOND_FULL_SLIP - 2.0 * half, 2.0 * half - BEYOND_FULL_SLIP])
    back = 1.0 - 2.0 * pressure.loading(half)
    forces = np.concatenate([pressure.loading(rise), back, -back])
    full = response(path, pressure=pressure, poisson=poisson, tolerance=TOLERANCE)
    return float(np.max(np.abs(full.force_forward - forces) + full.force_error[:, 0]))
