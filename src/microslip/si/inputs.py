"""Read and check the inputs of a prediction: the bodies, the contact, the motion and the drive."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, NamedTuple

from microslip.foundation.errors import InputError
from microslip.si.bodies import TwoBodies
from microslip.si.dimensionless import RealDrive, RealMotion
from microslip.si.hardness import read_hardness
from microslip.si.materials import RIGID, Material, material_named
from microslip.si.motions import PARTS, kind_of
from microslip.si.quantities import Quantity, read
from microslip.si.shapes import elliptic, of_size
from microslip.si.validity import SENSELESS

LARGEST_MU = 10.0
"""Largest accepted coefficient of friction.  Real elastic contacts have smaller coefficients."""
LARGEST_PHASE = 1e3
"""Largest accepted phase, rad."""
OUT_OF_RANGE = "outside the range of floating-point numbers; allowed are sizes of real bodies"
EXAMPLE = "E and nu as in '70 GPa, 0.22', with a point before decimals"


class Range(NamedTuple):
    """SI unit of a quantity, and the range of its allowed values."""

    unit: str
    low: float = 0.0
    low_open: bool = True
    high: float = math.inf


QUANTITIES = {
    "mu": Range("", high=LARGEST_MU),
    "load": Range("N"),
    "radius": Range("m"),
    "counter_radius": Range("m", low=-math.inf),
    "radius_across": Range("m"),
    "contact_radius": Range("m"),
    "speed": Range("m/s", low_open=False),
    "young": Range("Pa"),
    "nu": Range("", low_open=False, high=0.5),
    "force": Range("N"),
    "amplitude": Range("m", low_open=False),
    "forward_amplitude": Range("m", low_open=False),
    "rotation_amplitude": Range("rad", low_open=False),
    "load_amplitude": Range("N"),
    "frequency": Range("Hz"),
    "rotation": Range("rad/s"),
    "drive_stiffness": Range("N/m"),
    "mass": Range("kg", low_open=False),
    "damping": Range("N*s/m", low_open=False),
    "phase": Range("rad", low=-LARGEST_PHASE),
    "density": Range("kg/m^3"),
    "counter_density": Range("kg/m^3"),
    "reduction": Range("", high=1.0),
    "wear_coefficient": Range("m^2/N", low_open=False),
}
"""Units and ranges of the quantities among `predict`'s arguments; see also `unit_of`."""


def unit_of(name: str, motion: object) -> str:
    """SI unit of an argument listed in QUANTITIES.  The unit of the amplitude depends on the
    motion."""
    unit = kind_of(motion).unit if name == "amplitude" else None
    return QUANTITIES[name].unit if unit is None else unit


def read_argument(
    name: str, value: object, motion: str | None = None, title: str | None = None
) -> Quantity:
    """Read an argument listed in QUANTITIES and check its range.  Raises InputError.

    motion: motion of the request, for its amplitude; title: name of the argument in messages.
    """
    allowed = QUANTITIES[name]
    if motion is not None:
        allowed = allowed._replace(unit=unit_of(name, motion))
    return read(title or name, value, **allowed._asdict())


MOTION_ARGUMENTS = ("rotation", *PARTS, "phase", "frequency")
"""Arguments of `predict` that describe the motion, except the speed."""
DRIVE_FIELDS = {
    "force": "force",
    "drive_stiffness": "stiffness",
    "mass": "mass",
    "damping": "damping",
}
"""Fields of RealDrive, keyed by the corresponding argument of `predict`.  The speed is not
included."""
OF_CONTACT = (
    *("mu", "load", "radius", "counter_radius", "radius_across", "contact_radius", "pressure"),
    *("young", "nu", "material", "counterbody", "hardness", "density"),
    *("counter_hardness", "counter_density"),
)
"""Arguments of `predict` that describe a contact."""
SPREAD = re.compile(r"(.*?)\s*(?:\+-|\+/-|±)\s*(.*)", re.S)
"""Pattern of a quantity with its standard uncertainty."""
EXACT = ("phase", "density", "counter_density", "reduction")
"""Quantities that are always exact."""
HARDNESSES = ("hardness", "counter_hardness")
OF_BODIES = ("young", "nu", "density", "counter_density", *HARDNESSES, "wear_coefficient")
"""Quantities that are not listed in Inputs.texts, because the texts of the bodies contain them."""


