"""The inputs of a prediction: one table for the Python arguments, the options, the columns of CSV
files, their checks, help texts and reference page."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from microslip.foundation.arguments import SMALLEST_TOLERANCE
from microslip.foundation.errors import InputError
from microslip.foundation.named_files import speaks_of_file
from microslip.foundation.spec import near_miss
from microslip.foundation.units import Quantity, read
from microslip.si.materials import RIGID, Material, material_named, read_hardness

if TYPE_CHECKING:
    from microslip.si.strokes import Stroke

INF = math.inf
REDUCTION = (
    "in place of amplitude, speed or load: requested reduction of friction, such as '50 %'; the "
    "answer is the smallest amplitude, the largest speed or the largest load"
)
TOLERANCE = (
    "largest accepted error of mu_macro (1e-3), or relative error of the speed under a force (1e-2)"
)


class Input(NamedTuple):
    """An input of `predict`.

    Attributes
    ----------
    group : str
        Heading in the help text: bodies, load, motion, drive or output.
    unit : str or None
        SI unit, empty for a pure number.  None for a text.
    help : str
        What it is, with an example.
    low, high : float
        Finite values with low < value <= high are allowed.
    zero : bool
        Whether `low` itself is allowed.
    exact : bool
        Whether the input cannot have an uncertainty.
    """

    group: str
    unit: str | None
    help: str
    low: float = 0.0
    high: float = INF
    zero: bool = False
    exact: bool = False

    @property
    def range(self) -> str:
        """The allowed values in words."""
        parts = [f"{'at least' if self.zero else 'above'} {self.low:g}"] * (self.low > -INF)
        parts += [f"at most {self.high:g}"] * (self.high < INF)
        return f"{' and '.join(parts)} {self.unit or ''}".strip()


_bodies, _load, _drive, _motion, _output = (
    partial(Input, group) for group in ("bodies", "load", "drive", "motion", "output")
)
INPUTS = {
    "material": _bodies(None, "name of a material, in place of young and nu"),
    "young": _bodies("Pa", "Young's modulus of the body, such as '210 GPa'"),
    "nu": _bodies("", "Poisson's ratio of the body", 0.0, 0.5, zero=True),
    "counterbody": _bodies(None, "rigid (default), a material, or '70 GPa, 0.22' (E, nu)"),
    "radius": _bodies("m", "radius of the sphere, such as '5 mm'"),
    "counter_radius": _bodies("m", "radius of the counterbody, below 0 if hollow (flat)", -INF),
    "radius_across": _bodies("m", "second radius, across the forward direction: an ellipse"),
    "contact_radius": _bodies("m", "in place of all radii: half the longer side of the contact"),
    "pressure": _bodies(None, "with contact_radius: hertz (default), ring:inner=0.5, file:FILE"),
    "load": _load("N", "normal load, such as '10 N'"),
    "mu": _bodies("", "coefficient of friction without vibration", 0.0, 10.0),
    "speed": _drive("m/s", "forward speed, such as '1 mm/s'", zero=True),
    "force": _drive("N", "in place of the speed: a constant forward force, such as '1 N'"),
    "drive_stiffness": _drive("N/m", "stiffness of a spring that pulls, such as '10 N/um'"),
    "mass": _drive("kg", "mass of a body on a spring or under a force ('20 g')", zero=True),
    "damping": _drive("N*s/m", "dashpot parallel to the spring, such as '5 N*s/m'", zero=True),
    "amplitude": _motion("m", "half stroke ('1 um'), or angle of a bore ('0.5 deg')", zero=True),
    "forward_amplitude": _motion("m", "forward half stroke, for elliptic and normal", zero=True),
    "rotation_amplitude": _motion("rad", "half stroke in spin: transverse-bore, normal", zero=True),
    "load_amplitude": _motion("N", "half stroke of the normal load, for normal"),
    "phase": _motion("rad", "phase between the oscillations ('90 deg'; 0)", -1e3, 1e3, zero=True),
    "frequency": _motion("Hz", "frequency, such as '20 kHz', '1200 rpm' or '125664 rad/s'"),
    "rotation": _motion("rad/s", "angular speed of continuous-bore, such as '60 rpm'"),
    "reduction": _motion("", REDUCTION, 0.0, 1.0, exact=True),
    "hardness": _bodies("Pa", "hardness for a warning: '7 GPa', '700 HV', '60 HRC'", exact=True),
    "density": _bodies("kg/m^3", "density for a warning, such as '7850 kg/m^3'", exact=True),
    "counter_hardness": _bodies("Pa", "hardness of the counterbody", exact=True),
    "counter_density": _bodies("kg/m^3", "density of the counterbody", exact=True),
    "wear_coefficient": _bodies("m^2/N", "Archard's coefficient ('1e-5 mm^3/N/m')", zero=True),
    "tolerance": _output("", TOLERANCE, SMALLEST_TOLERANCE, 0.1, zero=True, exact=True),
    "map": _output(None, "certified map (a name, or a .nc file) that replaces the solver"),
}
"""Every input of `predict`, in the order of the help text and of the printed answer."""
OF_BODIES = (
    *("young", "nu", "hardness", "density", "counter_hardness", "counter_density", "material"),
    "tolerance",
)
"""Inputs that are not printed by themselves: the line of the body contains them."""
SEARCHED = "amplitude", "speed", "load"
"""Inputs that a reduction can replace."""
OSCILLATIONS = {
    "amplitude": "lateral",
    "forward_amplitude": "forward",
    "rotation_amplitude": "angle",
    "load_amplitude": "load",
}
"""Directions of the solver's motions, keyed by the amplitude."""
SAME_ANGLE = 1e-3
"""Largest relative difference between equal angles, one of which is sampled at 721 phases."""


