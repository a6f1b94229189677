"""Torque, power and energy per cycle in SI units."""

from __future__ import annotations

from typing import Any

from microslip.adaptive.point import Result
from microslip.adaptive.vibration_power import Answer, vibration_power
from microslip.foundation.arguments import LARGEST
from microslip.foundation.errors import InputError
from microslip.pressures.by_name import pressure_named
from microslip.si.prediction import Power
from microslip.si.request import Request


def energy_fields(request: Request, answer: Result) -> dict[str, Any]:
    """Energy fields of a Prediction, for a converged answer.

    They are the power of the drag, the torque and power of a steady spin, and the power of an
    oscillation if it was requested.  Raises InputError if the power of the oscillation was
    requested under a force, with a spring, or at a speed or amplitude of 0.
    """
    contact, motion, still = request.contact, request.motion, request.still
    speed, friction = motion.known_speed, answer.friction
    speed_error = answer.mean_velocity.error * request.speed_unit if answer.force else 0.0
    drag = still * friction.value * speed
    drag_error = still * (friction.error * speed + friction.value * speed_error)
    fields: dict[str, Any] = {"drag_power_W": drag, "drag_power_error_W": drag_error}
    if answer.torque is not None:
        unit = still * contact.contact_radius * pressure_named(contact.pressure).torque
        torque, error = unit * answer.torque.value, unit * answer.torque.error
        fields |= {"torque_N_m": torque, "torque_error_N_m": error}
        power, power_error, reason = torque * motion.turn, error * motion.turn, None
    elif request.arguments["power"] and not motion.steady:
        vibration = _vibration_power(request, answer)
        unit = still * contact.u_lim * motion.turn
        power, power_error = unit * vibration.value, unit * vibration.error
        reason = vibration.reason
    else:
        return fields
    total, total_error = drag + power, drag_error + power_error
    energy = total / motion.rate, total_error / motion.rate
    return fields | {"power": Power(power, power_error, reason, total, total_error, *energy)}


def _vibration_power(request: Request, answer: Result) -> Answer:
    """The dimensionless power of an oscillation."""
    if answer.force is not None or answer.stiffness is not None:
        raise InputError("power", True, "allowed only without a force and a spring")
    velocity, size = request.groups
    if not velocity or not size:
        name = "amplitude" if velocity else "speed"
        raise InputError(name, 0.0, "allowed is above 0 with power")
    point = request.solver_motion, min(velocity, LARGEST["velocity"]), size
    return vibration_power(*point, tolerance=request.tolerance, **request.settings)