def read_uncertain(name: str, value: object, motion: str) -> Quantity:
    """Read an argument such as "10 N", or one with a standard uncertainty such as "10 N +- 5 %".
    Raises InputError."""
    match = SPREAD.fullmatch(value) if isinstance(value, str) and name not in EXACT else None
    if match is None:
        return read_argument(name, value, motion)
    text, spread = match.groups()
    try:
        centre = read_argument(name, text, motion).si
        if spread.endswith("%") and not text.endswith("%"):
            deviation = abs(centre) * read(name, spread, "", low_open=False).si
        else:
            deviation = read(name, spread, unit_of(name, motion), low_open=False).si
    except InputError as error:
        allowed = f"in it {error.value!r}: {error.allowed}, as in '10 N +- 5 %'"
        raise InputError(name, value, allowed) from None
    if not deviation < abs(centre):
        raise InputError(name, value, "allowed is an uncertainty below the value")
    return Quantity(centre, " ".join(match[0].split()), deviation)


class Body(NamedTuple):
    """A material, and its properties as the user wrote them."""

    material: Material
    text: str


@dataclass(frozen=True)
class Inputs:
    """Arguments of `predict`, and the quantities and bodies read from them.

    Attributes
    ----------
    arguments : mapping
        The arguments as the user wrote them.  A missing argument is None.
    quantities : dict of Quantity
        The quantities that are not missing.
    bodies : tuple of Body
        The body and the counterbody.
    """

    arguments: Mapping[str, Any]
    quantities: dict[str, Quantity]
    bodies: tuple[Body, Body]

    def si(self, name: str) -> float | None:
        """A quantity in its SI unit; None if it is missing."""
        return self.quantities[name].si if name in self.quantities else None

    def needed(self, name: str) -> float:
        """A required quantity in its SI unit.  Raises InputError if it is missing."""
        if name not in self.quantities:
            raise InputError(name, None, "needed")
        return self.quantities[name].si

    def error(self, name: str, allowed: str) -> InputError:
        """The InputError for an argument."""
        return InputError(name, self.arguments[name], allowed)

    @property
    def texts(self) -> dict[str, str]:
        """The bodies, the pressure and the quantities as text, by the name of the argument."""
        texts = {"body": self.bodies[0].text, "counterbody": self.bodies[1].text}
        texts |= {name: q.text for name, q in self.quantities.items() if name not in OF_BODIES}
        if self.arguments["contact_radius"] is not None:
            texts["pressure"] = self.arguments["pressure"] or "hertz"
        elif "counter_radius" not in texts:
            texts["counter_radius"] = "flat (default)"
        elif self.quantities["counter_radius"].si < 0.0:
            texts["counter_radius"] += ", hollow"
        return texts


def read_inputs(arguments: Mapping[str, Any], motion: str | None = None) -> Inputs:
    """Read the quantities and the bodies.  Raises InputError.

    motion: motion of a request, whose quantities can be uncertain; None for a contact without a
    motion, whose quantities are exact.
    """
    arguments = {**dict.fromkeys(OF_CONTACT), **arguments}
    values = {name: value for name, value in arguments.items() if value is not None}
    reader = read_argument if motion is None else partial(read_uncertain, motion=motion)
    quantities = {n: reader(n, values[n]) for n in QUANTITIES if n in values}
    quantities |= {n: read_hardness(n, values[n]) for n in HARDNESSES if n in values}
    body, other = _body(arguments, quantities), _counterbody(arguments["counterbody"])
    bodies = _with_properties(body, "", quantities), _with_properties(other, "counter_", quantities)
    return Inputs(arguments, quantities, bodies)


