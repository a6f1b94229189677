"""Pack the data of the form for a real contact: fields, units, materials, rules, and friction
tables.

The rules and the texts of their warnings come from si.warnings. A table contains friction on a
regular grid, interpolated from a certified map. The page therefore needs only linear interpolation.
"""

from __future__ import annotations

import numpy as np
import xarray as xr
from scipy.ndimage import maximum_filter

from microslip.foundation.canonical import plain
from microslip.foundation.number_text import PREFIXES
from microslip.foundation.units import read
from microslip.report.motions import MOTIONS
from microslip.si import inputs, warnings
from microslip.si.contact import LARGEST_RATIO
from microslip.si.materials import MATERIALS
from microslip.sweeps.period_codec import text_of
from microslip.theory.hertz import D_half

COUNTS = {"velocity": 129, "amplitude": 129, "poisson": 6}
"""Number of coordinates of a table along each axis that has more than one value."""
LARGEST = 65535
"""Largest unsigned integer of two bytes."""
OF_NUMBERS = "by E and ν"
"""Entry in the list of materials that lets the user enter Young's modulus and Poisson's ratio."""
ADHESION = ("adhesion", "range", "short", "rubbery")
"""Constants of si.warnings that the rules on adhesion use; the names are in lower case."""
PRESSURES = ("GPa", "MPa", "kPa", "Pa", "psi")
FIELDS = {
    "radius": ("radius of the sphere", "radius", ("mm", "um", "m", "inch"), "5"),
    "load": ("normal load", "load", ("N", "mN", "uN", "kN", "kgf", "lbf"), "10"),
    "young": ("E of the sphere", "young", PRESSURES, "210"),
    "nu": ("ν of the sphere", "nu", ("",), "0.3"),
    "counter_young": ("E of the flat", "young", PRESSURES, "210"),
    "counter_nu": ("ν of the flat", "nu", ("",), "0.3"),
    "mu": ("μ without vibration", "mu", ("",), "0.3"),
    "speed": ("forward speed", "speed", ("mm/s", "um/s", "m/s", "m/min", "km/h"), "10"),
    "frequency": ("frequency", "frequency", ("kHz", "Hz", "MHz", "rpm", "rad/s"), "20"),
    "stroke": ("amplitude (half stroke)", "amplitude", ("um", "nm", "mm", "m"), "0.3"),
    "angle": ("amplitude (half angle)", "rotation_amplitude", ("mrad", "deg", "rad"), "1"),
}
"""For each field, in the order of the form: the label, the input in si.inputs, the units and the
default number. The first unit is the default."""


def packed() -> dict:
    """Pack the data of the form as JSON values."""
    fields: dict[str, dict] = {}
    units: dict[str, float] = {}
    for name, (label, one, names, example) in FIELDS.items():
        known = inputs.INPUTS[one]
        about = {"label": label, "units": names, "example": example, "high": plain(known.high)}
        fields[name] = about | {"low": known.low, "zero": known.zero}
        units |= {unit: read(f"1 {unit}", known.unit or "").si for unit in names}
    return {
        "motions": {name: f"{name}: {inputs.MOTIONS[name].description}" for name in MOTIONS},
        "fields": fields,
        "units": units,
        "sides": {"material": ["young", "nu"], "counterbody": ["counter_young", "counter_nu"]},
        "amplitude_of": {"transverse": "stroke", "bore": "angle"},
        "chosen": {"material": "steel", "counterbody": "steel", "motion": "transverse"},
        "of_numbers": OF_NUMBERS,
        "materials": {name: plain(vars(body)) for name, body in MATERIALS.items()},
        "checks": [[rule._asdict() for rule in rules] for rules in warnings.CHECKS],
        "properties": warnings.PROPERTIES,
        "missing": warnings.MISSING,
        "whose": warnings.SIDES,
        "adhesion": {name: getattr(warnings, name.upper()) for name in ADHESION},
        "prefixes": list(PREFIXES.items()),
        "largest_share": LARGEST_RATIO,
        "half_stuck": D_half(),
    }


def table(dataset: xr.Dataset) -> dict:
    """Pack the friction and the error bound of a certified map on a regular grid.

    The page interpolates linearly in the logarithm of the velocity, in the amplitude and in
    Poisson's ratio. The error bound of a cell is a sum of two terms. The first is the largest error
    bound of the map in the cell. The second is twice the largest difference between the linear
    interpolation and the map. The differences are computed at the centre of the cell and at the
    midpoints of its edges and faces. If the function is a parabola or has a kink, the interpolation
    error is at most twice the difference between the function and the interpolation at a midpoint.
    """
    ends = {name: (float(dataset[name].min()), float(dataset[name].max())) for name in COUNTS}
    axes = {
        name: (np.geomspace if name == "velocity" else np.linspace)(*ends[name], 2 * count - 1)
        for name, count in COUNTS.items()
        if ends[name][1] > ends[name][0]
    }  # with the midpoints
    fine = dataset.microslip.at(**{name: axes[name].clip(*ends[name]) for name in axes})
    fine = fine.expand_dims([name for name in COUNTS if name not in axes])
    fine = fine.transpose("poisson", "amplitude", "velocity")
    value, error = fine["mu_macro"].values, fine["mu_macro_error"].values
    line = nodes = value[::2, ::2, ::2]
    for axis in range(3):
        line = _with_midpoints(line, axis)
    bound = error + 2.0 * np.abs(value - line) + 0.5 / LARGEST
    bound = np.where(np.isfinite(bound), bound, np.inf)
    bound = maximum_filter(bound, 3)[tuple(slice(size > 1, None, 2) for size in bound.shape)]
    known = np.isfinite(bound)
    step = float(bound[known].max(initial=1e-9)) / (LARGEST - 1)
    codes = np.where(known, np.ceil(bound / step), LARGEST)
    return {
        "motion": dataset.attrs["motion"],
        **{name: list(both) for name, both in ends.items()},
        "counts": list(nodes.shape[::-1]),
        "values": text_of(np.round(LARGEST * np.nan_to_num(nodes).clip(0, 1)).astype(np.uint16)),
        "errors": text_of(np.minimum(codes, LARGEST).astype(np.uint16)),
        "error_step": step,
    }


def _with_midpoints(values: np.ndarray, axis: int) -> np.ndarray:
    """Between any two neighbouring values along an axis, insert their mean."""
    rows = np.moveaxis(values, axis, 0)
    result = np.repeat(rows, 2, axis=0)[:-1]
    result[1::2] = (rows[1:] + rows[:-1]) / 2.0
    return np.moveaxis(result, 0, axis)
