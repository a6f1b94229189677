"""How much friction falls in a real contact, and how far to trust that."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from microslip.adaptive.result import Result
from microslip.foundation.errors import InputError, shown
from microslip.si.bodies import TwoBodies
from microslip.si.dimensionless import RealMotion, full_friction
from microslip.si.drives import checked_drive_groups
from microslip.si.energy import energy_fields, vibration_fields
from microslip.si.prediction import Prediction
from microslip.si.pulled import about_drive, answer_at_rest, answer_of, with_speed
from microslip.si.question import Question, asked, checked_groups
from microslip.si.reduction import with_reduction
from microslip.si.static_limit import force_threshold, static_limit
from microslip.si.uncertain import with_spreads
from microslip.si.validity import broken_assumptions, unchecked

UNKNOWN_WITHOUT = {
    "amplitude": ("amplitude_si",),
    "speed": ("speed_m_s",),
    "load": (
        *("load_N", "contact_radius_m", "indentation_m", "u_lim_m", "largest_pressure_Pa"),
        "friction_force_still_N",
    ),
}
"""Fields of a Prediction that are not known without what is looked for."""
ARGUMENTS = {
    "velocity": "speed",
    "force": "force",
    "stiffness": "drive_stiffness",
    "mass": "mass",
    "damping": "damping",
}
"""Arguments of predict, by those of microslip.solve that follow from them."""


@with_spreads
def predict(
    motion: str,
    *,
    mu: object,
    load: object = None,
    radius: object = None,
    speed: object = None,
    force: object = None,
    young: object = None,
    nu: object = None,
    material: object = None,
    counterbody: object = None,
    counter_radius: object = None,
    radius_across: object = None,
    contact_radius: object = None,
    pressure: object = None,
    amplitude: object = None,
    forward_amplitude: object = None,
    rotation_amplitude: object = None,
    load_amplitude: object = None,
    phase: object = None,
    frequency: object = None,
    rotation: object = None,
    reduction: object = None,
    drive_stiffness: object = None,
    mass: object = None,
    damping: object = None,
    contacts: object = None,
    hardness: object = None,
    density: object = None,
    counter_hardness: object = None,
    counter_density: object = None,
    tolerance: object = None,
    power: bool = False,
) -> Prediction:
    """Friction of a sphere on a flat, on a second sphere, or of another contact under vibration.

    A quantity is a text of one number and one unit ("5 mm"), a pint quantity, or a number in the
    unit of the SI.  Loads, radii, speeds, forces, mu, young and nu may have a spread, their
    standard uncertainty: "10 N +- 5 %".  Texts are read strictly: what is not understood to its
    last character is refused.

    Parameters
    ----------
    motion : str
        "transverse", "longitudinal", "zigzag", "bore" (the sphere spins to and fro about the
        contact normal), "continuous-bore" (it spins steadily), "elliptic", "transverse-bore",
        "normal", or another motion that `microslip.solve` takes, which translates or rotates.
    radius, load, mu : quantity
        Radius of the sphere, m; normal force, N; coefficient of friction without vibration.
    speed : quantity
        Forward speed of sliding, m/s; of the far end of a spring, if there is one.
    force : quantity
        Instead of the speed, the constant force that pulls, N: the speed is asked for.
    young, nu : quantity
        Young's modulus, Pa, and Poisson's ratio of the body.
    material : str or Material
        The body by the name of a material, or as a microslip.Material.
    counterbody : str, Material or pair of quantities, optional
        "rigid", a material, or E and nu as in "70 GPa, 0.22" or (70e9, 0.22); rigid if not given.
    counter_radius : quantity, optional
        Radius of the counterbody, m, negative if hollow; flat if not given.
    radius_across : quantity, optional
        Another radius of curvature across the forward direction, m: the contact is an ellipse.
    contact_radius, pressure : quantity, str, optional
        In place of all radii: half the longer side of a contact that is known, m, and how the load
        is spread over it, as microslip.solve takes it: "ring:inner=0.5", "file:pad.csv"; "hertz" if
        not given.
    amplitude : quantity
        Half stroke of the oscillation: a length, or for a bore an angle.  For motions that
        oscillate in several ways it is the half stroke across.
    forward_amplitude, rotation_amplitude, load_amplitude, phase : quantity, optional
        For motions that oscillate in several ways: half strokes along, m, in spin, rad, and of the
        load, N; and a phase, rad.  These follow sin(omega t + phase): the forward motion of
        elliptic, the rotation of transverse-bore, and all of normal except its load.  All others
        follow sin(omega t).
    frequency : quantity
        Frequency of the oscillation: cyclic (Hz, cps), or angular (rad/s, deg/s, rpm, turn/s),
        which is converted, 2 pi rad/s being 1 Hz.  A number is in Hz.
    rotation : quantity
        Angular speed of a continuous bore, in the same units.  A number is in rad/s.
    reduction : quantity, optional
        Instead of the amplitude, the speed or the load, the share of friction to be taken away, 0
        to 1 or in per cent: the least amplitude, the largest speed or the largest load at which
        vibration does it is looked for.  A speed alone pulls then.
    drive_stiffness, mass, damping : quantity, optional
        Stiffness of a spring that pulls the body at the speed, N/m, mass of the body, kg, and
        damping of a dashpot on it, N s/m.  A mass is also allowed under a force.
    contacts : str, optional
        The contacts of a body that rests on several equal ones, as for microslip.solve:
        "phase=0;phase=180".  `load` is the sum over all contacts, divided in proportion to the
        `load` of each; force, drive_stiffness, mass and damping are those of the body; amplitudes
        are those of a contact whose `amplitude` is 1.  Results for a single contact refer to one
        that carries the mean load, and warnings to the one that carries most.
    hardness, density, counter_hardness, counter_density : quantity, optional
        Hardness and density of the body and the counterbody, Pa (or as in "700 HV", "60 HRC") and
        kg/m^3.  Only the warnings use them.
    tolerance : quantity
        Largest accepted error of the ratio mu_macro, absolute, 1e-3 if not given; under a force
        relative of the speed, 1e-2 if not given, and of a thousandth of its unit (omega u_lim, or
        that of the motion) where it is slower.
    power : bool
        Whether to ask the solver, too, what it takes to vibrate the contact.

    Returns
    -------
    Prediction
        With what was understood, what was found, and where the theory breaks.

    Raises
    ------
    InputError
        A ValueError that names the argument, its value as it was given, and what is allowed: for
        what is missing, ambiguous or out of range, for bodies that fit so closely that the contact
        is half as wide as one of them, and where no amplitude takes that much friction away.
    """
    given = dict(locals())  # all arguments, and nothing else yet
    return _answered(asked(given.pop("motion"), given))


def _answered(question: Question) -> Prediction:
    """The Prediction of a Question."""
    contact, motion, given = question.contact, question.motion, question.given
    carriers, drive = question.carriers, question.drive
    pulled: dict[str, Any] = {"contacts": carriers.text}
    if question.sought is not None:
        settings: dict[str, Any] = {"share": question.share, "tolerance": question.tolerance}
        settings["given"] = given["reduction"]
        reduced = with_reduction(contact, motion, question.sought, **settings)
        motion = reduced.motion
        pulled |= {"sought": question.sought, "sought_error": reduced.error}
        if question.sought == "load":
            contact = question.under(reduced.contact.load)
    velocity, _ = checked_groups(contact, motion, given)
    pulling = checked_drive_groups(carriers.share_of(drive), motion, contact, given)
    limit = static_limit(
        contact, motion, carriers, question.tolerance, under_force=given["force"] is not None
    )
    threshold = force_threshold(contact, motion, carriers, drive, limit)
    answer = answer_at_rest((contact, carriers), motion, pulling, limit, threshold)
    if answer is None:
        try:
            answer = answer_of(contact, motion, pulling, question.tolerance, carriers, threshold)
        except InputError as error:
            raise _in_si(error, given) from None
    pulled |= about_drive((contact, carriers), motion, (drive, pulling), answer, threshold)
    if velocity is None:
        velocity, motion = answer.velocity, with_speed(motion, contact, answer)
    if answer.converged:
        pulled |= energy_fields(contact, motion, answer, carriers.count)
        if given["power"]:
            pulled |= vibration_fields(contact, motion, answer, question.tolerance)
            pulled["converged"] = not pulled.get("vibration_power_reason")
    most = carriers.most_loaded(contact)
    doubts = tuple(broken_assumptions(most, motion)), tuple(unchecked(most))
    still = full_friction(motion, contact) * carriers.count
    pulled["load_N"] = contact.load * carriers.count
    found = _prediction(contact, (motion, still, doubts), velocity, (answer, limit), question.about)
    return replace(found, **pulled)


def _in_si(error: InputError, given: Mapping[str, object]) -> InputError:
    """An InputError about an argument of the solver, with the argument of predict and its value."""
    name = ARGUMENTS.get(error.argument)
    if name is None or given[name] is None:
        return error
    group = f"{error.value:.6g}" if isinstance(error.value, float) else shown(error.value)
    return InputError(name, given[name], f"dimensionless {group}: {error.allowed}")


@dataclass(frozen=True)
class _NoAnswer:
    """In place of a Result, where there is no contact to solve."""

    reason: str
    amplitude: float = math.nan
    mu_macro: float = math.nan
    mu_macro_error: float = math.nan
    model: str = "none"
    converged: bool = False


def unattained(question: Question, reason: str) -> Prediction:
    """The Prediction where nothing has the wanted reduction: NaN for what would follow from it."""
    contact = question.contact
    moved = question.motion, contact.mu * contact.load, ((), ())
    found = _prediction(contact, moved, math.nan, (_NoAnswer(reason), None), question.about)
    assert question.sought is not None  # as of all that can fail so
    unknown = UNKNOWN_WITHOUT[question.sought]
    settings: dict[str, Any] = {
        "sought": question.sought,
        "sought_error": math.nan,
        "load_N": contact.load,
    }
    return replace(found, **settings | dict.fromkeys(unknown, math.nan))


def _prediction(
    contact: TwoBodies,
    moved: tuple[RealMotion, float, tuple[tuple, tuple]],
    velocity: float | None,
    answers: tuple[Result | _NoAnswer, Result | None],
    understood: dict,
) -> Prediction:
    """moved: the motion, the force that it takes without vibration, warnings and what was not
    looked at.  answers: Results at the speed, and at a vanishing one or None."""
    (motion, still, (warnings, not_checked)), (answer, limit) = moved, answers
    return Prediction(
        motion=motion.name,
        contact_radius_m=contact.contact_radius,
        indentation_m=contact.indentation,
        u_lim_m=contact.u_lim,
        largest_pressure_Pa=contact.largest_pressure,
        poisson=contact.poisson,
        speed_m_s=math.nan if motion.speed is None else motion.speed,
        amplitude_si=motion.amplitude,
        forward_amplitude_m=motion.forward_amplitude,
        rotation_amplitude_rad=motion.rotation_amplitude,
        load_amplitude_N=motion.load_amplitude,
        phase_rad=motion.phase,
        pressure=contact.pressure,
        frequency_Hz=motion.frequency,
        rotation_rad_s=motion.rotation,
        velocity=None if motion.spins and not motion.amplitude else velocity,
        amplitude=answer.amplitude,
        mu_macro=answer.mu_macro,
        mu_macro_error=answer.mu_macro_error,
        mu_apparent=contact.mu * answer.mu_macro,
        mu_apparent_error=contact.mu * answer.mu_macro_error,
        friction_force_N=still * answer.mu_macro,
        friction_force_error_N=still * answer.mu_macro_error,
        friction_force_still_N=still,
        force_reduction=1.0 - answer.mu_macro,
        mu_static=None if limit is None else limit.mu_macro,
        mu_static_error=None if limit is None else limit.mu_macro_error,
        mu_static_apparent=None if limit is None else contact.mu * limit.mu_macro,
        mu_static_apparent_error=None if limit is None else contact.mu * limit.mu_macro_error,
        mu_static_reason="" if limit is None else limit.reason,
        model=answer.model,
        converged=answer.converged,
        reason=answer.reason,
        warnings=warnings,
        not_checked=not_checked,
        counterbody=understood["counterbody"],
        understood=understood,
    )