def _with_properties(body: Body, side: str, quantities: Mapping[str, Quantity]) -> Body:
    """The body with its hardness and density.  side: "counter_" for the counterbody, else
    empty."""
    for name in ("hardness", "density"):
        argument = f"{side}{name}"
        if argument not in quantities:
            continue
        number, text = quantities[argument].si, quantities[argument].text
        if body.material.rigid:
            raise InputError(argument, text, "allowed for an elastic body, not a rigid one")
        changes: dict[str, Any] = {name: number}
        body = Body(replace(body.material, **changes), f"{body.text}, {name} {text}")
    return body


def _body(arguments: Mapping[str, Any], quantities: Mapping[str, Quantity]) -> Body:
    material, names = arguments["material"], ("young", "nu")
    if material is None:
        for name in names:
            if name not in quantities:
                raise InputError(name, None, "needed, or a material")
        return _elastic(quantities["young"], quantities["nu"])
    if any(name in quantities for name in names):
        raise InputError("material", material, "allowed only without young and nu")
    try:
        return _of_material(material.strip() if isinstance(material, str) else material)
    except InputError as error:
        other = "" if isinstance(material, str) else ", or a Material"
        raise InputError("material", material, f"{error.allowed}{other}") from None


def _counterbody(body: Any) -> Body:
    """The counterbody.  body: a Material, a name, "E, nu", a pair (E, nu), or None for a rigid
    body."""
    if body is None:
        return Body(RIGID, "rigid (default)")
    pair = isinstance(body, tuple | list)
    if not (pair or isinstance(body, str | Material)):
        allowed = f"allowed is a text, {EXAMPLE}, a pair of both, or a Material"
        raise InputError("counterbody", body, allowed)
    parts = list(body) if pair else [body]
    if isinstance(body, str):
        parts = [part.strip() for part in body.split(",")]
    try:
        if len(parts) == 1 and not pair:
            return _of_material(parts[0])
        if len(parts) == 2:
            young = read_argument("young", parts[0], title="Young's modulus")
            return _elastic(young, read_argument("nu", parts[1], title="Poisson's ratio"))
    except InputError as error:
        problem = f"{error.allowed}, or {EXAMPLE}"
        if len(parts) == 2:
            problem = f"its {error.argument} {error.value!r}: {error.allowed}, as in '70 GPa, 0.22'"
        raise InputError("counterbody", body, problem) from None
    count = f"{len(parts)} values" if pair else f"{len(parts) - 1} commas in it"
    raise InputError("counterbody", body, f"{count}; allowed: {EXAMPLE}")


def _elastic(young: Quantity, nu: Quantity) -> Body:
    return Body(Material(young.si, nu.si), f"E = {young.text}, nu = {nu.text}")


def _of_material(name: Any) -> Body:
    """The body made of a Material, or of the material with this name."""
    if isinstance(name, Material):
        return Body(name, _numbers(name))
    body = material_named(name)
    return Body(body, name if body.rigid else f"{name} ({_numbers(body)})")


def _numbers(body: Material) -> str:
    """The properties of a material in one line."""
    if body.rigid:
        return "rigid"
    parts = [f"E = {body.young / 1e9:.6g} GPa", f"nu = {body.poisson:g}"]
    if body.hardness is not None:
        parts.append(f"hardness {body.hardness / 1e9:.6g} GPa")
    if body.density is not None:
        parts.append(f"density {body.density:.6g} kg/m^3")
    return ", ".join(parts)


