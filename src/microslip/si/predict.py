"""Friction of a vibrated contact in SI units."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import reduce
from operator import mul
from typing import Any

import numpy as np

from microslip.si.contact import Contact, contact_of
from microslip.si.inputs import INPUTS, read_inputs
from microslip.si.output import OUTPUTS, Prediction, Value
from microslip.si.solve import LOAD, answer_of, find_reduction, simplifications
from microslip.si.uncertain import Draws, probabilities, with_interval
from microslip.si.warnings import unchecked, warnings_of

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
    """Predict the friction of a vibrated contact of two bodies, in SI units.

    A quantity is a string with one number and one unit ("5 mm"), a pint quantity, or a number in
    the SI unit.  A string can include a standard uncertainty ("10 N +- 5 %").

    Parameters
    ----------
    motion : str
        "transverse", "longitudinal", "zigzag", "bore" (the sphere oscillates about the contact
        normal), "continuous-bore" (the sphere spins steadily), "elliptic", "transverse-bore",
        "normal", "file:FILE" (a file with one period of samples, with units), or another
        translation or rotation of `microslip.solve`.
    **given
        Inputs; see Other Parameters below.

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
    return predict_contact(checked_contact(motion, **given))


def _table_of_inputs() -> str:
    rows = []
    for name, one in INPUTS.items():
        kind = "text" if one.unit is None else f"quantity, {one.range}"
        rows.append(f"    {name} : {kind}\n        {one.help}.")
    return "\n".join(["", "    Other Parameters", "    ----------------", *rows, "    "])


predict.__doc__ = f"{predict.__doc__}{_table_of_inputs()}"


def checked_contact(motion: Any, **given: Any) -> Contact:
    """Return the contact for the inputs of `predict`.  Raises InputError if the inputs are invalid.

    An input that a search will determine has a placeholder value.
    """
    inputs = read_inputs(motion, **given)
    placeholders = {"amplitude": 0.0, "speed": 0.0, "load": LOAD}
    return contact_of(inputs.at(**{n: x for n, x in placeholders.items() if n == inputs.search}))


def predict_contact(contact: Contact) -> Prediction:
    """Predict the friction of a contact that `checked_contact` has returned.  Raises InputError."""
    inputs, search, about = contact.inputs, contact.inputs.search, _about(contact)
    given = about["input_values"]
    if search:
        contact, root = find_reduction(inputs)
        given[search] = replace(root, unit=given[search].unit)
    answer = answer_of(contact)
    values = outputs(contact, answer)
    if search and math.isfinite(root.error):
        moved = Contact(contact.inputs.at(**{search: root.value + root.error}))
        known = answer.values | {"velocity": Value(moved.velocity)}
        shifted = outputs(moved, replace(answer, values=known))
        changes = {name: abs(shifted[name].value - one.value) for name, one in values.items()}
        values = {n: replace(one, error=one.error + changes[n]) for n, one in values.items()}
    if inputs.uncertain:
        with np.errstate(all="ignore"):  # draws at the ends of ranges can be infinite
            draws = Draws(inputs, contact, answer)
            drawn = outputs(draws.contact, draws.answer)
            values = {n: with_interval(one, drawn[n].value) for n, one in values.items()}
            values |= probabilities(draws.contact, draws.answer)
        for name in (*inputs.uncertain, *([search] if search else ())):
            given[name] = with_interval(given[name], getattr(draws.contact.inputs, name))
    speed = values["speed"].value if "speed" in values else contact.inputs.speed
    return replace(
        answer,
        **about,
        values={name: values[name] for name in OUTPUTS if name in values},
        pressure=contact.pressure,
        remarks=tuple(_remarks(contact, answer)),
        warnings=tuple(warnings_of(contact, speed)),
        not_checked=tuple(unchecked(contact)),
    )


def unsolved(contact: Contact, reason: str) -> Prediction:
    """Return a Prediction without outputs, for a search that has no solution."""
    about, search = _about(contact), str(contact.inputs.search)
    about["input_values"][search] = Value(math.nan, math.nan, unit=contact.inputs.unit(search))
    return Prediction(**about, reason=reason)


def _about(contact: Contact) -> dict[str, Any]:
    """Return the fields of a Prediction that describe its inputs."""
    inputs, about = contact.inputs, {"motion": str(contact.kind.name)}
    values = {n: Value(x.si, None, unit=inputs.unit(n)) for n, x in inputs.quantities.items()}
    return about | {"inputs": inputs.texts, "search": inputs.search, "input_values": values}


