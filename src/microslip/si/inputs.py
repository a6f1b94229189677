"""Read and check the inputs of a prediction: the bodies, the contact, the motion and the drive."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

from microslip.foundation.errors import InputError
from microslip.foundation.named_files import speaks_of_file
from microslip.si.bodies import TwoBodies
from microslip.si.dimensionless import RealDrive, RealMotion
from microslip.si.hardness import read_hardness
from microslip.si.materials import RIGID, Material, material_named
from microslip.si.motions import PARTS, kind_of
from microslip.si.quantities import Quantity, read
from microslip.si.shapes import elliptic, of_size
from microslip.si.strokes import Stroke, read_stroke
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
    unit, *limits = QUANTITIES[name]
    ranges: dict[str, Any] = dict(zip(Range._fields[1:], limits, strict=True))
    return read(title or name, value, unit if motion is None else unit_of(name, motion), **ranges)


Arguments = Mapping[str, Any]
"""Mapping of `predict`'s arguments, by name.  A missing argument is None."""


class Body(NamedTuple):
    """A material, and its properties as the user wrote them."""

    material: Material
    text: str


def read_bodies(arguments: Arguments) -> tuple[Body, Body]:
    """The body and the counterbody; raises InputError."""
    body = _body(*(arguments[name] for name in ("young", "nu", "material")))
    return _completed(body, "", arguments), _completed(
        _counterbody(arguments["counterbody"]), "counter_", arguments
    )


def _completed(body: Body, side: str, arguments: Arguments) -> Body:
    """The body with its hardness and density.  side: "counter_" for the counterbody, else
    empty."""
    for name in ("hardness", "density"):
        argument, value = f"{side}{name}", arguments[f"{side}{name}"]
        if value is None:
            continue
        if body.material.rigid:
            raise InputError(argument, value, "allowed for an elastic body, not a rigid one")
        one = (read_hardness if name == "hardness" else read_argument)(argument, value)
        number: dict[str, Any] = {name: one.si}
        body = Body(replace(body.material, **number), f"{body.text}, {name} {one.text}")
    return body


def _body(young: object, nu: object, material: Any) -> Body:
    if material is None:
        for name, value in (("young", young), ("nu", nu)):
            if value is None:
                raise InputError(name, None, "needed, or a material")
        return _elastic(read_argument("young", young), read_argument("nu", nu))
    if young is not None or nu is not None:
        raise InputError("material", material, "allowed only without young and nu")
    if isinstance(material, Material):
        return Body(material, _numbers(material))
    try:
        return _named(material.strip() if isinstance(material, str) else material)
    except InputError as error:
        other = "" if isinstance(material, str) else ", or a Material"
        raise InputError("material", material, f"{error.allowed}{other}") from None


def _counterbody(body: Any) -> Body:
    """The counterbody.  body: a Material, a name, "E, nu", a pair (E, nu), or None for a rigid
    body."""
    if body is None:
        return Body(RIGID, "rigid (default)")
    if isinstance(body, Material):
        return Body(body, _numbers(body))
    pair = isinstance(body, tuple | list)
    if not (pair or isinstance(body, str)):
        allowed = f"allowed is a text, {EXAMPLE}, a pair of both, or a Material"
        raise InputError("counterbody", body, allowed)
    parts = list(body) if pair else [part.strip() for part in body.split(",")]
    try:
        if len(parts) == 1 and not pair:
            return _named(parts[0])
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


def _named(name: Any) -> Body:
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