@dataclass(frozen=True)
class Kind:
    """Inputs of a motion, and its description.

    Attributes
    ----------
    name, description : str
        Name for microslip.solve, and what the sphere does.
    unit : str or None
        SI unit of the amplitude, if it is the only one; empty for the factor of a file.
    needed, optional : tuple of str
        Required and optional inputs of the motion.
    along : bool
        Whether the sphere may oscillate along the drive, or the load oscillates.
    stroke : Stroke or None
        One period of the motion, if it is read from a file.
    """

    name: str
    description: str
    unit: str | None = None
    needed: tuple[str, ...] = ("amplitude", "frequency")
    optional: tuple[str, ...] = ()
    along: bool = False
    stroke: Stroke | None = field(default=None, repr=False)

    @property
    def steady(self) -> bool:
        """Whether nothing oscillates."""
        return "frequency" not in (*self.needed, *self.optional)

    @property
    def several(self) -> bool:
        """Whether the motion has several amplitudes, or is read from a file."""
        return not (self.unit or self.steady)

    @property
    def amplitude_unit(self) -> str:
        return "m" if self.unit is None else self.unit


MOTIONS = {
    kind.name: kind
    for kind in (
        Kind("transverse", "slides forward and oscillates sideways", "m"),
        Kind(
            "longitudinal",
            "slides forward and oscillates along the same direction",
            "m",
            along=True,
        ),
        Kind(
            "zigzag",
            "slides forward and moves sideways at constant speed, with abrupt turns",
            "m",
        ),
        Kind(
            "bore",
            "slides forward and oscillates in spin, which is rotation about the contact normal",
            "rad",
        ),
        Kind(
            "elliptic",
            "slides forward and oscillates along the same direction and sideways",
            needed=("amplitude", "forward_amplitude", "frequency"),
            optional=("phase",),
            along=True,
        ),
        Kind(
            "transverse-bore",
            "slides forward and oscillates sideways and in spin",
            needed=("amplitude", "rotation_amplitude", "frequency"),
            optional=("phase",),
        ),
        Kind(
            "normal",
            "slides forward while its normal load oscillates, alone or with a motion",
            needed=("load_amplitude", "frequency"),
            optional=(*OSCILLATIONS, "phase"),
            along=True,
        ),
        Kind(
            "continuous-bore",
            "slides forward and spins steadily about the contact normal",
            needed=("rotation",),
        ),
    )
}
"""Motions with inputs of their own.  All other motions have one amplitude or a rotation."""
AT_REST = Kind("", "rests", needed=())
"""A contact without a motion."""


