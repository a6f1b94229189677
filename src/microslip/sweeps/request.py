"""Requests, which are plain dicts with the physical and numerical settings of a computation.

Numbers in a request are canonical strings.  The name of a result is the hash of its request and of
the solver's code.  A result is therefore never outdated and never computed twice.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cache
from itertools import pairwise, product
from typing import TYPE_CHECKING, Any, NamedTuple

from microslip.config.quantities import DRIVES
from microslip.foundation import source_digest
from microslip.foundation.canonical import canonical_json, fingerprint, number, sha256

if TYPE_CHECKING:
    from microslip.config.settings import Configuration, Sweep

FORMAT = 1
"""Version of the content of records.  This version must be increased if the content changes without
a change of the solver."""
STARTS = ("stress-free", "full-rotation", "full-slip")
"""Names of the initial states in Figure 5 of the paper."""
REALS = {"velocity", "amplitude", "poisson", "tolerance", "travel", *DRIVES}
"""Keys of requests whose values are numbers written as strings."""
CONTENT_NAME = 16
"""Number of hexadecimal digits of a hash in the name of a file."""


class Batch(NamedTuple):
    """Requests of a job, obtained by combining each row with each value along an axis.

    Attributes
    ----------
    rows : sequence of dict
        Requests without the axis, or complete requests if there is no axis.
    axis : str
        Key of the axis; empty if there is no axis.
    values : sequence of str
        Values along the axis.
    """

    rows: Sequence[dict]
    axis: str = ""
    values: Sequence[str] = ()

    @property
    def requests(self) -> list[dict]:
        """All requests, ordered by row."""
        if not self.axis:
            return list(self.rows)
        return [row | {self.axis: value} for row in self.rows for value in self.values]

    @property
    def name(self) -> str:
        """Hash of the requests and of the code that computes their results."""
        code = sorted({source_digest.of_request(row) for row in self.rows})
        return fingerprint(code, self._asdict(), FORMAT)[:CONTENT_NAME]

    @property
    def folder(self) -> str:
        """Name of the folder of the batch: the name of the motion without parameters."""
        return folder_of(self.rows[0].get("motion", "none"))


def request_of(kind: str, **arguments: Any) -> dict:
    """Return a request.  A request contains the arguments of the function that computes the result.
    Numbers are converted to canonical strings."""
    texts = {name: number(v) for name, v in arguments.items() if name in REALS and v is not None}
    return {"kind": kind} | arguments | texts


def is_settled(result: dict) -> bool:
    """Return False if the solver failed or reached its time limit at a point.  The next run
    computes such a point again."""
    return not result.get("crashed") and result.get("exhausted") != "time"


def folder_of(motion: str) -> str:
    """Return the name of the folder for the batches of a motion.  The folder has the name of the
    motion or of its file, without parameters."""
    return re.sub(r"[^\w-]", "_", motion.partition(":")[0].removesuffix(".py"))


def solver_names(sweep: Sweep) -> tuple[str, str]:
    """Return the canonical names of the motion and the pressure of a sweep.

    Equal motions and equal pressures have equal names, so that they share results.
    """
    if ":" not in sweep.motion + sweep.pressure:
        return sweep.motion, sweep.pressure  # a name without numbers is canonical
    return _canonical_names(sweep.motion, sweep.pressure)


@cache
def _canonical_names(motion: str, pressure: str) -> tuple[str, str]:
    from microslip.scene.by_name import motion_named, pressure_named

    return motion_named(motion).name, pressure_named(pressure).name


def settings_of(sweep: Sweep) -> dict:
    """Return the entries that the requests of all points of a sweep have in common."""
    motion, pressure = solver_names(sweep)
    how = {name: getattr(sweep, name) for name in ("model", "tolerance", "cells", "steps")}
    how |= {} if pressure == "hertz" else {"pressure": pressure}
    how |= {} if sweep.method is None else {"method": sweep.method}
    return request_of("point" if sweep.method is None else "probe", motion=motion, **how)


def points_of(sweep: Sweep) -> Batch:
    """Return the requests for all points of a sweep.

    The order of the requests is the order of the dataset's dimensions.  The last dimension, which
    is velocity or force, changes fastest and is the axis of the batch.
    """
    axes = {name: [*map(number, values)] for name, values in sweep.axes.items()}
    last, along = axes.popitem()
    common = dict.fromkeys({"amplitude", "velocity"} - {last}) | settings_of(sweep)
    rows = [common | dict(zip(axes, place, strict=True)) for place in product(*axes.values())]
    return Batch(rows, last, along)


def runs_of(configuration: Configuration, name: str) -> list[dict]:
    """Return the requests for the single runs that are stored in the dataset of the sweep `name`.
    Figures of the kinds history, field and transients show these runs.
    """
    requests = []
    for figure in configuration.figures.values():
        if figure.run and figure.sweep == (name,):
            sweep = configuration.sweeps[name]
            motion, pressure = solver_names(sweep)
            run = {"motion": motion, "poisson": sweep.poisson[0]} | figure.run
            run |= {} if pressure == "hertz" else {"pressure": pressure}
            starts = STARTS if figure.kind == "transients" else STARTS[:1]
            if figure.kind == "field":
                requests.append(request_of("field", **run))
            else:
                run |= {} if sweep.model == "auto" else {"model": sweep.model}
                requests += [request_of("history", start=start, **run) for start in starts]
    return requests


def divide(points: Batch, size: int) -> list[Batch]:
    """Divide points into batches in the order of the points.  A batch contains whole rows, or a
    part of a long row.

    size: mean number of points in a batch.
    """
    parts = cut(points.values, size) if len(points.values) > size else [list(points.values)]
    blocks = cut(points.rows, max(size // len(points.values), 1))
    return [Batch(block, points.axis, part) for block in blocks for part in parts]


def cut(items: Sequence, mean: int) -> list[list]:
    """Divide items into lists of consecutive items, with about `mean` items each.

    The lengths of short lists differ by at most one item.  The length of a long list can differ
    from the average length by up to an eighth.  Within this margin, the hashes of the items decide
    where a list ends.  An additional item therefore changes only a few long lists.
    """
    count = max(round(len(items) / max(mean, 1)), 1)
    margin = len(items) // (16 * count)
    ends = [0]
    for index in range(1, count):
        even = index * len(items) // count
        near = range(even - margin, even + margin + 1)
        ends.append(min(near, key=lambda end: fingerprint(items[end])) if margin else even)
    return [list(items[start:end]) for start, end in pairwise([*ends, len(items)]) if start < end]


def key_of(request: dict) -> str:
    """Return the name of a request's result: a hash of the request and of the code.

    Results differ by rounding errors between versions of NumPy, SciPy and Numba.  These versions
    are stored in each result, but are not part of the name.
    """
    content = {"request": request, "source": source_digest.of_request(request), "format": FORMAT}
    return sha256(canonical_json(content))


def row_of(request: dict) -> str:
    """Return the name of a request's row: a hash of the request without its velocity or force."""
    axis = "force" if request.get("force") is not None else "velocity"
    fixed = {name: value for name, value in request.items() if name != axis}
    return fingerprint(fixed, source_digest.of_request(request))[:CONTENT_NAME]


def label(request: dict) -> str:
    """Return a short description of a request for messages."""
    names = ["pressure", "poisson", "amplitude", "velocity", *DRIVES, "start"]
    if request["kind"] != "point":
        names += ["model", "method", "cells", "angles", "steps"]
    place = ", ".join(f"{name} {request[name]}" for name in names if request.get(name) is not None)
    return f"{request.get('motion', request['kind'])} at {place}"