def read_contact(
    bodies: tuple[Body, Body], arguments: Arguments, *, load: object, contacts: int = 1
) -> tuple[TwoBodies, dict[str, str]]:
    """The contact, and a dict with the text of each argument.

    Parameters
    ----------
    bodies : tuple of Body
        The body and the counterbody.
    arguments : mapping
        Arguments of `predict`.  This function reads the shape and mu.
    load : quantity
        Total load of all contacts.
    contacts : int
        Number of contacts.  The returned contact has the mean load.

    Raises
    ------
    InputError
        If an argument is missing or not allowed, or if Hertz's theory does not apply to the
        contact.
    """
    sized = arguments["pressure"] is not None or arguments["contact_radius"] is not None
    if sized:
        _check_without_radii(arguments)
    elif arguments["radius"] is None:
        raise InputError("radius", None, "needed, or a contact_radius")
    name = "contact_radius" if sized else "radius"
    size = read_argument(name, arguments[name])
    force, mu = read_argument("load", load), read_argument("mu", arguments["mu"])
    materials = bodies[0].material, bodies[1].material
    radii, texts = ((), {}) if sized else _radii(size.si, arguments)
    if materials[0].rigid and materials[1].rigid:
        allowed = "allowed is an elastic body where the counterbody is rigid"
        raise InputError("material", "rigid", allowed)
    radius = 1.0 / sum(1.0 / one for one in radii) if radii else 1.0
    plain = TwoBodies(*materials, radius, force.si / contacts, mu.si, radii)
    texts = {"body": bodies[0].text, "counterbody": bodies[1].text} | texts
    texts[name] = size.text
    pressure = "hertz" if arguments["pressure"] is None else arguments["pressure"]
    if sized:
        texts["pressure"] = pressure
    texts |= {"load": force.text, "mu": mu.text}
    if sized:
        return _of_size(plain, size.si, pressure, arguments[name]), texts
    _check_hertzian(plain, arguments["counter_radius"], arguments, load)
    across = arguments["radius_across"]
    if across is None:
        return plain, texts
    if arguments["counter_radius"] is not None:
        allowed = "allowed only without a counter_radius: give the radii of relative curvature"
        raise InputError("radius_across", across, allowed)
    second = read_argument("radius_across", across)
    try:
        contact = elliptic(plain, second.si)
    except InputError as error:
        raise error.renamed("radius_across", across) from None
    _check_hertzian(contact, across, arguments, load)
    return contact, texts | {"radius_across": second.text}


def _check_without_radii(arguments: Arguments) -> None:
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


def _of_size(plain: TwoBodies, size: float, pressure: str, argument: object) -> TwoBodies:
    """A contact with a prescribed size and pressure; raises InputError.

    Parameters
    ----------
    plain : TwoBodies
        The bodies and the load.  The radius is ignored.
    size : float
        Half the longer side of the contact, m.
    pressure : str
        Name of the pressure.
    argument : object
        The size as the user wrote it, for messages.
    """
    try:
        contact = of_size(plain, size, pressure)
        sizes = (contact.u_lim, contact.load / size**2)
        good = all(0.0 < one < math.inf for one in sizes) and contact.largest_pressure > 0.0
    except (ArithmeticError, ValueError) as error:
        if isinstance(error, InputError) and error.argument == "pressure":
            raise
        good = False
    if not good:
        raise InputError("contact_radius", argument, OUT_OF_RANGE)
    return contact


def _radii(radius: float, arguments: Arguments) -> tuple[tuple[float, float], dict[str, str]]:
    """Radii of the sphere and of the counterbody, m, and their texts.  The radius of a flat
    counterbody is infinite."""
    text, counter, argument = "flat (default)", math.inf, arguments["counter_radius"]
    if argument is not None:
        second = read_argument("counter_radius", argument)
        if second.si == 0.0:
            raise InputError("counter_radius", argument, "allowed is a radius other than 0")
        text = f"{second.text}, hollow" if second.si < 0.0 else second.text
        counter = second.si
    for name, one in (("radius", radius), ("counter_radius", counter)):
        if math.isinf(1.0 / one):
            raise InputError(name, arguments[name], OUT_OF_RANGE)
    curvature = 1.0 / radius + 1.0 / counter
    if math.isinf(curvature):
        raise InputError("counter_radius", argument, OUT_OF_RANGE)
    if not curvature > 0.0:
        allowed = "allowed is a hollow with a larger radius than the sphere"
        raise InputError("counter_radius", argument, allowed)
    return (radius, counter), {"counter_radius": text}


def _check_hertzian(contact: TwoBodies, second: object, arguments: Arguments, load: object) -> None:
    """Raise InputError if Hertz's theory does not apply to a contact.

    second: counter_radius or radius_across as the user wrote it.
    """
    try:
        a, smallest = contact.contact_radius, contact.smallest_radius
        if a >= SENSELESS * smallest:
            name, value = "counter_radius", second
            if smallest == abs(contact.radii[0]):
                name, value = "radius", arguments["radius"]
            raise InputError(
                name,
                value,
                f"by Hertz's theory, which is for contacts much smaller than either body, the "
                f"contact radius would be {a:.3g} m, {a / smallest:.2g} of this radius; allowed is "
                f"less than {SENSELESS:g}",
            )
        sizes = (a, contact.indentation, contact.u_lim, contact.largest_pressure)
        good = all(0.0 < size < math.inf for size in sizes)
    except ArithmeticError:
        good = False
    if not good:
        raise InputError("load", load, f"with these bodies and radii, {OUT_OF_RANGE}")


