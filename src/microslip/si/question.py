"""The request for a prediction, read and checked before anything is solved."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from microslip.foundation.arguments import LARGEST, SMALLEST_TOLERANCE
from microslip.foundation.errors import InputError
from microslip.si.bodies import TwoBodies
from microslip.si.dimensionless import RealDrive, RealMotion, groups
from microslip.si.drives import checked_drive_groups, read_drive
from microslip.si.inputs import (
    SHAPES,
    Body,
    read_body,
    read_contact,
    read_counterbody,
    read_motion,
)
from microslip.si.quantities import Given, read
from microslip.si.reduction import sought_by
from microslip.si.several import Carriers, read_carriers

LARGEST_TOLERANCE = 0.1
"""Largest accepted tolerance, absolute for mu_macro and relative for a speed."""
TOLERANCE, TOLERANCE_OF_SPEED = 1e-3, 1e-2
"""Unless told otherwise: of mu_macro, and under a force of the speed."""
ANY_LOAD = 1e-12
"""N; stands for a load that is looked for, small enough for Hertz's theory of all bodies."""
MOVED: tuple[str, ...] = (
    "amplitude",
    "frequency",
    "rotation",
    "forward_amplitude",
    "rotation_amplitude",
)
MOVED += ("load_amplitude", "phase")
"""Arguments of predict that tell the motion, besides the speed."""
PULLED = ("speed", "force", "drive_stiffness", "mass", "damping")
"""Arguments of predict that describe the drive."""


@dataclass(frozen=True, eq=False)
class Question:
    """A contact, its motion and what pulls it, as far as they are given.

    Attributes
    ----------
    given : Mapping
        Arguments of predict, as they were given.
    contact, motion, drive : TwoBodies, RealMotion, RealDrive
        Contact, motion and drive without the sought quantity.
    bodies : tuple of Body
        Bodies of the contact.
    carriers : several.Carriers
        The contact, or several like it, of which it carries the mean load.
    sought, share : str or None, float or None
        Name of the quantity sought by a reduction, and the reduction of friction, 0 to 1.
    tolerance : float
        Accepted error of mu_macro, or relative error of the speed.
    about : dict of str
        What was understood.
    """

    given: Mapping[str, object]
    contact: TwoBodies
    motion: RealMotion
    drive: RealDrive
    bodies: tuple[Body, Body]
    carriers: Carriers
    sought: str | None
    share: float | None
    tolerance: float
    about: dict

    def under(self, load: float) -> TwoBodies:
        """The contact under a load that was found, N; raises InputError where it is none."""
        shape: dict[str, Any] = {name: self.given[name] for name in (*SHAPES, "mu")}
        try:
            return read_contact(*self.bodies, load=load, **shape)[0]
        except InputError as error:
            problem = f"it takes a load of {load:.3g} N; {error}"
            raise InputError("reduction", self.given["reduction"], problem) from None


def asked(motion: str, given: Mapping[str, object]) -> Question:
    """The question that is put to predict, given all of its arguments by their names.

    Raises InputError for each of them that is none.
    """
    for name, value in given.items():
        if name != "counterbody" and _is_sequence(value):
            allowed = "allowed is one value; predict_table takes a sequence, with many contacts"
            raise InputError(name, value, allowed)
    if not isinstance(given["power"], bool):
        raise InputError("power", given["power"], "allowed is True or False")
    if given["mu"] is None:
        raise InputError("mu", None, "needed")
    speed, force, reduction = given["speed"], given["force"], given["reduction"]
    known = {"amplitude": given["amplitude"], "load": given["load"]}
    sought = sought_by(motion, reduction, known | {"speed": force if speed is None else speed})
    real, moved = read_motion(
        motion, speed=speed, sought=sought, **{name: given[name] for name in MOVED}
    )
    drive, pulls = read_drive(real, sought=sought, **{name: given[name] for name in PULLED})
    tolerance = given["tolerance"]
    if tolerance is None:
        tolerance = TOLERANCE if force is None else TOLERANCE_OF_SPEED
    accepted = read(
        "tolerance", tolerance, "", low=SMALLEST_TOLERANCE, low_open=False, high=LARGEST_TOLERANCE
    )
    body = read_body(given["young"], given["nu"], given["material"])
    other = read_counterbody(given["counterbody"])
    bodies = (
        body.completed("", given["hardness"], given["density"]),
        other.completed("counter_", given["counter_hardness"], given["counter_density"]),
    )
    carriers, several = read_carriers(given["contacts"], reduction=reduction, power=given["power"])
    shape: dict[str, Any] = {name: given[name] for name in (*SHAPES, "mu")}
    load = ANY_LOAD if sought == "load" else given["load"]
    contact, touched = read_contact(*bodies, load=load, contacts=carriers.count, **shape)
    loaded = real.load_amplitude
    if several and loaded is not None and loaded * carriers.widest > contact.load:
        allowed = "allowed is at most the load beside contacts: beyond it the bodies part"
        raise InputError("load_amplitude", given["load_amplitude"], allowed)
    about = touched | moved | pulls | several
    share: Given | None = None
    if sought is None:
        checked_groups(contact, real, given)
        checked_drive_groups(carriers.share_of(drive), real, contact, given)
    if several:
        carriers.problem(real, contact)  # refuses what does not go with them
    if sought is not None:
        share = _share(reduction, pulls)
        about["reduction"] = share.text
        about = {name: text for name, text in about.items() if name != sought}
    taken = None if share is None else share.si
    settings = (sought, taken, accepted.si, about)
    return Question(given, contact, real, drive, bodies, carriers, *settings)


def _is_sequence(value: object) -> bool:
    """Whether a value is an array, a list or a column of a table, with a unit or without."""
    values = getattr(value, "magnitude", value)  # of a pint quantity
    if isinstance(values, str | bytes | Mapping):
        return False
    return hasattr(values, "__len__") and getattr(values, "ndim", 1) > 0


def _share(reduction: object, pulls: dict) -> Given:
    """The reduction of friction, 0 to 1; raises InputError."""
    if pulls:
        allowed = "allowed where a speed alone pulls: without a force and a drive_stiffness"
        raise InputError("reduction", reduction, allowed)
    return read("reduction", reduction, "", high=1.0)


def checked_groups(
    contact: TwoBodies, motion: RealMotion, given: Mapping[str, object]
) -> tuple[float | None, float | None]:
    """velocity and amplitude as groups gives them; raises InputError for what the solver cannot
    take, in terms of the speed and the amplitude as they were given."""
    velocity, size = groups(motion, contact)
    if velocity is not None and not math.isfinite(velocity):
        problem = "over that of the vibration, it is beyond the range of floating-point numbers"
        raise InputError(
            "speed", given["speed"], f"{problem}; allowed is what a laboratory can have"
        )
    part = motion.load_amplitude or 0.0
    if part > LARGEST["amplitude"] * contact.load:
        allowed = f"allowed is at most {LARGEST['amplitude']:g} times the load"
        raise InputError("load_amplitude", given["load_amplitude"], allowed)
    if size is not None and not size <= LARGEST["amplitude"]:
        unit = "the angle that leaves half of the contact sticking"
        if not motion.spins:
            unit = f"the {contact.u_lim:.3g} m that let the whole contact slide"
        raise InputError(
            "amplitude",
            given["amplitude"],
            f"{size:.3g} times {unit}; allowed is at most {LARGEST['amplitude']:g} times",
        )
    return velocity, size