def contact_of(inputs: Inputs, load: float | None = None) -> TwoBodies:
    """The contact of the bodies.

    Parameters
    ----------
    inputs : Inputs
        The bodies, the shape of the contact, mu and the load.
    load : float or None
        Load, N, if it is not that of the inputs.

    Raises
    ------
    InputError
        If an argument is missing or not allowed, or if Hertz's theory does not apply to the
        contact.
    """
    arguments, (body, counterbody) = inputs.arguments, (one.material for one in inputs.bodies)
    mu, load = inputs.needed("mu"), inputs.needed("load") if load is None else load
    sized = arguments["pressure"] is not None or arguments["contact_radius"] is not None
    if sized:
        _check_without_radii(arguments)
    elif arguments["radius"] is None:
        raise InputError("radius", None, "needed, or a contact_radius")
    radii = () if sized else _radii(inputs)
    radius = 1.0 / sum(1.0 / one for one in radii) if radii else 1.0
    plain = TwoBodies(body, counterbody, radius, load, mu, radii)
    if sized:
        return _of_size(inputs, plain)
    _check_hertzian(plain, "counter_radius", inputs)
    across = inputs.si("radius_across")
    if across is None:
        return plain
    if "counter_radius" in inputs.quantities:
        allowed = "allowed only without a counter_radius: give the radii of relative curvature"
        raise inputs.error("radius_across", allowed)
    try:
        contact = elliptic(plain, across)
    except InputError as error:
        raise error.renamed("radius_across", arguments["radius_across"]) from None
    _check_hertzian(contact, "radius_across", inputs)
    return contact


def _check_without_radii(arguments: Mapping[str, Any]) -> None:
    """Raise InputError unless the arguments contain a size and no radii."""
    for name in ("radius", "counter_radius", "radius_across"):
        if arguments[name] is not None:
            cause = "a contact_radius"
            if arguments["contact_radius"] is None:
                cause = "a pressure, which needs a contact_radius in place of radii"
            raise InputError(name, arguments[name], f"allowed only without {cause}")
    if arguments["contact_radius"] is None:
        allowed = "needed with a pressure: half the longer side of the contact"
        raise InputError("contact_radius", None, allowed)


def _of_size(inputs: Inputs, plain: TwoBodies) -> TwoBodies:
    """A contact with a prescribed size and pressure; raises InputError.

    plain: the bodies and the load, with an arbitrary radius.
    """
    size = inputs.quantities["contact_radius"].si
    try:
        contact = of_size(plain, size, inputs.texts["pressure"])
        sizes = (contact.u_lim, contact.load / size**2)
        good = all(0.0 < one < math.inf for one in sizes) and contact.largest_pressure > 0.0
    except (ArithmeticError, ValueError) as error:
        if isinstance(error, InputError) and error.argument == "pressure":
            raise
        good = False
    if not good:
        raise inputs.error("contact_radius", OUT_OF_RANGE)
    return contact


def _radii(inputs: Inputs) -> tuple[float, float]:
    """Radii of the sphere and of the counterbody, m.  The radius of a flat counterbody is
    infinite."""
    radius, counter = inputs.quantities["radius"].si, inputs.si("counter_radius")
    if counter == 0.0:
        raise inputs.error("counter_radius", "allowed is a radius other than 0")
    counter = math.inf if counter is None else counter
    for name, one in (("radius", radius), ("counter_radius", counter)):
        if math.isinf(1.0 / one):
            raise inputs.error(name, OUT_OF_RANGE)
    curvature = 1.0 / radius + 1.0 / counter
    if math.isinf(curvature):
        raise inputs.error("counter_radius", OUT_OF_RANGE)
    if not curvature > 0.0:
        allowed = "allowed is a hollow with a larger radius than the sphere"
        raise inputs.error("counter_radius", allowed)
    return radius, counter


def _check_hertzian(contact: TwoBodies, second: str, inputs: Inputs) -> None:
    """Raise InputError if Hertz's theory does not apply to a contact.

    second: argument with the second radius.
    """
    try:
        a, smallest = contact.contact_radius, contact.smallest_radius
        if a >= SENSELESS * smallest:
            raise inputs.error(
                "radius" if smallest == abs(contact.radii[0]) else second,
                f"by Hertz's theory, which is for contacts much smaller than either body, the "
                f"contact radius would be {a:.3g} m, {a / smallest:.2g} of this radius; allowed is "
                f"less than {SENSELESS:g}",
            )
        sizes = (a, contact.indentation, contact.u_lim, contact.largest_pressure)
        good = all(0.0 < size < math.inf for size in sizes)
    except ArithmeticError:
        good = False
    if not good:
        load = inputs.arguments["load"] or contact.load  # of a search for the load
        raise InputError("load", load, f"with these bodies and radii, {OUT_OF_RANGE}")


