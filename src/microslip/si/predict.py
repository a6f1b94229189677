"""Friction of a vibrated contact in SI units."""

from __future__ import annotations

import math
from collections.abc import Mapping
from inspect import signature
from typing import Any

from microslip.adaptive.point import Result
from microslip.adaptive.shakedown import shakedown
from microslip.estimate.estimate import Estimate
from microslip.foundation.errors import InputError
from microslip.motions.drive import Spring
from microslip.pressures.by_name import pressure_named
from microslip.si.drive_result import answer_of
from microslip.si.energy import energy_fields
from microslip.si.friction_map import MAP
from microslip.si.prediction import (
    Drift,
    Prediction,
    Rest,
    Sliding,
    SpinDrift,
    SteadySpin,
    columns_of,
)
from microslip.si.reduction import reduce_friction
from microslip.si.request import Request, request_of
from microslip.si.static_limit import force_threshold, static_limit
from microslip.si.uncertain import with_uncertainty
from microslip.si.validity import broken_assumptions, unchecked

MILLIMETRE = 1e-3
RUNS_AWAY = "runs away"
"""Outcome of a contact that accelerates without limit.  The solver's reason begins with these
words."""
UNKNOWN_WITHOUT = {
    "amplitude": ("amplitude_si",),
    "speed": ("speed_m_s",),
    "load": (
        *("load_N", "contact_radius_m", "indentation_m", "u_lim_m", "largest_pressure_Pa"),
        "friction_force_still_N",
    ),
}
"""Fields of a Prediction that are NaN if the search has no solution.  The keys are the quantities
that a search can determine."""


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
    hardness: object = None,
    density: object = None,
    counter_hardness: object = None,
    counter_density: object = None,
    wear_coefficient: object = None,
    tolerance: object = None,
    map: object = None,
) -> Prediction:
    """Friction of a vibrated contact of two bodies, in SI units.

    A quantity is a text of one number and one unit ("5 mm"), a pint quantity, or a number in the SI
    unit.  A text can include a standard uncertainty ("10 N +- 5 %"), except for the phase,
    densities, hardnesses and the reduction.  Any other text raises InputError.

    Parameters
    ----------
    motion : str
        "transverse", "longitudinal", "zigzag", "bore" (the sphere oscillates about the contact
        normal), "continuous-bore" (the sphere spins steadily), "elliptic", "transverse-bore",
        "normal", "file:FILE" with one period of samples with units, or another translation or
        rotation of `microslip.solve`.
    radius, load, mu : quantity
        Radius of the sphere, m; normal load, N; coefficient of friction without vibration.  For a
        file with a column `load`, the default load is the mean of this column.
    speed : quantity
        Forward speed of sliding, m/s.  With a spring, it is the speed of the far end of the
        spring.
    force : quantity
        Constant forward force, N.  It replaces the speed, which is then computed.
    young, nu : quantity
        Young's modulus, Pa, and Poisson's ratio of the body.
    material : str or Material
        Material of the body: a name, or a microslip.Material.
    counterbody : str, Material or pair of quantities, optional
        Second body: "rigid" (default), a material, or E and nu as in "70 GPa, 0.22" or (70e9,
        0.22).
    counter_radius : quantity, optional
        Radius of the counterbody, m, negative if it is hollow.  By default, the counterbody is
        flat.
    radius_across : quantity, optional
        Radius of curvature across the forward direction, m.  The contact is then an ellipse.
    contact_radius, pressure : quantity, str, optional
        `contact_radius` is half the longer side of the contact, m; it replaces all radii.
        `pressure` is a pressure of microslip.solve, such as "ring:inner=0.5" or "file:pad.csv".
        Default: "hertz".
    amplitude : quantity
        Half stroke of the oscillation: an angle for a bore, otherwise a length.  For a motion with
        several oscillations, it is the lateral half stroke.  For a file it is a factor, 1 by
        default.
    forward_amplitude, rotation_amplitude, load_amplitude, phase : quantity, optional
        For a motion with several oscillations: half strokes of the forward motion (m), the spin
        (rad) and the load (N), and the phase (rad).  The phase is that of the forward oscillation
        in "elliptic", the rotation in "transverse-bore", and the displacement in "normal".  These
        oscillations follow sin(omega t + phase).  The other oscillations follow sin(omega t).
    frequency : quantity
        Frequency of the oscillation: cyclic (Hz, cps) or angular (rad/s, deg/s, rpm, turn/s).  A
        number is in Hz.  For a file with a column `time`, the frequency follows from this column.
    rotation : quantity
        Angular speed of a continuous bore, in the units of a frequency.  A number is in rad/s.
    reduction : quantity, optional
        Requested reduction of friction, 0 to 1 or in per cent.  It replaces the amplitude, the
        speed or the load.  The answer is the smallest amplitude, the largest speed or the largest
        load that gives this reduction.  A reduction is not allowed with a force or a spring.
    drive_stiffness, mass, damping : quantity, optional
        Stiffness of a spring between the drive and the body, N/m; mass of the body, kg; damping of
        a dashpot parallel to the spring, N s/m.  A mass is also allowed with a force.
    hardness, density, counter_hardness, counter_density : quantity, optional
        Hardness and density of the body and of the counterbody.  A hardness is a pressure, Pa, or a
        text such as "700 HV" or "60 HRC".  A density is in kg/m^3.  Hardnesses and densities are
        used for warnings only.
    wear_coefficient : quantity, optional
        Wear coefficient of Archard's law, m^2/N: wear volume of a body divided by load and sliding
        distance, such as "1e-5 mm^3/N/m".
    tolerance : quantity
        Largest accepted absolute error of the ratio mu_macro.  Default: 1e-3.  Under a force, it is
        the largest accepted relative error of the speed, and the default is 1e-2.  Below one
        thousandth of the unit of speed, the error is relative to this thousandth.  The unit of
        speed is omega u_lim, or a unit defined by the motion.
    map : xarray.Dataset, optional
        Dataset of a sweep with this motion, pressure and Poisson's ratio; see `open_map`.  It
        replaces the solver: an answer takes milliseconds.  The error is the error bound of the
        map, which must be within the tolerance.

    Returns
    -------
    Prediction
        The request as understood, the answer, and warnings if an assumption of the theory is
        violated.

    Raises
    ------
    InputError
        If an input is missing, ambiguous or out of range, if the contact radius exceeds half the
        radius of a body, or if no solution has the requested reduction.  InputError is a
        ValueError.  The message names the argument, its value and the allowed values.
    """
    arguments = dict(locals())  # before any other local variable
    return predict_arguments(arguments.pop("motion"), arguments)


