"""Inputs of a prediction: bodies, contact and motion, and how each was understood."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

from microslip.foundation.errors import InputError
from microslip.si import motions
from microslip.si.bodies import TwoBodies
from microslip.si.dimensionless import RealMotion
from microslip.si.hardness import read_hardness
from microslip.si.materials import RIGID, Material, material_named
from microslip.si.motions import COMBINED, PARTS, TAKES
from microslip.si.quantities import Given, read
from microslip.si.shapes import elliptic, of_size
from microslip.si.validity import SENSELESS

LARGEST_MU = 10.0
"""No pair of bodies in elastic contact has more; what is larger is a slip of the pen."""
SHAPES = ("radius", "counter_radius", "radius_across", "contact_radius", "pressure")
"""Arguments that describe the shape of the contact."""
LARGEST_PHASE = 1e3
"""rad; what is larger is a slip, too."""
OUT_OF_RANGE = (
    "no contact that floating-point numbers can describe; allowed are sizes of real bodies"
)
EXAMPLE = "E and nu as in '70 GPa, 0.22', with a point before decimals"


@dataclass(frozen=True)
class Body:
    """A body and what was understood of it.

    Attributes
    ----------
    material : Material
        Its properties, in SI units.
    text : str
        The properties as they were given.
    """

    material: Material
    text: str

    def completed(self, side: str, hardness: object, density: object) -> Body:
        """With what is given of hardness and density; side: "counter_" or nothing, for messages."""
        body = self
        for name, value, read_as in (
            ("hardness", hardness, read_hardness),
            ("density", density, _read_density),
        ):
            if value is None:
                continue
            if self.material.rigid:
                allowed = "allowed for an elastic body, not a rigid one"
                raise InputError(f"{side}{name}", value, allowed)
            given = read_as(f"{side}{name}", value)
            number: dict[str, Any] = {name: given.si}
            material = replace(body.material, **number)
            body = Body(material, f"{body.text}, {name} {given.text}")
        return body


def _read_density(name: str, value: object) -> Given:
    return read(name, value, "kg/m^3")


def read_body(young: object, nu: object, material: Any) -> Body:
    """The body by numbers or by a material; raises InputError."""
    if material is None:
        for name, value in (("young", young), ("nu", nu)):
            if value is None:
                raise InputError(name, None, "needed, or a material by name")
        return _elastic(read("young", young, "Pa"), _read_poisson("nu", nu))
    if young is not None or nu is not None:
        raise InputError("material", material, "allowed without young and nu")
    if isinstance(material, Material):
        return Body(material, _numbers(material))
    name = material.strip() if isinstance(material, str) else material
    try:
        return _named(name)
    except InputError as error:
        other = "" if isinstance(material, str) else ", or a Material"
        raise InputError("material", material, f"{error.allowed}{other}") from None


def read_counterbody(given: Any) -> Body:
    """The body opposite: a Material, a name, "E, nu", a pair (E, nu), or None, which is rigid.

    Raises InputError.
    """
    if given is None:
        return Body(RIGID, "rigid, as none was given")
    if isinstance(given, Material):
        return Body(given, _numbers(given))
    pair = isinstance(given, tuple | list)
    if not (pair or isinstance(given, str)):
        allowed = f"allowed is a text, {EXAMPLE}, a pair of both, or a Material"
        raise InputError("counterbody", given, allowed)
    parts = list(given) if pair else [part.strip() for part in given.split(",")]
    if len(parts) == 1 and not pair:
        try:
            return _named(parts[0])
        except InputError as error:
            raise InputError("counterbody", given, f"{error.allowed}, or {EXAMPLE}") from None
    if len(parts) != 2:
        problem = f"{len(parts)} values" if pair else f"{len(parts) - 1} commas in it"
        raise InputError("counterbody", given, f"{problem}; allowed: {EXAMPLE}")
    try:
        young = read("Young's modulus", parts[0], "Pa")
        return _elastic(young, _read_poisson("Poisson's ratio", parts[1]))
    except InputError as error:
        problem = f"its {error.argument} {error.value!r}: {error.allowed}, as in '70 GPa, 0.22'"
        raise InputError("counterbody", given, problem) from None


def _read_poisson(name: str, value: object) -> Given:
    return read(name, value, "", low_open=False, high=0.5)


def _elastic(young: Given, nu: Given) -> Body:
    return Body(Material(young.si, nu.si), f"E = {young.text}, nu = {nu.text}")


def _named(name: Any) -> Body:
    body = material_named(name)
    return Body(body, name if body.rigid else f"{name} ({_numbers(body)})")


def _numbers(body: Material) -> str:
    """A Material in one line."""
    if body.rigid:
        return "rigid"
    parts = [f"E = {body.young / 1e9:.6g} GPa", f"nu = {body.poisson:g}"]
    if body.hardness is not None:
        parts.append(f"hardness {body.hardness / 1e9:.6g} GPa")
    if body.density is not None:
        parts.append(f"density {body.density:.6g} kg/m^3")
    return ", ".join(parts)


def read_contact(
    body: Body, other: Body, *, load: object, mu: object, contacts: int = 1, **shape: object
) -> tuple[TwoBodies, dict]:
    """The contact, and a dict of texts of what was understood; raises InputError.

    contacts: how many carry the load, of which this one has the mean.  shape: radius,
    counter_radius, radius_across, contact_radius and pressure, as far as given.
    """
    shape = dict.fromkeys(SHAPES) | shape
    if shape["pressure"] is not None or shape["contact_radius"] is not None:
        return _of_size(body, other, (load, contacts), mu, shape)
    if shape["radius"] is None:
        raise InputError("radius", None, "needed, or a contact_radius in its place")
    contact, texts = _of_spheres(body, other, (load, contacts), mu, shape)
    across = shape["radius_across"]
    if across is not None:
        if shape["counter_radius"] is not None:
            allowed = "allowed is none beside a counter_radius: give the relative curvatures"
            raise InputError("radius_across", across, allowed)
        second = read("radius_across", across, "m")
        try:
            contact, texts["radius_across"] = elliptic(contact, second.si), second.text
        except InputError as error:
            raise error.renamed("radius_across", across) from None
        _refuse_senseless(contact, shape["radius"], across, load)
    return contact, texts


def _of_size(
    body: Body, other: Body, carried: tuple[object, int], mu: object, shape: dict[str, Any]
) -> tuple[TwoBodies, dict[str, str]]:
    """A contact whose size is given, and not the shape of the bodies; carried: the load, and by how
    many contacts."""
    load, contacts = carried
    for name in ("radius", "counter_radius", "radius_across"):
        if shape[name] is not None:
            cause = "a contact_radius"
            if shape["contact_radius"] is None:
                cause = "a pressure, which needs a contact_radius in place of radii"
            raise InputError(name, shape[name], f"allowed is none beside {cause}")
    if shape["contact_radius"] is None:
        allowed = "needed beside a pressure: half the longer side of the contact"
        raise InputError("contact_radius", None, allowed)
    size = read("contact_radius", shape["contact_radius"], "m")
    pressure = "hertz" if shape["pressure"] is None else shape["pressure"]
    force, coefficient = read("load", load, "N"), read("mu", mu, "", high=LARGEST_MU)
    _refuse_rigid(body, other)
    plain = TwoBodies(body.material, other.material, 1.0, force.si / contacts, coefficient.si)
    try:
        contact = of_size(plain, size.si, pressure)
        sizes = (contact.u_lim, contact.load / size.si**2)
        good = all(0.0 < one < math.inf for one in sizes) and contact.largest_pressure > 0.0
    except (ArithmeticError, ValueError) as error:
        if isinstance(error, InputError) and error.argument == "pressure":
            raise
        good = False
    if not good:
        raise InputError("contact_radius", shape["contact_radius"], OUT_OF_RANGE)
    texts = {"body": body.text, "counterbody": other.text, "contact_radius": size.text}
    texts |= {"pressure": pressure, "load": force.text, "mu": coefficient.text}
    return contact, texts


def _refuse_rigid(body: Body, other: Body) -> None:
    if body.material.rigid and other.material.rigid:
        allowed = "allowed is an elastic body where the counterbody is rigid"
        raise InputError("material", "rigid", allowed)


def _of_spheres(
    body: Body, other: Body, carried: tuple[object, int], mu: object, shape: dict[str, Any]
) -> tuple[TwoBodies, dict[str, str]]:
    """Hertz's contact of a sphere with a flat or a second sphere; carried: as for _of_size."""
    load, contacts = carried
    radius, counter_radius = shape["radius"], shape["counter_radius"]
    first = read("radius", radius, "m")
    given = {"radius": first, "load": read("load", load, "N")}
    given["mu"] = read("mu", mu, "", high=LARGEST_MU)
    radii, texts = (first.si, math.inf), {"counter_radius": "flat, as none was given"}
    if counter_radius is not None:
        second = read("counter_radius", counter_radius, "m", low=-math.inf)
        if second.si == 0.0:
            raise InputError("counter_radius", counter_radius, "allowed is a radius other than 0")
        radii = (first.si, second.si)
        texts["counter_radius"] = f"{second.text}, hollow" if second.si < 0.0 else second.text
    curvature = sum(1.0 / r for r in radii)
    if math.isinf(curvature):
        which = (
            ("radius", radius) if math.isinf(1.0 / radii[0]) else ("counter_radius", counter_radius)
        )
        raise InputError(*which, OUT_OF_RANGE)
    if not curvature > 0.0:
        allowed = "allowed is a hollow wider than the sphere"
        raise InputError("counter_radius", counter_radius, allowed)
    _refuse_rigid(body, other)
    each = given["load"].si / contacts
    contact = TwoBodies(body.material, other.material, 1.0 / curvature, each, given["mu"].si, radii)
    _refuse_senseless(contact, radius, counter_radius, load)
    bodies = {"body": body.text, "counterbody": other.text}
    return contact, bodies | texts | {name: one.text for name, one in given.items()}