def kind_of(motion: Any) -> Kind:
    """The kind of a motion: a name, a name with parameters, a user's motion, or a file with one
    period in SI units.  Raises InputError unless its amplitude has a unit."""
    if isinstance(motion, str) and motion in MOTIONS:
        return MOTIONS[motion]
    if speaks_of_file(motion):
        from microslip.si.strokes import read_stroke

        stroke = read_stroke(motion)
        rows, names = len(next(iter(stroke.columns.values()))), list(stroke.columns)
        text = f"slides forward and follows {rows} samples of its {' and '.join(names)}"
        along = not {"forward", "load", "indentation"}.isdisjoint(names)
        needed = () if stroke.frequency else ("frequency",)
        optional = ("amplitude", "frequency")
        return Kind(stroke.name, text, "", needed, optional, along, stroke)
    from microslip.motions.by_name import motion_named
    from microslip.motions.motion import LOOP
    from microslip.theory import hertz

    record = motion_named(motion)
    if record.loads:
        allowed = "allowed is normal with a load_amplitude for an oscillating load"
        raise InputError("motion", motion, allowed)
    if not record.periodic:
        return Kind(motion, f"is {record.summary}", needed=("rotation",))
    ahead, aside, angle = record.displacement(LOOP, 0.0, 1.0, 0.0)
    turn = float(np.abs(angle).max()) / float(hertz.bore_angle(1.0))
    if turn and (np.ptp(ahead) or np.ptp(aside) or abs(turn - 1.0) > SAME_ANGLE):
        allowed = "allowed is a translation or a rotation; for both use transverse-bore"
        raise InputError("motion", motion, allowed)
    return Kind(
        motion, f"is {record.summary}", "rad" if turn else "m", along=bool(np.ptp(ahead) > 0.0)
    )


@dataclass(frozen=True, eq=False)
class Inputs:
    """Checked inputs.  Each quantity is an attribute, in its SI unit; None if it is missing.

    Attributes
    ----------
    kind : Kind
        The motion.
    quantities : dict of Quantity
        Quantities by name.
    bodies : tuple of Material
        The body and the counterbody.
    texts : dict of str
        The inputs as the user wrote them, by name.
    pressure : str
        Name of the pressure for microslip.solve, if the contact radius is an input.
    search : str or None
        Name of the input that a reduction replaces.
    map : xarray.Dataset or None
        Map that replaces the solver.
    given : mapping
        The inputs unchanged, for messages.
    """

    kind: Kind
    quantities: dict[str, Quantity]
    bodies: tuple[Material, Material]
    texts: dict[str, str]
    pressure: str = "hertz"
    search: str | None = None
    map: Any = None
    given: Mapping[str, Any] = field(default_factory=dict, repr=False)

    def __getattr__(self, name: str) -> Any:
        if name not in INPUTS:
            raise AttributeError(name)
        return self.quantities[name].si if name in self.quantities else None

    def at(self, **si: Any) -> Inputs:
        """A copy with other values in SI units, which can be arrays."""
        nothing = Quantity(0.0, "")
        changes = {n: replace(self.quantities.get(n, nothing), si=x) for n, x in si.items()}
        body, other = self.bodies
        if not si.keys().isdisjoint(("young", "nu")):
            body = replace(
                body, young=si.get("young", body.young), poisson=si.get("nu", body.poisson)
            )
        return replace(self, quantities=self.quantities | changes, bodies=(body, other))

    def error(self, name: str, allowed: str) -> InputError:
        """The InputError for an input, with its value as the user wrote it."""
        return InputError(name, self.given.get(name), allowed)

    def unit(self, name: str) -> str:
        """SI unit of a quantity."""
        return self.kind.amplitude_unit if name == "amplitude" else INPUTS[name].unit or ""

    @cached_property
    def uncertain(self) -> dict[str, Quantity]:
        """The quantities with an uncertainty."""
        return {name: one for name, one in self.quantities.items() if one.deviation}