def outputs(contact: Contact, answer: Prediction) -> dict[str, Value]:
    """Return the outputs for a contact in SI units, keyed by name.  An output is omitted if one of
    its factors is missing."""
    factors, values = factors_of(contact, answer), {}
    for name, output in OUTPUTS.items():
        names = (output.factors or name).split()
        numbers = [factors[n] if n in factors else getattr(contact, n, None) for n in names]
        if any(one is None for one in numbers):
            continue
        product: Any = reduce(mul, numbers)
        if not isinstance(product, Value):
            product = Value(product)
            if np.all(np.isnan(product.value)):
                continue
        pair = product.value, product.error
        value, error = (x if getattr(x, "shape", ()) else float(x) for x in pair)
        values[name] = Value(value, error, unit=output.unit)
    return values


def factors_of(contact: Contact, answer: Prediction) -> dict[str, Any]:
    """Return the factors from which the outputs in SI units are computed, keyed by name.  Each
    output is a product of factors.  Attributes of the contact can also be factors, but are not in
    the returned dict.  All formulas accept arrays."""
    inputs, known, mean_load = contact.inputs, answer.values, answer.values["mean_load"].value
    friction, velocity, unit = known["friction"], known["velocity"], contact.speed_unit
    still, period = contact.mu * contact.load * mean_load, 2.0 * math.pi / contact.omega
    speed = Value(inputs.speed) if inputs.force is None else velocity * unit
    factors: dict[str, Any] = contact.drive(mean_load) | known
    factors |= {"sliding_friction": still, "force_reduction": Value(1.0) + -mean_load * friction}
    factors |= {"millimetre": 1e-3, "per_area": 1.0 / contact.area}
    if contact.kind.unit == "rad" and np.all(inputs.amplitude == 0.0):
        factors["velocity"] = None
    if inputs.mass is not None and np.any(inputs.mass > 0.0) and not contact.steady:
        ratio = (factors.get("stiffness", 0.0) + STICKING) / factors["mass"]
        factors["natural_frequency"] = inputs.frequency * ratio**0.5
    with np.errstate(divide="ignore", invalid="ignore"):
        if inputs.force is not None:
            factors["speed"] = speed
            if "threshold" in known:
                most = still * known["threshold"]
                ends = (np.divide(one, inputs.force) for one in (most.value, most.error))
                factors["safety_factor"] = Value(*ends)
        if answer.outcome == "moves":
            value, error = speed.value, speed.error
            factors["pace"] = Value(1.0 / value, error / value / np.asarray(value - error))
    if not contact.steady:
        factors["displacement_per_cycle"] = speed * period
    if not answer.converged:
        return factors
    factors["drag_power"] = drag = friction * speed * still
    if "torque" in known:
        power = known["torque"] * (still * contact.contact_radius * contact.omega)
        total = drag + power
    elif "dissipation" in known:
        whole = known["dissipation"] * (still * contact.u_lim / (period * mean_load))
        # The balance contains the drag at the velocity of the result.  This velocity is smaller
        # than the requested velocity if the latter is outside the range of the solver.
        power = whole + friction * velocity * (-still * unit)
        total = replace(drag + power, error=np.maximum(whole.error, drag.error))
    else:
        return factors
    if not np.any(0.0 if inputs.damping is None else inputs.damping):
        factors["vibration_power"] = power  # a dashpot dissipates an unknown part of it
    factors |= {"dissipated_power": total, "heat": total * period}
    if inputs.wear_coefficient is not None:
        factors["worn"] = factors["heat"] * (inputs.wear_coefficient / contact.mu)  # J * m^3/J
    return factors


def _remarks(contact: Contact, answer: Prediction) -> list[str]:
    """Return explanations of outputs that could be misread."""
    inputs, known, remarks = contact.inputs, answer.values, []
    if inputs.load_amplitude and (inputs.mass is not None or inputs.drive_stiffness is not None):
        remarks.append(REFERENCE_LOADS)
    if inputs.force is None and "static" in known:
        threshold = known.get("threshold")
        if threshold is None:
            remarks.append(UNKNOWN_THRESHOLD)
        elif math.isfinite(threshold.value) and threshold.value != known["static"].value:
            remarks.append(ALONG_THE_DRIVE)
    return [*remarks, *simplifications(contact, answer)]