NOTHING: dict[str, Any] = {name: None for name in signature(predict).parameters if name != "motion"}
"""Arguments of `predict` except the motion, with their defaults."""


def predict_arguments(motion: str, arguments: Mapping[str, object]) -> Prediction:
    """The Prediction for a mapping of `predict`'s arguments.  It includes the uncertainty if any
    input is uncertain."""
    arguments = {**NOTHING, **arguments}
    request = request_of(motion, arguments)

    def request_at(changes: Mapping[str, float]) -> Request:
        return request_of(motion, {**arguments, **changes})

    return with_uncertainty(answer_request(request), request, request_at, answer_request)


def answer_request(request: Request) -> Prediction:
    """The Prediction for exact inputs."""
    parts: dict[str, Any] = {}
    if request.sought is not None:
        solution, error = reduce_friction(request)
        parts |= {"sought": request.sought, "sought_error": error}
        load = solution.contact.load
        request = solution if request.sought != "load" else request.under(load)
    request.check_range()
    limit = static_limit(request)
    threshold = force_threshold(request, limit)
    answer = answer_of(request, limit, threshold)
    if answer.model == MAP and not answer.converged:
        where = f"velocity {answer.velocity:.3g}"
        if answer.amplitude is not None:
            where += f", amplitude {answer.amplitude:.3g}"
        raise InputError("map", answer.motion, f"at {where}: {answer.reason}")
    velocity = request.groups[0]
    if velocity is None:
        unit, velocity = request.speed_unit, answer.velocity
        request = request.at(speed=velocity * unit if unit else velocity)
    parts |= _common(request, answer, threshold) | {"velocity": velocity}
    if request.motion.spins and not request.motion.amplitude:
        parts["velocity"] = None
    parts["warnings"] = tuple(broken_assumptions(request))
    parts["not_checked"] = tuple(unchecked(request.contact))
    if answer.converged:
        parts |= energy_fields(request, answer)
    if request.motion.steady:
        parts["rotation_rad_s"] = request.motion.rotation
    else:
        parts |= _oscillation(request, answer, limit)
    if request.drive.force is None:
        return SteadySpin(**parts) if request.motion.steady else Sliding(**parts)
    parts |= _under_force(request, answer, threshold)
    if request.motion.steady:
        return SpinDrift(**parts)
    if parts["outcome"] == "stays":
        return Rest(**parts, **_way_to_rest(request))
    return Drift(**parts)


def without_solution(request: Request, reason: str) -> Prediction:
    """The Prediction if a search has no solution.  Fields that depend on the solution are NaN."""
    assert request.sought is not None  # the request has a reduction
    nothing: dict[str, Any] = {"motion": request.motion.name, "pressure": request.contact.pressure}
    nothing |= {"model": "none", "reason": reason, "amplitude": math.nan, "poisson": math.nan}
    answer = Result.from_dict(nothing)
    parts = _common(request, answer, None) | _oscillation(request, answer, None)
    parts |= {"velocity": math.nan} | dict.fromkeys(UNKNOWN_WITHOUT[request.sought], math.nan)
    return Sliding(**parts, sought=request.sought, sought_error=math.nan)


