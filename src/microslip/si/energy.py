"""Torque, powers and the energy that a cycle costs, in SI units."""

from __future__ import annotations

import math
from typing import Any

from microslip.adaptive.point import Result
from microslip.adaptive.vibration_power import vibration_power
from microslip.foundation.arguments import LARGEST
from microslip.foundation.errors import InputError
from microslip.pressures.by_name import pressure_named
from microslip.si.bodies import TwoBodies
from microslip.si.dimensionless import (
    RealMotion,
    full_friction,
    groups,
    solver_motion,
    speed_unit,
)


def energy_fields(
    contact: TwoBodies, motion: RealMotion, answer: Result, contacts: int = 1
) -> dict:
    """Fields of a Prediction that follow from the answer: drag, of all contacts together, and
    torque of a steady spin."""
    still = full_friction(motion, contact) * contacts
    speed_error = 0.0
    if answer.force is not None:
        assert answer.velocity_error is not None  # as under all forces
        speed_error = answer.velocity_error * speed_unit(motion, contact)
    drag = still * answer.mu_macro * motion.known_speed
    drag_error = still * (
        answer.mu_macro_error * motion.known_speed + answer.mu_macro * speed_error
    )
    found = {"drag_power_W": drag, "drag_power_error_W": drag_error}
    if answer.torque is None:
        return found
    unit = still * contact.contact_radius * pressure_named(contact.pressure).torque
    torque = unit * answer.torque.value
    spin, spin_error = torque * motion.turn, unit * answer.torque.error * motion.turn
    turn = 2.0 * math.pi / motion.turn
    return found | {
        "torque_N_m": torque,
        "torque_error_N_m": unit * answer.torque.error,
        "vibration_power_W": spin,
        "vibration_power_error_W": spin_error,
        "dissipated_power_W": drag + spin,
        "dissipated_power_error_W": drag_error + spin_error,
        "energy_per_cycle_J": (drag + spin) * turn,
        "energy_per_cycle_error_J": (drag_error + spin_error) * turn,
    }


def vibration_fields(
    contact: TwoBodies, motion: RealMotion, answer: Result, tolerance: float
) -> dict:
    """... and what it takes to vibrate the contact, which the solver is asked for.

    Raises InputError where nothing slides on and on, or the pull is no speed.
    """
    if motion.steady:
        return {}
    if answer.force is not None or answer.stiffness is not None:
        raise InputError("power", True, "allowed where a speed alone pulls")
    velocity, size = groups(motion, contact)
    if not velocity or not size:
        name = "amplitude" if velocity else "speed"
        raise InputError(name, 0.0, "allowed is more than 0 where the power is asked for")
    point = min(velocity, LARGEST["velocity"]), size
    settings: dict[str, Any] = {
        "poisson": contact.poisson,
        "pressure": contact.pressure,
        "tolerance": tolerance,
    }
    found = vibration_power(solver_motion(motion, contact), *point, **settings)
    still = full_friction(motion, contact)
    frequency = motion.frequency
    assert frequency is not None  # as of all that oscillate
    unit = still * contact.u_lim * 2.0 * math.pi * frequency
    drag = still * answer.mu_macro * motion.known_speed
    total = drag + unit * found.value
    error = still * answer.mu_macro_error * motion.known_speed + unit * found.error
    return {
        "vibration_power_W": unit * found.value,
        "vibration_power_error_W": unit * found.error,
        "vibration_power_reason": found.reason,
        "dissipated_power_W": total,
        "dissipated_power_error_W": error,
        "energy_per_cycle_J": total / frequency,
        "energy_per_cycle_error_J": error / frequency,
    }