def read_inputs(motion: Any, **given: Any) -> Inputs:
    """Read and check inputs.

    Parameters
    ----------
    motion : str or None
        Motion, as for `microslip.predict`; None for a contact without a motion, which has the
        inputs of the groups "bodies" and "load".
    **given
        Inputs by the names in INPUTS.  None is a missing input.

    Raises
    ------
    InputError
        If inputs are missing (the message names all of them), contradict each other, or are out of
        range.
    """
    kind = AT_REST if motion is None else kind_of(motion)
    given = {name: value for name, value in given.items() if value is not None}
    for name, value in given.items():
        if name not in INPUTS:
            raise InputError(
                name, value, f"{near_miss(name, INPUTS)}allowed are {', '.join(INPUTS)}"
            )
        values = getattr(value, "magnitude", value)  # the array in a pint quantity
        sequence = hasattr(values, "__len__") and not isinstance(values, str | bytes | Mapping)
        sequence = sequence and not (hasattr(values, "dims") and values.size == 1)
        if sequence and getattr(values, "ndim", 1) > 0 and name not in ("counterbody", "map"):
            allowed = "allowed is one value; predict_table takes a sequence, with many contacts"
            raise InputError(name, value, allowed)
    if kind.stroke is not None:
        given = _with_stroke(kind.stroke, given)
    search = _searched(motion, kind, given)
    _check_presence(motion, kind, given, search)
    quantities = {
        n: read_input(n, given[n], kind)
        for n in INPUTS
        if INPUTS[n].unit is not None and n in given
    }
    texts = {} if motion is None else {"motion": f"{motion}: the sphere {kind.description}"}
    body, other = _body(given, quantities), _counterbody(given.get("counterbody"))
    bodies = tuple(
        _with_properties(*one, side, quantities) for one, side in ((body, ""), (other, "counter_"))
    )
    if all(material.rigid for material, _ in bodies):
        allowed = "allowed is an elastic body if the counterbody is rigid"
        raise InputError("material", given.get("material"), allowed)
    texts |= {"body": bodies[0][1]}
    for name in INPUTS:
        if name in quantities and name not in OF_BODIES:
            texts[name] = quantities[name].text
        elif name == "counterbody":
            texts[name] = bodies[1][1]
        elif name == "pressure" and "contact_radius" in given:
            texts[name] = str(given.get("pressure", "hertz"))
        elif name in given and INPUTS[name].unit is None and name != "material":
            texts[name] = str(given[name]) if name != "map" else "friction from a map"
    if "radius" in quantities and "radius_across" not in quantities:
        hollow = quantities.get("counter_radius")
        texts["counter_radius"] = "flat (default)" if hollow is None else hollow.text
        if hollow is not None and hollow.si < 0.0:
            texts["counter_radius"] += ", hollow"
    if kind.stroke is not None:
        texts["amplitude"] += " times the samples"
    order = ["motion", "body", *INPUTS]
    texts = dict(sorted(texts.items(), key=lambda one: order.index(one[0])))
    pressure = given.get("pressure", "hertz")
    materials = bodies[0][0], bodies[1][0]
    return Inputs(kind, quantities, materials, texts, pressure, search, given.get("map"), given)


def read_input(name: str, value: Any, kind: Kind = AT_REST) -> Quantity:
    """Read one quantity of INPUTS and check its range.  Raises InputError.

    kind: motion, for the unit of its amplitude.  Without a motion, the quantity must be exact.
    """
    one = INPUTS[name]
    unit = kind.amplitude_unit if name == "amplitude" else one.unit
    return read_quantity(name, value, one._replace(unit=unit, exact=one.exact or kind is AT_REST))


