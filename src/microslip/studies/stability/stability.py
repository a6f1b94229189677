"""Cases of the stability study, in which all methods are tested.

An axis varies one quantity of a base point into a range where methods fail. The quantity belongs to
the point, to the resolution, or to the method. A case is a value of this quantity. All probes have
the same tolerance.
"""

from dataclasses import dataclass
from itertools import groupby

from microslip.config.settings import Stability
from microslip.foundation.canonical import canonical_json, number
from microslip.solver.method_names import SHIPPED, split
from microslip.studies import requests


@dataclass(frozen=True)
class Axis:
    """A varied quantity and its cases.

    Attributes
    ----------
    name : str
    label : str
        Label of the axis in figures (mathtext without blanks).
    note : str
        Values of the fixed quantities.
    cases : tuple
        Pairs (value, overrides). `overrides` is a dict with entries of the request: motion,
        velocity, amplitude, poisson, cells or steps.
    parameters : tuple
        Pairs of a method and the name of its varied parameter. If this is not empty, the axis
        applies only to these methods and, for comparison, to the shipped method.
    """

    name: str
    label: str
    note: str
    cases: tuple
    parameters: tuple = ()


def _varied(
    key: str | None, values: tuple[float, ...], **fixed: object
) -> tuple[tuple[float, dict], ...]:
    """Return one case for each value of the entry `key`.

    If `key` is None, the values are those of a method parameter.
    """
    return tuple((value, fixed if key is None else fixed | {key: value}) for value in values)


_SLOW = (1.0, 0.1, 0.01, 1e-3, 1e-4, 1e-5, 1e-6)
_SLOW_BORE = (1.0, 0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4)
_AROUND_ONE = (0.9, 0.99, 0.999, 1.0, 1.001, 1.01, 1.1)
_TINY = (1.0, 0.3, 0.1, 0.05, 0.02, 0.01, 1e-3)
_BASE = {"motion": "transverse", "velocity": 0.1, "amplitude": 1.0}
_BORE = {"motion": "bore", "velocity": 0.1, "amplitude": 1.0}

AXES = (
    Axis(
        *("steps", "steps in a period", "transverse, v 0.1, A 1"),
        _varied("steps", (8, 16, 32, 64, 128, 256, 512), **_BASE),
    ),
    Axis(
        *("slow-transverse", r"velocity $v_0/(\omega{}u_\mathrm{lim})$", "transverse, A 0.5"),
        _varied("velocity", _SLOW, motion="transverse", amplitude=0.5),
    ),
    Axis(
        *("slow-bore", r"velocity $v_0/(\Omega\varphi_0{}a)$", "bore, A 1"),
        _varied("velocity", _SLOW_BORE, motion="bore", amplitude=1.0),
    ),
    Axis(
        "critical-amplitude",
        r"amplitude $y_0/u_\mathrm{lim}$ around the critical one",
        "transverse, v 0.01",
        _varied("amplitude", _AROUND_ONE, motion="transverse", velocity=0.01),
    ),
    Axis(
        *("tiny-amplitude", r"amplitude $\varphi_0/\varphi_\mathrm{lk}$", "bore, v 0.001"),
        _varied("amplitude", _TINY, motion="bore", velocity=1e-3),
    ),
    Axis(
        *("poisson", r"Poisson's ratio $\nu$", "transverse, v 0.1, A 0.7"),
        _varied("poisson", (0.0, 0.1, 0.2, 0.3, 0.4, 0.49, 0.5), **_BASE | {"amplitude": 0.7}),
    ),
    # The outermost cells become small, and the friction bound tends to 0 there.
    Axis(
        *("edge", "rings: small at the edge", "transverse, v 0.01, A 0.5"),
        _varied("cells", (8, 16, 32, 64, 128), motion="transverse", velocity=0.01, amplitude=0.5),
    ),
    # The innermost cells of a polar grid become slender.
    Axis(
        *("centre", "rings: slender cells at the centre", "bore, v 0.1, A 1"),
        _varied("cells", (4, 8, 12, 16, 24), **_BORE),
    ),
    # Up to velocity 1, the contact contains the centre of rotation, where slip has no direction.
    Axis(
        "rotation-centre",
        "velocity: where the centre of rotation lies",
        "bore, A 5; inside the contact up to 1",
        _varied("velocity", (0.05, 0.2, 0.5, 0.8, 1.0, 1.2, 2.0), motion="bore", amplitude=5.0),
    ),
    Axis(
        *("reversal", "amplitude of a zigzag", "lateral speed constant but for its sign, v 0.1"),
        _varied("amplitude", (0.5, 1.0, 2.0, 5.0, 20.0, 100.0), motion="zigzag", velocity=0.1),
    ),
    Axis(
        *("step-length", "step length", "transverse, v 0.1, A 1"),
        _varied(None, (0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0), **_BASE),
        parameters=(("projected-gradient", "step"),),
    ),
)
"""All blocks of the atlas, in their order in the figure."""
TRUTH_SHARE = 0.1
"""Tolerance of the references, divided by the tolerance of the probes."""
BLOCKS_PER_JOB = 5
"""Number of blocks in one job."""


def axes(study: Stability) -> list[Axis]:
    """Return the axes in the settings, in the order of AXES."""
    return [axis for axis in AXES if study.axes is None or axis.name in study.axes]


def cases(study: Stability) -> list[tuple]:
    """Return the cases of all axes as (axis, value, overrides), in the order of the dataset."""
    return [(axis, *case) for axis in axes(study) for case in axis.cases]


def probe(study: Stability, method: str, axis: Axis, value: float, overrides: dict) -> dict | None:
    """Return the request for running a method in a case, or None if the axis does not apply."""
    if axis.parameters:
        base, _ = split(method)
        if base in dict(axis.parameters):
            method = _with_number(method, dict(axis.parameters)[base], value)
        elif base != SHIPPED:
            return None
    imposed = {key: overrides.get(key) for key in ("cells", "steps")}
    return requests.probe(_point(overrides), method, study.tolerance, **imposed)


def reference(study: Stability, overrides: dict) -> dict:
    """Return the request for the reference of a case.

    The reference uses the shipped method without an imposed resolution.
    """
    return requests.reference(_point(overrides), TRUTH_SHARE * study.tolerance)


def pieces(study: Stability) -> tuple[list, list]:
    """Return the slow jobs and the fast jobs as two lists. A job is a list of requests."""
    blocks = [list(block) for _, block in groupby(cases(study), key=lambda case: case[0].name)]
    requested: set[str] = set()
    long: list[list[dict]] = []
    short: list[list[dict]] = []
    for block in blocks:
        references = {canonical_json(r): r for r in (reference(study, case[2]) for case in block)}
        long.append([r for text, r in references.items() if text not in requested])
        requested |= references.keys()
    for method in study.methods:
        for at in range(0, len(blocks), BLOCKS_PER_JOB):
            some = [case for block in blocks[at : at + BLOCKS_PER_JOB] for case in block]
            probes = [probe(study, method, *case) for case in some]
            short.append([request for request in probes if request is not None])
    return [piece for piece in long if piece], [piece for piece in short if piece]


def _point(overrides: dict) -> requests.Point:
    return requests.Point(**{k: v for k, v in overrides.items() if k in requests.Point._fields})


def _with_number(method: str, parameter: str, value: float) -> str:
    """Return a method with one parameter changed, such as "projected-gradient:step=0.5"."""
    name, numbers = split(method)
    numbers[parameter] = value
    return f"{name}:" + ",".join(f"{key}={number(n)}" for key, n in numbers.items())
