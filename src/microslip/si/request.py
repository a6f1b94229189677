"""Requests for predictions.  They are checked and made dimensionless before any solve."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from microslip.adaptive.checks import checked_driven_problem
from microslip.adaptive.point import Result, solve
from microslip.foundation.arguments import LARGEST, SMALLEST_TOLERANCE
from microslip.foundation.errors import InputError, shown
from microslip.motions.problem import Problem
from microslip.si.dimensionless import MovingContact, RealDrive
from microslip.si.friction_map import REFUSED, FrictionMap
from microslip.si.inputs import (
    DRIVE_FIELDS,
    Inputs,
    check_motion_and_drive,
    contact_of,
    drive_of,
    motion_of,
    read_inputs,
    with_stroke,
)
from microslip.si.motions import RealMotionKind, kind_of
from microslip.si.quantities import read

LARGEST_TOLERANCE = 0.1
"""Largest allowed tolerance, absolute for mu_macro and relative for a speed."""
TOLERANCE, TOLERANCE_OF_SPEED = 1e-3, 1e-2
"""Default tolerance of mu_macro, and default tolerance of the speed under a force."""
ANY_LOAD = 1e-12
"""Placeholder, N, for a load that is determined by a search.  It is so small that Hertz's theory
applies to all bodies."""
SOUGHT = ("amplitude", "speed", "load")
"""Quantities that a search can determine."""
ARGUMENTS = {"velocity": "speed"} | {group: name for name, group in DRIVE_FIELDS.items()}
"""Arguments of `predict`, keyed by the corresponding arguments of microslip.solve."""
NOT_FINITE = "is beyond the range of floating-point numbers; allowed are sizes of real machines"


@dataclass(frozen=True, eq=False)
class Request(MovingContact):
    """A contact with its motion and its drive, as requested from `predict`.

    Attributes
    ----------
    inputs : Inputs
        Arguments of `predict`.
    drive : RealDrive
        The drive of the body.
    sought : str or None
        Name of the quantity that a search determines.
    tolerance : float
        Accepted error of mu_macro, or accepted relative error of the speed under a force.
    understood : dict of str
        The arguments as the user wrote them, by name.
    kind : RealMotionKind
        The kind of the motion, without the samples of a file.
    """

    inputs: Inputs
    drive: RealDrive
    sought: str | None
    tolerance: float
    understood: dict[str, str]
    kind: RealMotionKind

    def at(self, **changes: Any) -> Request:
        """A copy with changed fields of the motion, or with another load, N."""
        contact = self.contact
        if "load" in changes:
            contact = contact.with_load(changes.pop("load"))
        return replace(self, contact=contact, motion=replace(self.motion, **changes))

    def under(self, load: float) -> Request:
        """A copy with another load, N, for a search.

        Raises InputError if Hertz's theory does not apply under this load.
        """
        try:
            contact = contact_of(self.inputs, load)
        except InputError as error:
            problem = f"it takes a load of {load:.3g} N; {error}"
            raise self.inputs.error("reduction", problem) from None
        return replace(self, contact=contact)

    @cached_property
    def still(self) -> float:
        """Friction without vibration, N: mu times the mean normal load."""
        return self.full_friction

    @cached_property
    def drive_groups(self) -> dict[str, float]:
        """Force, stiffness, mass and damping for microslip.solve."""
        return self.drive.groups(self)

    @cached_property
    def map(self) -> FrictionMap | None:
        """The map that replaces the solver, or None.

        Raises InputError if it is not a map of this motion, this pressure and this drive.
        """
        dataset = self.inputs.arguments["map"]
        if dataset is None:
            return None
        for name in REFUSED:
            if self.inputs.arguments[name] is not None:
                raise self.inputs.error(name, "allowed only without a map")
        if self.motion.stroke is not None:
            allowed = "not allowed for a motion from a file: no map has its unit of the amplitude"
            raise InputError("map", self.motion.name, allowed)
        return FrictionMap(dataset, str(self.solver_motion), self.contact.pressure)

    def problem(self) -> Problem:
        """The dimensionless Problem in the limit of vanishing speed."""
        return checked_driven_problem(self.solver_motion, 0.0, self.groups[1], **self.settings)

    @property
    def settings(self) -> dict[str, Any]:
        """Further arguments for microslip.solve."""
        return {"poisson": self.contact.poisson, "pressure": self.contact.pressure}

    def solve(
        self,
        velocity: float | None,
        tolerance: float,
        *,
        amplitude: float | None = None,
        poisson: float | None = None,
        **drive: float,
    ) -> Result:
        """The dimensionless Result of microslip.solve.

        Parameters
        ----------
        velocity : float or None
            Dimensionless velocity; None under a force.  A velocity above the range of the solver is
            replaced by the largest allowed velocity, at which the vibration has no effect.
        tolerance : float
            Largest accepted error.
        amplitude, poisson : float, optional
            They replace the values of the request.
        **drive : float
            Dimensionless force, stiffness, mass and damping.

        Raises
        ------
        InputError
            If an argument of the solver is out of range.  The message names the argument of
            `predict`.
        """
        settings = self.settings | drive | {"tolerance": tolerance}
        if poisson is not None:
            settings["poisson"] = poisson
        if velocity is not None:
            velocity = min(velocity, LARGEST["velocity"])
        size = self.groups[1] if amplitude is None else amplitude
        if self.map is not None:
            assert velocity is not None  # a map is not allowed with a force
            return self.map.solve(velocity, size, poisson=settings["poisson"], tolerance=tolerance)
        try:
            return solve(self.solver_motion, velocity, size, **settings)
        except InputError as error:
            raise (self._in_si(error) if drive else error) from None

    def _in_si(self, error: InputError) -> InputError:
        """Return a copy of the error in which `predict`'s argument replaces the solver's
        argument."""
        name = ARGUMENTS.get(error.argument, "")
        if name not in self.inputs.quantities:
            return error
        group = f"{error.value:.6g}" if isinstance(error.value, float) else shown(error.value)
        return self.inputs.error(name, f"dimensionless {group}: {error.allowed}")

    def check_range(self) -> None:
        """Raise InputError for an argument whose dimensionless group is out of range."""
        velocity, size = self.groups
        if velocity is not None and not math.isfinite(velocity):
            raise self.inputs.error("speed", f"divided by that of the vibration {NOT_FINITE}")
        most = LARGEST["amplitude"]
        if (self.motion.load_amplitude or 0.0) > most * self.contact.load:
            allowed = f"allowed is at most {most:g} times the load"
            raise self.inputs.error("load_amplitude", allowed)
        if size is not None and not size <= most:
            unit = "the angle at which the stick radius is half the contact radius"
            if not self.motion.spins:
                unit = f"the {self.contact.u_lim:.3g} m at which the whole contact slides"
            allowed = f"{size:.3g} times {unit}; allowed is at most {most:g} times"
            raise self.inputs.error("amplitude", allowed)
        for name, value in self.drive_groups.items():
            if not math.isfinite(value):
                problem = f"divided by that of the contact {NOT_FINITE}"
                raise self.inputs.error(ARGUMENTS[name], problem)


def request_of(motion: str, arguments: Mapping[str, Any]) -> Request:
    """The Request for a mapping of all arguments of `predict`.  Raises InputError."""
    arguments = with_stroke(motion, arguments)
    for name, value in arguments.items():
        if name not in ("counterbody", "map") and _is_sequence(value):
            allowed = "allowed is one value; predict_table takes a sequence, with many contacts"
            raise InputError(name, value, allowed)
    sought = _sought(motion, arguments)
    check_motion_and_drive(motion, arguments, sought)
    inputs = read_inputs(arguments, motion)
    tolerance = arguments["tolerance"]
    if tolerance is None:
        tolerance = TOLERANCE if arguments["force"] is None else TOLERANCE_OF_SPEED
    limits: dict[str, Any] = {"low": SMALLEST_TOLERANCE, "high": LARGEST_TOLERANCE}
    accepted = read("tolerance", tolerance, "", low_open=False, **limits).si
    contact = contact_of(inputs, ANY_LOAD if sought == "load" else None)
    real, drive = motion_of(motion, inputs), drive_of(motion, inputs)
    if sought is not None and drive != RealDrive():
        raise inputs.error("reduction", "allowed only without a force and a drive_stiffness")
    kind = replace(kind_of(motion), stroke=None)
    understood = {"motion": f"{motion}: the sphere {kind.description}"} | inputs.texts
    if real.stroke is not None:
        understood["amplitude"] += " times the samples"
    request = Request(contact, real, inputs, drive, sought, accepted, understood, kind)
    if sought is None:
        request.check_range()
    if request.map is not None:
        understood["map"] = "friction from a map in place of the solver"
    return request


def _is_sequence(value: object) -> bool:
    """True for an array, a list or a column of a table, with or without a unit.

    A DataArray of one value is a number.
    """
    values = getattr(value, "magnitude", value)  # the array in a pint quantity
    if isinstance(values, str | bytes | Mapping):
        return False
    if hasattr(values, "dims") and getattr(values, "size", 0) == 1:
        return False
    return hasattr(values, "__len__") and getattr(values, "ndim", 1) > 0


def _sought(motion: str, arguments: Mapping[str, Any]) -> str | None:
    """Name of the missing quantity, which a search determines; None without a reduction.

    Raises InputError unless exactly one quantity is missing.
    """
    kind, reduction = kind_of(motion), arguments["reduction"]
    if reduction is None:
        return None
    missing = [name for name in SOUGHT if arguments[name] is None]
    if "speed" in missing and arguments["force"] is not None:
        missing.remove("speed")
    if not kind.unit and missing != ["speed"]:
        what = "several amplitudes" if kind.several else "no amplitude"
        raise InputError("reduction", reduction, f"not allowed: {motion} has {what}")
    if not missing:
        allowed = "allowed only without the amplitude, the speed or the load, which it determines"
        raise InputError("reduction", reduction, allowed)
    if len(missing) > 1:
        allowed = f"it determines one quantity, but {' and '.join(missing)} are missing"
        raise InputError("reduction", reduction, allowed)
    return missing[0]
