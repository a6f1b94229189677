"""The inputs of a prediction.  One table defines every input.  Each input can be given as a Python
argument, as a command-line option, or as a column of a CSV file.  The table also defines the
checks, the help text and the line on the reference page."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, NamedTuple

from microslip.foundation.arguments import SMALLEST_TOLERANCE
from microslip.foundation.errors import InputError
from microslip.foundation.spec import near_miss
from microslip.foundation.units import Quantity, read
from microslip.si.materials import Material, read_body, read_hardness

if TYPE_CHECKING:
    from microslip.si.strokes import Stroke

INF = math.inf
REDUCTION = (
    "in place of amplitude, speed or load: requested reduction of friction, such as '50 %'; the "
    "answer is the smallest amplitude, the largest speed or the largest load"
)
PHASE = "phase by which forward or spin leads sideways, or motion leads load ('90 deg'; 0)"
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
        SI unit; empty for a pure number, None for an input that is a string.
    help : str
        Description of the input, with an example.
    low, high : float
        Finite values with low < value <= high are allowed.
    zero : bool
        True if `low` itself is allowed.
    exact : bool
        True if the input cannot have an uncertainty.
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
    "phase": _motion("rad", PHASE, -1e3, 1e3, zero=True),
    "frequency": _motion("Hz", "frequency, such as '20 kHz', '1200 rpm' or '125664 rad/s'"),
    "rotation": _motion("rad/s", "angular speed of continuous-bore, such as '60 rpm'"),
    "reduction": _motion("", REDUCTION, 0.0, 1.0, exact=True),
    "hardness": _bodies("Pa", "hardness for a warning: '7 GPa', '700 HV', '60 HRC'", exact=True),
    "density": _bodies("kg/m^3", "density for a warning, such as '7850 kg/m^3'", exact=True),
    "counter_hardness": _bodies("Pa", "hardness of the counterbody", exact=True),
    "counter_density": _bodies("kg/m^3", "density of the counterbody", exact=True),
    "wear_coefficient": _bodies("m^2/N", "Archard's coefficient ('1e-5 mm^3/N/m')", zero=True),
    "tolerance": _output("", TOLERANCE, SMALLEST_TOLERANCE, 0.1, zero=True, exact=True),
    "map": _output(None, "map in place of the solver: its name or file (Python: dataset)"),
}
"""All inputs of `predict`, in the order of the help text and of the printed result."""
OF_BODIES = (
    *("young", "nu", "hardness", "density", "counter_hardness", "counter_density", "material"),
    "tolerance",
)
"""Inputs that are not printed on a separate line.  The properties of a body are printed on the line
of the body."""
SEARCHED = "amplitude", "speed", "load"
"""Inputs that a search for a requested reduction of friction can determine."""
OSCILLATIONS = {
    "amplitude": "lateral",
    "forward_amplitude": "forward",
    "rotation_amplitude": "angle",
    "load_amplitude": "load",
}
"""For each input that is the amplitude of an oscillation, the direction of this oscillation in the
motions of the solver."""
SAME_ANGLE = 1e-3
"""Largest relative difference between two angles that count as equal.  One of these angles is the
largest of 721 samples of the motion."""


@dataclass(frozen=True)
class Kind:
    """A motion with its inputs and its description.

    Attributes
    ----------
    name, description : str
        Name for microslip.solve, and description of how the sphere moves.
    unit : str or None
        SI unit of the amplitude if the motion has only one; empty if the amplitude is a factor for
        the samples of a file.
    needed, optional : tuple of str
        Required and optional inputs of the motion.
    stroke : Stroke or None
        One period of the motion, if it is read from a file.
    """

    name: str
    description: str
    unit: str | None = None
    needed: tuple[str, ...] = ("amplitude", "frequency")
    optional: tuple[str, ...] = ()
    stroke: Stroke | None = field(default=None, repr=False)

    @property
    def steady(self) -> bool:
        """True if nothing oscillates."""
        return "frequency" not in (*self.needed, *self.optional)

    @property
    def several(self) -> bool:
        """True if the motion has several amplitudes, or is read from a file."""
        return not (self.unit or self.steady)

    @property
    def defaults(self) -> dict[str, float]:
        """Default inputs of a motion from a file: the frequency and the mean load in the file, and
        a factor of 1 for the samples."""
        if self.stroke is None:
            return {}
        own = {"amplitude": 1.0, "frequency": self.stroke.frequency, "load": self.stroke.mean_load}
        return {name: value for name, value in own.items() if value is not None}

    def input(self, name: str) -> Input:
        """Return the entry of INPUTS for an input, adapted to this motion.  An amplitude has the
        unit of the motion.  If the contact is at rest, all quantities must be exact."""
        one = INPUTS[name]
        unit = one.unit if name != "amplitude" or self.unit is None else self.unit
        return one._replace(unit=unit, exact=one.exact or self is AT_REST)


def _kinds(text: str) -> dict[str, Kind]:
    """Parse a table of motions, and return a dictionary of `Kind` objects, keyed by name.  Each
    line of `text` contains the name, the unit, the required inputs, the optional inputs and the
    description of a motion."""
    rows = (map(str.strip, line.split("|")) for line in text.strip().splitlines())
    return {
        name: Kind(
            name, f"slides forward {does}", unit or None, tuple(needs.split()), tuple(more.split())
        )
        for name, unit, needs, more, does in rows
    }


MOTIONS = _kinds("""
transverse  | m | amplitude frequency | | and oscillates sideways
longitudinal| m | amplitude frequency | | and oscillates along the same direction
zigzag      | m | amplitude frequency | | and moves sideways at constant speed, with abrupt turns
bore        |rad| amplitude frequency | | and oscillates in spin, rotation about the contact normal
elliptic       || amplitude forward_amplitude frequency|phase| and oscillates along it and sideways
transverse-bore|| amplitude rotation_amplitude frequency|phase| and oscillates sideways and in spin
normal         || load_amplitude frequency \
  | amplitude forward_amplitude rotation_amplitude phase \
  | while its normal load oscillates, alone or with a motion