def with_stroke(motion: str, arguments: Mapping[str, Any]) -> dict[str, Any]:
    """Fill in a missing amplitude, frequency or load for a motion from a file.  Raises InputError
    if a frequency is specified although the file has a column `time`."""
    stroke = kind_of(motion).stroke
    if stroke is None:
        return dict(arguments)
    if stroke.frequency is not None and arguments["frequency"] is not None:
        allowed = "allowed only without a column time, which contains the frequency"
        raise InputError("frequency", arguments["frequency"], allowed)
    own = {"amplitude": 1.0, "frequency": stroke.frequency, "load": stroke.mean_load}
    return {name: own.get(name) if value is None else value for name, value in arguments.items()}


def check_motion_and_drive(motion: str, arguments: Mapping[str, Any], sought: str | None) -> None:
    """Raise InputError if an argument of the motion or the drive is missing or not allowed.

    sought: name of the quantity that a search determines, or None.  This quantity may be missing.
    """
    kind = kind_of(motion)
    refused = {
        name: f"{motion} has none"
        for name in MOTION_ARGUMENTS
        if name not in (*kind.needed, *kind.optional)
    }
    missing = dict.fromkeys(("mu", "load"), "needed")
    missing |= dict.fromkeys(kind.needed, f"{motion} needs it")
    if arguments["force"] is None:
        missing["speed"] = "needed, or a force"
    elif arguments["speed"] is not None:
        raise InputError("force", arguments["force"], "allowed is a force or a speed, not both")
    if kind.steady:
        which = f"allowed only for a motion that oscillates; {motion} is steady"
        refused |= dict.fromkeys(("drive_stiffness", "mass", "damping"), which)
    elif arguments["force"] is not None:
        which = "allowed only without a force"
        refused |= dict.fromkeys(("drive_stiffness", "damping"), which)
    elif arguments["drive_stiffness"] is None:
        refused["mass"] = "allowed only with a force or a drive_stiffness"
        refused["damping"] = "allowed only with a drive_stiffness"
    for name, allowed in refused.items():
        if arguments[name] is not None:
            raise InputError(name, arguments[name], allowed)
    _refuse_missing({n: text for n, text in missing.items() if n != sought}, arguments)


def _refuse_missing(needed: Mapping[str, str], arguments: Mapping[str, Any]) -> None:
    """Raise InputError for the first of the needed arguments that is missing.  The message names
    all others that are missing, including those of the bodies and the size."""
    missing = [name for name in needed if arguments[name] is None]
    if not missing:
        return
    if all(arguments[name] is None for name in ("radius", "contact_radius", "pressure")):
        missing.append("radius")
    if arguments["material"] is None:
        missing += [name for name in ("young", "nu") if arguments[name] is None]
    first, *others = missing
    also = f"; also missing: {', '.join(others)}" if others else ""
    raise InputError(first, None, f"{needed[first]}{also}")


def motion_of(motion: str, inputs: Inputs) -> RealMotion:
    """The motion; raises InputError."""
    kind = kind_of(motion)
    if kind.several and kind.stroke is None and not any(map(inputs.si, PARTS)):
        allowed = "allowed is a value above 0 if no other amplitude is above 0"
        raise inputs.error(kind.needed[0], allowed)
    values: dict[str, Any] = {name: inputs.si(name) for name in ("speed", *MOTION_ARGUMENTS)}
    name = motion if kind.stroke is None else kind.stroke.name
    return RealMotion(name, kind.unit, **values, stroke=kind.stroke)


def drive_of(motion: str, inputs: Inputs) -> RealDrive:
    """The drive; raises InputError."""
    drive = RealDrive(**{field: inputs.si(name) for name, field in DRIVE_FIELDS.items()})
    if drive.stiffness is not None and motion == "longitudinal" and inputs.si("speed") == 0.0:
        allowed = "allowed is a speed above 0 for a longitudinal motion with a spring"
        raise inputs.error("speed", allowed)
    return drive