def _refuse_senseless(
    contact: TwoBodies, radius: object, counter_radius: object, load: object
) -> None:
    """Raise InputError where Hertz's theory is no description of these bodies."""
    try:
        a, smallest = contact.contact_radius, contact.smallest_radius
        if a >= SENSELESS * smallest:
            first = smallest == abs(contact.radii[0])
            raise InputError(
                *(("radius", radius) if first else ("counter_radius", counter_radius)),
                f"by Hertz's theory, which is for contacts much smaller than either body, the "
                f"contact radius would be {a:.3g} m, {a / smallest:.2g} of it; allowed is less "
                f"than {SENSELESS:g}",
            )
        sizes = (a, contact.indentation, contact.u_lim, contact.largest_pressure)
        good = all(0.0 < size < math.inf for size in sizes)
    except ArithmeticError:
        good = False
    if not good:
        raise InputError("load", load, f"with these bodies and radii, {OUT_OF_RANGE}")


def read_motion(
    motion: str,
    *,
    speed: object,
    amplitude: object,
    frequency: object,
    rotation: object,
    sought: str | None = None,
    **others: object,
) -> tuple[RealMotion, dict]:
    """The motion, and a dict of texts of what was understood; raises InputError.

    sought: what is looked for; an amplitude may be missing then.  A speed that is not given is
    None.  others: what motions that oscillate in several ways take besides, see motions.TAKES.
    """
    motions.check_motion(motion)
    steady = motions.is_steady(motion)
    given = {"amplitude": amplitude, "frequency": frequency, "rotation": rotation, **others}
    needed = ("rotation",) if steady else (*COMBINED.get(motion, ("amplitude",)), "frequency")
    for name, value in given.items():
        if name not in (*needed, *TAKES.get(motion, ())) and value is not None:
            raise InputError(name, value, f"{motion} has none")
    for name in needed:
        if given[name] is None and name != sought:
            raise InputError(name, None, f"{motion} needs it")
    found = {}
    if speed is not None:
        found["speed"] = read("speed", speed, "m/s", low_open=False)
    if steady:
        found["rotation"] = read("rotation", rotation, "rad/s")
    else:
        for name, (_, unit) in PARTS.items():
            if given.get(name) is not None:
                wanted = motions.unit_of_amplitude(motion) or unit
                found[name] = read(name, given[name], wanted, low_open=name == "load_amplitude")
        if given.get("phase") is not None:
            found["phase"] = read("phase", given["phase"], "rad", low=-LARGEST_PHASE)
        found["frequency"] = read("frequency", frequency, "Hz")
    real = RealMotion(motion, **{"speed": None} | {name: one.si for name, one in found.items()})
    texts = {"motion": f"{motion}: the sphere {motions.description(motion)}"}
    sizes = [found[name].si for name in PARTS if name in found]
    if motion in COMBINED and max(sizes) == 0.0:
        raise InputError(needed[0], given[needed[0]], "allowed is above 0 where no other one is")
    return real, texts | {name: one.text for name, one in found.items()}