continuous-bore|| rotation            | | and spins steadily about the contact normal
""")
"""The `Kind` objects of the motions that need their own list of inputs.  All other motions have one
amplitude or a rotation."""
AT_REST = Kind("", "rests", needed=())
"""The `Kind` object of a contact without a motion."""


def kind_of(motion: Any) -> Kind:
    """Return the `Kind` object that describes a motion.  The motion is a name, a name with
    parameters, a user's motion, or a file with one period in SI or other units.  Raises InputError
    if the unit of the amplitude is ambiguous."""
    if isinstance(motion, str) and motion in MOTIONS:
        return MOTIONS[motion]
    if isinstance(motion, str) and motion.startswith("file:"):
        from microslip.si.strokes import read_stroke

        stroke = read_stroke(motion)
        rows, names = len(next(iter(stroke.columns.values()))), " and ".join(stroke.columns)
        text = f"slides forward and follows {rows} samples of its {names}"
        needed = () if stroke.frequency else ("frequency",)
        return Kind(stroke.name, text, "", needed, ("amplitude", "frequency"), stroke)
    import numpy as np

    from microslip.scene.by_name import motion_named
    from microslip.scene.motion import LOOP
    from microslip.theory import hertz

    record, allowed = motion_named(motion), ""
    if not (record.loads or record.periodic):
        return Kind(motion, f"is {record.summary}", needed=("rotation",))
    ahead, aside, angle = record.moved(LOOP, 0.0, 1.0, 0.0)
    turn = float(np.abs(angle).max()) / float(hertz.bore_angle(1.0))
    if record.loads:
        allowed = "allowed is normal with a load_amplitude for an oscillating load"
    elif turn and (np.ptp(ahead) or np.ptp(aside) or abs(turn - 1.0) > SAME_ANGLE):
        allowed = "allowed is a translation or a rotation; for both use transverse-bore"
    if allowed:
        raise InputError("motion", motion, allowed)
    return Kind(motion, f"is {record.summary}", "rad" if turn else "m")


@dataclass(frozen=True, eq=False)
class Inputs:
    """Checked inputs.  Each input is also an attribute; if an input is missing, the attribute is
    None.  Quantities are converted to SI units.

    Attributes
    ----------
    kind : Kind
        Kind of the motion.
    motion : object
        The motion as the user wrote it; None for a contact without a motion.
    quantities : dict of Quantity
        The quantities, keyed by name.
    search : str or None
        Name of the input that a reduction replaces.
    given : mapping
        The inputs as the user passed them.
    """

    kind: Kind
    motion: Any
    quantities: dict[str, Quantity]
    search: str | None
    given: Mapping[str, Any] = field(repr=False)

    def __getattr__(self, name: str) -> Any:
        if name not in INPUTS:
            raise AttributeError(name)
        if INPUTS[name].unit is None:
            return self.given.get(name)
        return self.quantities[name].si if name in self.quantities else None

    def at(self, **si: Any) -> Inputs:
        """Return a copy with some values replaced.  The new values are numbers or arrays in SI
        units."""
        quantities = dict(self.quantities)
        for name, value in si.items():
            quantities[name] = replace(quantities.get(name, Quantity(0.0, "")), si=value)
        return replace(self, quantities=quantities) if si else self

    def error(self, name: str, allowed: str) -> InputError:
        """Create the InputError about an input, with the value of the input as the user wrote
        it."""
        value = self.given.get(name)
        if value is None and name in self.quantities:
            value = f"{self.quantities[name].si:.6g} {self.unit(name)}"
        return InputError(name, value, allowed)

    def unit(self, name: str) -> str:
        """Return the SI unit of a quantity."""
        return self.kind.input(name).unit or ""

    @property
    def uncertain(self) -> dict[str, Quantity]:
        """The quantities with an uncertainty."""
        return {name: one for name, one in self.quantities.items() if one.deviation}

    @cached_property
    def bodies(self) -> tuple[tuple[Material, str], ...]:
        """The body and the counterbody, each with its description."""
        return self._body(""), self._body("counter_")

    def _body(self, side: str) -> tuple[Material, str]:
        """Return a body and its description.  `side` is "counter_" for the counterbody, and "" for
        the body."""
        name, known = "counterbody" if side else "material", self.quantities
        if side or name in self.given:
            body, text = read_body(name, self.given.get(name, "rigid"))
            text += " (default)" if name not in self.given else ""
        else:
            body = Material(self.young, self.nu)
            text = f"E = {known['young'].text}, nu = {known['nu'].text}"
        for key in ("hardness", "density"):
            if one := known.get(f"{side}{key}"):
                if body.rigid:
                    raise self.error(f"{side}{key}", "allowed for an elastic body, not a rigid one")
                changes: dict[str, Any] = {key: one.si}
                body, text = replace(body, **changes), f"{text}, {key} {one.text}"
        return body, text

    @property
    def texts(self) -> dict[str, str]:
        """The inputs as the user wrote them, in the order of the printed result."""
        own = {n: str(x) for n, x in self.given.items()}
        own |= {n: one.text for n, one in self.quantities.items() if n in own}
        texts = {"motion": f"{self.motion}: the sphere {self.kind.description}"}
        texts["body"], own["counterbody"] = (text for _, text in self.bodies)
        if "map" in own:
            own["map"] = "friction from a map"
        if "contact_radius" in own:
            own.setdefault("pressure", "hertz")
        elif "radius_across" not in own:
            own.setdefault("counter_radius", "flat (default)")
        if (self.counter_radius or 0.0) < 0.0:
            own["counter_radius"] += ", hollow"
        if self.kind.stroke is not None:
            own["amplitude"] += " times the samples"
        return texts | {n: own[n] for n in INPUTS if n in own and n not in OF_BODIES}


def read_inputs(motion: Any, **given: Any) -> Inputs:
    """Read and check inputs.

    Parameters
    ----------
    motion : str or None
        Motion, as for `microslip.predict`; None for a contact without a motion, for which only
        inputs of the groups "bodies" and "load" are allowed.
    **given
        Inputs, with their names in INPUTS.  An input that is None counts as missing.

    Raises
    ------
    InputError
        If inputs are missing, contradict each other, or are out of range.  The message lists all
        missing inputs.
    """
    kind = AT_REST if motion is None else kind_of(motion)
    given = {name: value for name, value in given.items() if value is not None}
    for name in given.keys() - INPUTS.keys():
        hint = f"{near_miss(name, INPUTS)}allowed are {', '.join(INPUTS)}"
        raise InputError(name, given[name], hint)
    search, known = _check(motion, kind, given), kind.defaults | given
    quantities = {
        name: read_quantity(name, known[name], kind.input(name))
        for name, one in INPUTS.items()
        if one.unit is not None and name in known
    }
    inputs = Inputs(kind, motion, quantities, search, known)
    if all(body.rigid for body, _ in inputs.bodies):
        raise inputs.error("material", "allowed is an elastic body if the counterbody is rigid")
    return inputs


def is_range(name: str, value: object) -> bool:
    """Return True if the value of a quantity is a string with a range."""
    quantity = name in INPUTS and INPUTS[name].unit is not None
    return quantity and isinstance(value, str) and ".." in value


def read_input(name: str, value: Any) -> Quantity:
    """Read the exact value of a quantity in INPUTS and check its range.  Raises InputError."""
    return read_quantity(name, value, AT_REST.input(name))


def read_quantity(name: str, value: Any, one: Input) -> Quantity:
    """Read a quantity and check its range.  Raises InputError about the argument `name`."""
    try:
        hardness = name.endswith("hardness")
        quantity = read_hardness(value) if hardness else read(value, one.unit or "")
    except ValueError as error:
        several = hasattr(value, "__len__") and not isinstance(value, str)
        hint = "; predict_table takes a sequence, with many contacts" if several else ""
        raise InputError(name, value, f"{error}{hint}") from None
    si = quantity.si
    if not (one.low < si <= one.high or one.zero and si == one.low) or math.isinf(si):
        raise InputError(name, value, f"allowed is a finite value {one.range}".strip())
    if one.exact and quantity.deviation:
        raise InputError(name, value, "allowed is an exact value, without an uncertainty")
    return quantity


def _check(motion: Any, kind: Kind, given: Mapping[str, Any]) -> str | None:
    """Check that the inputs are complete and do not contradict each other.  Raises InputError.

    Returns the name of the input that a search determines, or None if no reduction is requested.
    """

    def refuse(arguments: str, is_wrong: object, allowed: str) -> None:
        for name in arguments.split():
            if is_wrong and name in given:
                raise InputError(name, given[name], allowed)

    names, file, moves = given.keys(), kind.stroke, kind is not AT_REST
    groups = ("bodies", "load", "drive", "output") if moves else ("bodies", "load")
    own = {*kind.needed, *kind.optional, "reduction"} if moves else set()
    others = [n for n, one in INPUTS.items() if one.group not in groups and n not in own]
    size = "a contact_radius"
    if "contact_radius" not in names:
        size = "a pressure, which needs a contact_radius in place of radii"
    steady = f"for a motion that oscillates; {motion} is steady"
    without, only_with = "allowed only without ", "allowed only with a "
    sizes, drive = names & {"contact_radius", "pressure"}, names & {"force", "drive_stiffness"}
    no_map, no_drive = "force drive_stiffness wear_coefficient", "drive_stiffness mass damping"
    needs = [f"{n} in {kind.unit}" if n == "amplitude" and kind.unit else n for n in kind.needed]
    has_none = f"{motion or 'a contact without a motion'} has none"
    has_none += f"; it needs {', '.join(needs)}" if needs else ""
    refuse(" ".join(others), True, has_none)
    refuse("frequency", file and file.frequency, f"{without}a column time, which contains it")
    refuse("map", file, f"{without}a motion from a file: no map has its unit of the amplitude")
    refuse("radius counter_radius radius_across", sizes, without + size)
    refuse("radius_across", "counter_radius" in names, f"{without}a counter_radius")
    refuse("force", "speed" in names, "allowed is a force or a speed, not both")
    refuse(no_drive, kind.steady, f"allowed only {steady}")
    refuse("drive_stiffness damping", "force" in names, f"{without}a force")
    refuse("mass", not drive, f"{only_with}force or a drive_stiffness")
    refuse("damping", "drive_stiffness" not in names, f"{only_with}drive_stiffness")
    refuse("material", names & {"young", "nu"}, f"{without}young and nu")
    refuse(no_map, "map" in names, f"{without}a map")
    refuse("reduction", drive, f"{without}a force and a drive_stiffness")
    known = given.keys() | kind.defaults.keys()
    missing = [n for n in SEARCHED if n not in known and n in (*kind.needed, "speed", "load")]
    has = f"not allowed: {motion} has {'several amplitudes' if kind.several else 'no amplitude'}"
    refuse("reduction", not kind.unit and missing != ["speed"], has)
    allowed = "allowed only without the amplitude, the speed or the load, which it determines"
    refuse("reduction", not missing, allowed)
    allowed = f"it determines one quantity, but {' and '.join(missing)} are missing"
    refuse("reduction", len(missing) > 1, allowed)
    search = missing[0] if "reduction" in given else None
    needed = {"mu": "needed", "load": "needed"} | dict.fromkeys(kind.needed, f"{motion} needs it")
    if moves and "force" not in given:
        needed["speed"] = "needed, or a force"
    if sizes:
        needed["contact_radius"] = "needed with a pressure: half the longer side of the contact"
    else:
        needed["radius"] = "needed, or a contact_radius"
    if "material" not in given:
        needed |= {"young": "needed, or a material", "nu": "needed"}
    first, *others = [n for n in needed if n not in known and n != search] or [""]
    if first:
        also = f"; also missing: {', '.join(others)}" if others else ""
        raise InputError(first, None, f"{needed[first]}{also}")
    return search