def read_quantity(name: str, value: Any, one: Input) -> Quantity:
    """Read a quantity and check its range.  Raises InputError about the argument `name`."""
    try:
        hardness = name.endswith("hardness")
        quantity = read_hardness(value) if hardness else read(value, one.unit or "")
    except ValueError as error:
        raise InputError(name, value, str(error)) from None
    si = quantity.si
    if not (one.low < si <= one.high or one.zero and si == one.low) or math.isinf(si):
        raise InputError(name, value, f"allowed is a finite value {one.range}".strip())
    if one.exact and quantity.deviation:
        raise InputError(name, value, "allowed is an exact value, without an uncertainty")
    return quantity


def _with_stroke(stroke: Stroke, given: dict[str, Any]) -> dict[str, Any]:
    """The inputs with the frequency and the mean load from a file.  Raises InputError."""
    if stroke.frequency is not None and "frequency" in given:
        allowed = "allowed only without a column time, which contains the frequency"
        raise InputError("frequency", given["frequency"], allowed)
    if "map" in given:
        allowed = "not allowed for a motion from a file: no map has its unit of the amplitude"
        raise InputError("map", stroke.name, allowed)
    own = {"amplitude": 1.0, "frequency": stroke.frequency, "load": stroke.mean_load}
    return {name: value for name, value in own.items() if value is not None} | given


def _searched(motion: Any, kind: Kind, given: Mapping[str, Any]) -> str | None:
    """Name of the missing input, which a search determines; None without a reduction."""
    if "reduction" not in given:
        return None
    reduction = given["reduction"]
    for name in ("force", "drive_stiffness"):
        if name in given:
            allowed = "allowed only without a force and a drive_stiffness"
            raise InputError("reduction", reduction, allowed)
    missing = [name for name in SEARCHED if name not in given]
    if kind.steady or kind.several and "amplitude" not in kind.needed:
        missing = [name for name in missing if name != "amplitude"]
    if not kind.unit and missing != ["speed"]:
        what = "several amplitudes" if kind.several else "no amplitude"
        raise InputError("reduction", reduction, f"not allowed: {motion} has {what}")
    if len(missing) != 1:
        allowed = "allowed only without the amplitude, the speed or the load, which it determines"
        if missing:
            allowed = f"it determines one quantity, but {' and '.join(missing)} are missing"
        raise InputError("reduction", reduction, allowed)
    return missing[0]


def _check_presence(motion: Any, kind: Kind, given: Mapping[str, Any], search: str | None) -> None:
    """Raise InputError for inputs that contradict each other or are missing."""
    own, groups = (*kind.needed, *kind.optional), ("bodies", "load")
    allowed = {n for n, one in INPUTS.items() if one.group in groups or n in own}
    if kind is not AT_REST:
        allowed |= {n for n, one in INPUTS.items() if one.group in ("drive", "output")} | {
            "reduction"
        }
    sized = "contact_radius" in given or "pressure" in given
    size = (
        "a contact_radius"
        if "contact_radius" in given
        else ("a pressure, which needs a contact_radius in place of radii")
    )
    refusals = [
        (n, f"{motion or 'a contact without a motion'} has none")
        for n in INPUTS
        if n not in allowed
    ]
    refusals += [
        (n, f"allowed only without {size}")
        for n in ("radius", "counter_radius", "radius_across")
        if sized
    ]
    if "counter_radius" in given:
        curvature = "allowed only without a counter_radius: give the radii of relative curvature"
        refusals.append(("radius_across", curvature))
    if "speed" in given:
        refusals.append(("force", "allowed is a force or a speed, not both"))
    if kind.steady:
        text = f"allowed only for a motion that oscillates; {motion} is steady"
        refusals += [(name, text) for name in ("drive_stiffness", "mass", "damping")]
    elif "force" in given:
        refusals += [(n, "allowed only without a force") for n in ("drive_stiffness", "damping")]
    elif "drive_stiffness" not in given:
        refusals.append(("mass", "allowed only with a force or a drive_stiffness"))
        refusals.append(("damping", "allowed only with a drive_stiffness"))
    if "material" in given:
        refusals += [("material", "allowed only without young and nu")] * bool(
            {"young", "nu"} & given.keys()
        )
    if "map" in given:
        refusals += [
            (n, "allowed only without a map")
            for n in ("force", "drive_stiffness", "wear_coefficient")
        ]
    for name, text in refusals:
        if name in given:
            raise InputError(name, given[name], text)
    missing = dict.fromkeys(("mu", "load"), "needed")
    missing |= dict.fromkeys(kind.needed, f"{motion} needs it")
    if kind is not AT_REST and "force" not in given:
        missing["speed"] = "needed, or a force"
    missing["contact_radius" if sized else "radius"] = (
        "needed with a pressure: half the longer side of the contact"
        if sized
        else "needed, or a contact_radius"
    )
    if "material" not in given:
        missing |= {"young": "needed, or a material", "nu": "needed"}
    missing = {n: text for n, text in missing.items() if n not in given and n != search}
    if missing:
        first, *others = missing
        also = f"; also missing: {', '.join(others)}" if others else ""
        raise InputError(first, None, f"{missing[first]}{also}")


