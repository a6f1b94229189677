"""Friction of a vibrated contact in SI units."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from microslip.answer.answer import Estimate
from microslip.si.contact import Contact, contact_of
from microslip.si.inputs import INPUTS, Inputs, read_inputs
from microslip.si.output import OUTPUTS, Prediction, Value
from microslip.si.search import REFERENCE_LOAD, find_reduction
from microslip.si.solve import Answer, answer_of
from microslip.si.uncertain import Draws, probabilities, with_interval
from microslip.si.warnings import unchecked, warnings_of

MILLIMETRE = 1e-3
STICKING = 1.5
"""Dimensionless stiffness of a sticking Hertz contact, 2 G* a u_lim / (mu F_z)."""
REFERENCE_LOADS = (
    "stiffness, mass and damping are divided by mu times the load without oscillation (the "
    "reference load), force and mu_macro by mu times the mean load"
)
ALONG_THE_DRIVE = (
    "the static friction is not the force threshold, because the vibration is along the drive: at "
    "a prescribed speed it reverses the force, which reduces the mean; under a constant force a "
    "body without mass follows the vibration, and all of friction holds it"
)
UNKNOWN_THRESHOLD = (
    "the static friction is not the force threshold, because part of the vibration is along the "
    "drive; with a force, the prediction says whether the contact moves"
)


def predict(motion: Any, **given: Any) -> Prediction:
    """Friction of a vibrated contact of two bodies, in SI units.

    A quantity is a text of one number and one unit ("5 mm"), a pint quantity, or a number in the SI
    unit.  A text can include a standard uncertainty ("10 N +- 5 %").

    Parameters
    ----------
    motion : str
        "transverse", "longitudinal", "zigzag", "bore" (the sphere oscillates about the contact
        normal), "continuous-bore" (the sphere spins steadily), "elliptic", "transverse-bore",
        "normal", "file:FILE" with one period of samples with units, or another translation or
        rotation of `microslip.solve`.
    **given
        Inputs; see the table below.

    Returns
    -------
    Prediction
        The inputs, the outputs with error estimates, and warnings if an assumption of the theory is
        violated.

    Raises
    ------
    InputError
        If an input is missing, ambiguous or out of range, if the contact radius exceeds half the
        radius of a body, or if no solution has the requested reduction.  InputError is a
        ValueError.  The message names the argument, its value and the allowed values.
    """
    return predict_inputs(checked_inputs(motion, **given))


def _table_of_inputs() -> str:
    rows = []
    for name, one in INPUTS.items():
        kind = "text" if one.unit is None else f"quantity, {one.range}"
        rows.append(f"    {name} : {kind}\n        {one.help}.")
    return "\n".join(["", "    Inputs", "    ------", *rows, "    "])


predict.__doc__ = f"{predict.__doc__}{_table_of_inputs()}"


def checked_inputs(motion: Any, **given: Any) -> Inputs:
    """Inputs of a prediction.  Raises InputError for everything that is known before a solve."""
    inputs = read_inputs(motion, **given)
    placeholders = {"amplitude": 0.0, "speed": 0.0, "load": REFERENCE_LOAD}
    contact_of(inputs.at(**{n: x for n, x in placeholders.items() if n == inputs.search}))
    return inputs


def predict_inputs(inputs: Inputs) -> Prediction:
    """The Prediction for checked inputs.  Raises InputError."""
    contact, answer, root = solved(inputs)
    values = outputs(contact, answer)
    given = {n: Value(one.si) for n, one in inputs.quantities.items() if n in INPUTS}
    if root is not None:
        given[str(inputs.search)] = Value(root.value, root.error)
        if math.isfinite(root.error):
            shifted = Contact(contact.inputs.at(**{str(inputs.search): root.value + root.error}))
            values = {
                name: replace(one, error=one.error + abs(other.value - one.value))
                for name, one in values.items()
                if (other := outputs(shifted, answer).get(name)) is not None
            }
    if inputs.uncertain:
        with np.errstate(all="ignore"):  # draws at the ends of ranges can be infinite
            draws = Draws(inputs, contact, answer, solved)
            drawn = outputs(draws.contact, draws.answer)
            values = {n: with_interval(one, drawn[n].value) for n, one in values.items()}
            values |= probabilities(draws.contact, draws.answer)
        for name in (*inputs.uncertain, *([inputs.search] if inputs.search else ())):
            given[name] = with_interval(given[name], getattr(draws.contact.inputs, name))
    kind, speed = inputs.kind, values["speed"].value if "speed" in values else inputs.speed
    if inputs.search == "speed":
        speed = contact.inputs.speed
    return Prediction(
        values={name: values[name] for name in OUTPUTS if name in values},
        input_values=given,
        input_units={name: inputs.unit(name) for name in given},
        inputs=inputs.texts,
        motion=str(inputs.texts["motion"].split(": the sphere ")[0])
        if kind.stroke is None
        else kind.name,
        pressure=contact.pressure,
        model=answer.model,
        converged=answer.converged,
        reason=answer.reason,
        outcome=answer.outcome or None,
        search=inputs.search,
        mu_static_reason=answer.reasons.get("static", ""),
        displacement_reason=answer.reasons.get("displacement", ""),
        remarks=tuple(_remarks(contact, answer)),
        warnings=tuple(warnings_of(contact, speed)),
        not_checked=tuple(unchecked(contact)),
    )


def solved(inputs: Inputs) -> tuple[Contact, Answer, Estimate | None]:
    """The contact, its answer, and the result of a search.  Raises InputError."""
    if inputs.search is None:
        contact = contact_of(inputs)
        return contact, answer_of(contact), None
    contact, root = find_reduction(inputs)
    return contact, answer_of(contact), root


def outputs(contact: Contact, answer: Answer) -> dict[str, Value]:
    """The outputs in SI units, from the dimensionless answer.  All formulas accept arrays."""
    inputs, known = contact.inputs, answer.values
    mu, u_lim, omega, unit = contact.mu, contact.u_lim, contact.omega, contact.speed_unit
    still = mu * contact.load * known["mean_load"].value
    friction, velocity = known["friction"], known["velocity"]
    values = {
        name: Value(number)
        for name, one in OUTPUTS.items()
        if one.closed_form is not None and not np.all(np.isnan(number := one.closed_form(contact)))
    }

    def add(name: str, estimate: Estimate | None, factor: Any = 1.0) -> None:
        if estimate is not None:
            error = np.sum([abs(factor) * x for x in estimate.by_source.values()], axis=0)
            values[name] = Value(factor * estimate.value, error if np.ndim(error) else float(error))

    if not contact.steady:
        values["amplitude"] = Value(contact.amplitude)
    if not (contact.kind.unit == "rad" and np.all(inputs.amplitude == 0.0)):
        add("velocity", velocity)
    drive = contact.drive(known["mean_load"].value)
    values |= {name: Value(one) for name, one in drive.items()}
    if inputs.mass is not None and np.all(inputs.mass > 0.0) and not contact.steady:
        stiffness = drive.get("stiffness", 0.0) + STICKING
        values["natural_frequency"] = Value(inputs.frequency * np.sqrt(stiffness / drive["mass"]))
    add("mu_macro", friction)
    add("mu_apparent", friction, mu)
    add("friction_force", friction, still)
    values["sliding_friction"] = Value(still)
    values["force_reduction"] = Value(1.0 - friction.value, values["mu_macro"].error)
    add("mu_static", known.get("static"))
    add("mu_static_apparent", known.get("static"), mu)
    add("force_threshold", known.get("threshold"), still)
    rate = omega / (2.0 * math.pi)
    if inputs.force is None:
        speed = Value(inputs.speed)
    else:
        with np.errstate(divide="ignore"):
            if (threshold := known.get("threshold")) is not None:
                ratios = (
                    still * x / np.float64(inputs.force) for x in (threshold.value, threshold.error)
                )
                values["safety_factor"] = Value(*ratios)
        add("speed", velocity, unit)
        speed = values["speed"]
    if not contact.steady:
        values["displacement_per_cycle"] = Value(speed.value / rate, speed.error / rate)
    if answer.outcome == "moves":
        with np.errstate(divide="ignore", invalid="ignore"):
            share = np.asarray(speed.error / (speed.value - speed.error))  # largest relative error
            ways = {"1_mm": MILLIMETRE, "contact_radius": contact.contact_radius}
            for name, way in ways.items():
                time = way / np.asarray(speed.value)
                values[f"time_to_{name}"] = Value(_plain(time), _plain(time * share))
    add("displacement", known.get("displacement"), u_lim)
    add("cycles_to_rest", known.get("cycles"))
    if answer.converged:
        values |= _energies(contact, answer, still, speed)
    return {name: Value(_plain(one.value), _plain(one.error)) for name, one in values.items()}


def _plain(number: Any) -> Any:
    """A float for a number; arrays are unchanged."""
    return float(number) if np.ndim(number) == 0 else number


def _energies(contact: Contact, answer: Answer, still: Any, speed: Value) -> dict[str, Value]:
    """Torque, powers, energy per cycle and wear of a converged answer.

    The drag in the balance of the oscillation is computed at the velocity of the answer.  This
    velocity is smaller than the requested one if that is outside the range of the solver.
    """
    inputs, known, rate = contact.inputs, answer.values, contact.omega / (2.0 * math.pi)
    friction, velocity, unit = known["friction"], known["velocity"], contact.speed_unit
    drag = still * friction.value * speed.value
    drag_error = still * (friction.error * speed.value + friction.value * speed.error)
    values = {"drag_power": Value(drag, drag_error)}
    if "torque" in known:
        lever = still * contact.contact_radius
        torque, torque_error = (lever * x for x in (known["torque"].value, known["torque"].error))
        values["torque"] = Value(torque, torque_error)
        power, power_error = contact.omega * torque, contact.omega * torque_error
        total_error = drag_error + power_error
    elif "dissipation" in known:
        dissipation = known["dissipation"]
        scale = still * contact.u_lim * rate / known["mean_load"].value
        power = scale * dissipation.value - still * friction.value * velocity.value * unit
        total_error = np.maximum(scale * dissipation.error, drag_error)
        slip = friction.error * velocity.value + friction.value * velocity.error
        power_error = scale * dissipation.error + still * slip * unit
    else:
        return values
    total = drag + power
    if not inputs.damping:  # a dashpot dissipates an unknown part of the power
        values["vibration_power"] = Value(power, power_error)
    energy, energy_error = total / rate, total_error / rate
    values |= {"dissipated_power": Value(total, total_error)}
    values |= {"energy_per_cycle": Value(energy, energy_error)}
    if inputs.wear_coefficient is not None:
        volume = inputs.wear_coefficient / contact.mu
        for name, factor in (("volume", volume), ("depth", volume / contact.area)):
            values[f"wear_{name}_per_cycle"] = Value(factor * energy, factor * energy_error)
    return values


def _remarks(contact: Contact, answer: Answer) -> list[str]:
    """Explanations of outputs that could be misread."""
    inputs, known, remarks = contact.inputs, answer.values, []
    if inputs.load_amplitude and (inputs.mass is not None or inputs.drive_stiffness is not None):
        remarks.append(REFERENCE_LOADS)
    if inputs.force is None and "static" in known:
        threshold = known.get("threshold")
        if threshold is None and contact.kind.along:
            remarks.append(UNKNOWN_THRESHOLD)
        elif threshold is not None and threshold.value != known["static"].value:
            remarks.append(ALONG_THE_DRIVE)
    return remarks