def with_stroke(stroke: Stroke, arguments: Arguments) -> Arguments:
    """Fill in a missing amplitude, frequency or load for a stroke from a file.  Raises InputError
    if a frequency is specified although the file has a column `time`."""
    if stroke.frequency is not None and arguments["frequency"] is not None:
        allowed = "allowed only without a column time, which contains the frequency"
        raise InputError("frequency", arguments["frequency"], allowed)
    own = {"amplitude": 1.0, "frequency": stroke.frequency, "load": stroke.mean_load}
    return {name: own.get(name) if value is None else value for name, value in arguments.items()}


def read_motion(
    motion: str, arguments: Arguments, sought: str | None
) -> tuple[RealMotion, dict[str, str]]:
    """The motion, and a dict with the text of each argument.  Raises InputError.

    sought: name of the quantity that a search determines, or None.  This quantity and the speed may
    be missing.
    """
    kind = kind_of(motion)
    for name in MOTION_ARGUMENTS:
        if name not in (*kind.needed, *kind.optional) and arguments[name] is not None:
            raise InputError(name, arguments[name], f"{motion} has none")
    for name in kind.needed:
        if arguments[name] is None and name != sought:
            raise InputError(name, None, f"{motion} needs it")
    stroke = read_stroke(motion) if speaks_of_file(motion) else None
    quantities = {
        name: read_argument(name, arguments[name], motion)
        for name in ("speed", *MOTION_ARGUMENTS)
        if arguments[name] is not None
    }
    values: dict[str, Any] = {"speed": None} | {name: one.si for name, one in quantities.items()}
    if kind.several and stroke is None and not any(values.get(name) for name in PARTS):
        allowed = "allowed is above 0 where no other amplitude is"
        raise InputError(kind.needed[0], arguments[kind.needed[0]], allowed)
    texts = {"motion": f"{motion}: the sphere {kind.description}"}
    texts |= {name: one.text for name, one in quantities.items()}
    if stroke is not None:
        texts["amplitude"] += " times the samples"
        return RealMotion(stroke.name, kind.unit, **values, stroke=stroke), texts
    return RealMotion(motion, kind.unit, **values), texts


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


def read_drive(
    motion: RealMotion, arguments: Arguments, sought: str | None
) -> tuple[RealDrive, dict[str, str]]:
    """The drive, and a dict with the text of each argument.  Raises InputError.

    sought: name of the quantity that a search determines, or None.  This quantity may be missing.
    """
    speed, force, spring = (arguments[name] for name in ("speed", "force", "drive_stiffness"))
    if speed is None and force is None and sought != "speed":
        raise InputError("speed", None, "needed, or a force")
    if speed is not None and force is not None:
        raise InputError("force", force, "allowed is a force or a speed, not both")
    refused: dict[str, str] = {}
    if motion.steady:
        which = f"allowed only for a motion that oscillates; {motion.name} is steady"
        refused = dict.fromkeys(("drive_stiffness", "mass", "damping"), which)
    elif force is not None:
        which = "allowed only without a force"
        refused = dict.fromkeys(("drive_stiffness", "damping"), which)
    elif spring is None:
        refused = {"mass": "allowed only with a force or a drive_stiffness"}
        refused["damping"] = "allowed only with a drive_stiffness"
    for name, allowed in refused.items():
        if arguments[name] is not None:
            raise InputError(name, arguments[name], allowed)
    if spring is not None and motion.name == "longitudinal" and motion.speed == 0.0:
        allowed = "allowed is a speed above 0 for a longitudinal motion with a spring"
        raise InputError("speed", speed, allowed)
    quantities = {
        name: read_argument(name, arguments[name])
        for name in DRIVE_FIELDS
        if arguments[name] is not None
    }
    values = {DRIVE_FIELDS[name]: one.si for name, one in quantities.items()}
    return RealDrive(**values), {name: one.text for name, one in quantities.items()}
