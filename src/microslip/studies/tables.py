"""Records to columns: what the datasets of the studies share."""

import numpy as np
import xarray as xr

import microslip

from ..dataset import CONVENTIONS, PAPER
from ..keys import canonical_json, sha256, source_digest


class Answers:
    """Results by request; takes note of their names and of the versions of libraries behind them.

    answer(request) -> record, see microslip.sweep.
    """

    def __init__(self, answer):
        self.answer, self.keys, self.versions = answer, set(), set()

    def __call__(self, request):
        record = self.answer(request)
        self.keys.add(record["key"])
        self.versions.add(canonical_json(record["versions"]))
        return record["result"]


def value_of(result, name, kind=float):
    """A value of a result as `kind`; for what is not there NaN, 0, False or empty text."""
    value = result.get(name)
    if value is None:
        return np.nan if kind is float else kind()
    return kind(value)


def variable(dims, values, long_name, kind=float, units="1"):
    """A variable of a dataset with its attributes; kind: type of its values."""
    values = np.asarray(values)
    if kind is str:
        return dims, values.astype(object), {"long_name": long_name}
    if kind is bool:
        flags = {"flag_values": np.array([0, 1], np.int8), "flag_meanings": "no yes"}
        return dims, values.astype(bool), {"long_name": long_name} | flags
    return dims, values.astype(kind), {"long_name": long_name, "units": units}


def finished(variables, coords, title, answers, settings, **attributes):
    """A Dataset with what says where it comes from; settings: dict, kept as JSON."""
    described = {
        "Conventions": CONVENTIONS,
        "title": title,
        "references": PAPER,
        "microslip_version": microslip.__version__,
        "source_digest": source_digest(),
        # The names of all results: they depend on the sources of the methods, too.
        "results_digest": sha256("\n".join(sorted(answers.keys))),
        "configuration": canonical_json(settings),
        "library_versions": "; ".join(sorted(answers.versions)),
    }
    return xr.Dataset(variables, coords, described | attributes)
