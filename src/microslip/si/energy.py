"""Torque, power, energy per cycle and wear in SI units."""

from __future__ import annotations

import math
from typing import Any

from microslip.adaptive.point import Result
from microslip.estimate.estimate import Estimate
from microslip.pressures.by_name import pressure_named
from microslip.si.prediction import columns_of
from microslip.si.request import Request


def energy_fields(request: Request, answer: Result) -> dict[str, Any]:
    """Energy fields of a Prediction, for a converged answer.

    They are the drag power, the torque of a steady spin, and the power of the spin or oscillation.
    If a wear coefficient is given, they include the wear.
    """
    contact, motion, still = request.contact, request.motion, request.still
    speed, friction = motion.known_speed, answer.friction
    speed_error = answer.mean_velocity.error * request.speed_unit if answer.force else 0.0
    drag = still * friction.value * speed
    drag_error = still * (friction.error * speed + friction.value * speed_error)
    fields: dict[str, Any] = {"drag_power_W": drag, "drag_power_error_W": drag_error}
    if answer.torque is not None:
        unit = still * contact.contact_radius
        torque = unit * pressure_named(contact.pressure).torque * answer.torque
        fields |= columns_of("torque", torque, suffix="_N_m")
        power = motion.turn * torque
        total, total_error = drag + power.value, drag_error + power.error
    elif answer.dissipation is None:
        return fields
    else:
        power, total_error = _power_of_oscillation(request, answer)
        total, total_error = drag + power.value, max(total_error, drag_error)
    energy = 1.0 / motion.rate * Estimate(total, {"model": total_error})
    # a dashpot dissipates an unknown part of the power
    fields |= columns_of("vibration_power", None if request.drive.damping else power, suffix="_W")
    fields |= {"dissipated_power_W": total, "dissipated_power_error_W": total_error}
    fields |= columns_of("energy_per_cycle", energy, suffix="_J")
    wear = request.inputs.si("wear_coefficient")
    if wear is not None:
        area = pressure_named(contact.pressure).area * contact.contact_radius**2
        volume = wear / contact.mu * energy
        fields |= columns_of("wear_volume_per_cycle", volume, suffix="_m3")
        depth = 1.0 / area * volume
        fields |= columns_of("wear_depth_per_cycle", depth, suffix="_m")
    return fields


def _power_of_oscillation(request: Request, answer: Result) -> tuple[Estimate, float]:
    """Power of the oscillation, and the error of the dissipated power, W.

    The drag is computed at the velocity of the answer.  This velocity is smaller than the requested
    one if the requested one is outside the range of the solver.
    """
    problem, dissipation = request.problem(), answer.dissipation
    assert dissipation is not None  # checked by energy_fields
    unit = request.still * request.contact.u_lim * request.motion.turn / problem.mean_load
    advance = problem.mean_load * problem.unit_drift * answer.velocity
    drag = advance * answer.friction
    power = 1.0 / (2.0 * math.pi) * dissipation + -drag
    return unit * power, unit * dissipation.error / (2.0 * math.pi)