def _common(request: Request, answer: Result, threshold: Estimate | None) -> dict[str, Any]:
    """Fields of every Prediction, except the velocity."""
    contact, still, friction = request.contact, request.still, answer.friction
    return {
        **columns_of("mu_macro", friction),
        **columns_of("mu_apparent", friction, contact.mu),
        **columns_of("friction_force", friction, still, "_N"),
        **columns_of("force_threshold", threshold, still, "_N"),
        "friction_force_still_N": still,
        "force_reduction": 1.0 - friction.value,
        "understood": request.understood,
        "kind": request.kind,
        "motion": request.motion.name,
        "pressure": contact.pressure,
        "contact_radius_m": contact.contact_radius,
        "indentation_m": contact.indentation,
        "largest_pressure_Pa": contact.largest_pressure,
        "u_lim_m": contact.u_lim,
        "poisson": contact.poisson,
        "load_N": contact.load,
        "speed_m_s": math.nan if request.motion.speed is None else request.motion.speed,
        "model": answer.model,
        "converged": answer.converged,
        "reason": answer.reason,
    }


def _oscillation(request: Request, answer: Result, limit: Result | None) -> dict[str, Any]:
    """Fields of the class Oscillating, which are common to all motions that oscillate."""
    motion, mu = request.motion, request.contact.mu
    fields: dict[str, Any] = {
        "amplitude_si": motion.amplitude if motion.stroke is None else None,
        "forward_amplitude_m": motion.forward_amplitude,
        "rotation_amplitude_rad": motion.rotation_amplitude,
        "load_amplitude_N": motion.load_amplitude,
        "phase_rad": motion.phase,
        "frequency_Hz": motion.frequency,
        "amplitude": answer.amplitude,
    }
    if limit is None:
        return fields
    fields |= columns_of("mu_static", limit.friction)
    fields |= columns_of("mu_static_apparent", limit.friction, mu)
    fields["mu_static_reason"] = limit.reason
    fields["displacement_per_cycle_m"] = motion.known_speed / motion.rate
    fields["displacement_per_cycle_error_m"] = 0.0
    groups = {name: one for name, one in request.drive_groups.items() if name != "force"}
    if groups:
        drive, spring = request.drive, Spring(**{"stiffness": 0.0} | groups)
        fields |= groups | {
            "drive_stiffness_N_m": drive.stiffness,
            "mass_kg": drive.mass,
            "damping_N_s_m": drive.damping,
            "natural_frequency": natural_frequency(spring),
        }
    return fields


CONTACT_STIFFNESS = 1.5
"""Stiffness 2 G* a of a sticking Hertz contact, divided by mu F_z / u_lim."""


def natural_frequency(drive: Spring) -> float | None:
    """Natural frequency of the body on its spring and the sticking contact, divided by the
    frequency of the vibration.  It is None without a mass."""
    if drive.mass == 0.0:
        return None
    return math.sqrt((drive.stiffness + CONTACT_STIFFNESS) / drive.mass)


def _under_force(request: Request, answer: Result, threshold: Estimate | None) -> dict[str, Any]:
    """Fields of a Prediction under a force."""
    force, unit, motion = request.drive.force, request.speed_unit, request.motion
    assert force is not None  # the request has a force
    velocity, error = answer.mean_velocity.value, answer.mean_velocity.error
    speed, speed_error = velocity * unit, error * unit if unit else 0.0
    group = request.drive_groups["force"]
    fields: dict[str, Any] = {"force_N": force, "force": group, "velocity_error": error}
    fields |= {"speed_error_m_s": speed_error, "outcome": _outcome(group, answer)}
    if threshold is not None:
        fields["safety_factor"] = request.still * threshold.value / force
        fields["safety_factor_error"] = request.still * threshold.error / force
    if not motion.steady:
        fields["displacement_per_cycle_m"] = speed / motion.rate
        fields["displacement_per_cycle_error_m"] = speed_error / motion.rate
    if fields["outcome"] == "moves":
        share = error / (velocity - error)  # largest relative error of a time
        ways = {"1_mm": MILLIMETRE, "contact_radius": request.contact.contact_radius}
        for name, way in ways.items():
            fields[f"time_to_{name}_s"] = way / speed
            fields[f"time_to_{name}_error_s"] = way / speed * share
    return fields


def _outcome(force: float, answer: Result) -> str | None:
    velocity, error = answer.mean_velocity.value, answer.mean_velocity.error
    if force >= 1.0 or answer.reason.startswith(RUNS_AWAY):
        return RUNS_AWAY
    if not math.isfinite(velocity):
        return None
    if velocity == error == 0.0:
        return "stays"
    return "moves" if velocity > error else "undecided"


def _way_to_rest(request: Request) -> dict[str, Any]:
    """Fields for the displacement until the contact rests, or the reason why it is unknown.

    The displacement is computed for round contacts only, because other contacts would take minutes.
    """
    contact, drive = request.contact, request.drive_groups
    if set(drive) != {"force"}:
        return {"displacement_reason": "computed without mass only"}
    if not pressure_named(contact.pressure).is_round:
        return {"displacement_reason": "computed for a round contact only"}
    point = request.solver_motion, request.groups[1], drive["force"]
    try:
        rest = shakedown(*point, **request.settings)
    except InputError as error:  # a motion that exerts a forward force by itself
        return {"displacement_reason": error.allowed}
    if not rest.converged:
        return {"displacement_reason": rest.reason}
    return {
        "displacement_m": rest.displacement * contact.u_lim,
        "displacement_error_m": rest.displacement_error * contact.u_lim,
        "cycles_to_rest": rest.most_after,
    }