def _body(given: Mapping[str, Any], quantities: Mapping[str, Quantity]) -> tuple[Material, str]:
    """The body and its text."""
    if "material" not in given:
        young, nu = quantities["young"], quantities["nu"]
        return Material(young.si, nu.si), f"E = {young.text}, nu = {nu.text}"
    material = given["material"]
    try:
        return _material(material.strip() if isinstance(material, str) else material)
    except InputError as error:
        other = "" if isinstance(material, str) else ", or a Material"
        raise InputError("material", material, f"{error.allowed}{other}") from None


def _material(material: Any) -> tuple[Material, str]:
    if isinstance(material, Material):
        return material, str(material)
    body = material_named(material)
    return body, material if body.rigid else f"{material} ({body})"


def _counterbody(value: Any) -> tuple[Material, str]:
    """The counterbody, a Material, a name, "E, nu" or a pair (E, nu), and its text."""
    if value is None:
        return RIGID, "rigid (default)"
    example = "E and nu as in '70 GPa, 0.22', with a point before decimals"
    pair = isinstance(value, tuple | list)
    if not (pair or isinstance(value, str | Material)):
        raise InputError(
            "counterbody", value, f"allowed is a text, {example}, a pair or a Material"
        )
    parts = list(value) if pair else [value]
    if isinstance(value, str):
        parts = [part.strip() for part in value.split(",")]
    if len(parts) == 1 and not pair:
        try:
            return _material(parts[0])
        except InputError as error:
            raise InputError("counterbody", value, f"{error.allowed}, or {example}") from None
    if len(parts) != 2:
        count = f"{len(parts)} values" if pair else f"{len(parts) - 1} commas in it"
        raise InputError("counterbody", value, f"{count}; allowed: {example}")
    numbers = []
    for name, title, part in zip(
        ("young", "nu"), ("Young's modulus", "Poisson's ratio"), parts, strict=True
    ):
        try:
            numbers.append(read_input(name, part))
        except InputError as error:
            problem = f"its {title} {part!r}: {error.allowed}, as in '70 GPa, 0.22'"
            raise InputError("counterbody", value, problem) from None
    young, nu = numbers
    return Material(young.si, nu.si), f"E = {young.text}, nu = {nu.text}"


def _with_properties(
    body: Material, text: str, side: str, quantities: Mapping[str, Quantity]
) -> tuple[Material, str]:
    """The body with its hardness and density, and its text.  side: "counter_" or empty."""
    for name in ("hardness", "density"):
        if one := quantities.get(f"{side}{name}"):
            if body.rigid:
                allowed = "allowed for an elastic body, not a rigid one"
                raise InputError(f"{side}{name}", one.text, allowed)
            changes: dict[str, Any] = {name: one.si}
            body, text = replace(body, **changes), f"{text}, {name} {one.text}"
    return body, text
