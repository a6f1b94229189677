"""The limits from theory that stand beside the computed points in a dataset.

Each is a variable on the axes of the sweep, to compare with point by point, and a curve on an axis
fine enough to draw. A formula in theory/catalogue.py appears in the dataset of its motion.
"""

import numpy as np

from microslip.config.extended import solver_names
from microslip.config.records import Sweep
from microslip.datasets.variables import variable
from microslip.theory import catalogue
from microslip.theory.catalogue import ClosedForm

CURVE_POINTS = 241


def formulas(motion: str, pressure: str = "hertz") -> dict:
    """Closed forms of a motion under a pressure, both by the solver's names: a dict of
    catalogue.ClosedForm by name, empty if there are none."""
    if pressure == "hertz":
        return catalogue.FORMS.get(motion, {})
    from microslip.datasets.pressure_limits import formulas_under  # it takes a while to load

    return formulas_under(motion, pressure)


def _forms(sweep: Sweep) -> dict[str, ClosedForm]:
    """Closed forms that are valid for a records.Sweep; under a drive those of the amplitude."""
    if sweep.contacts is not None:
        return {}  # they are of one contact
    found = formulas(*solver_names(sweep))
    if sweep.drives:
        found = {name: form for name, form in found.items() if form.arguments == ("amplitude",)}
    return found


def _drift_forms(sweep: Sweep) -> dict[str, ClosedForm]:
    """Closed forms of the velocity under a force, for a sweep over forces."""
    motion, pressure = solver_names(sweep)
    form = catalogue.DRIFT_FORMS.get(motion)
    if sweep.contacts is not None:
        return {}
    is_map = [(name, is_axis) for name, _, is_axis in sweep.drives] == [("force", True)]
    if form is None or not is_map or not (form.any_pressure or pressure == "hertz"):
        return {}
    return {form.name: form}


def _axis(sweep: Sweep, dim: str) -> np.ndarray:
    pulls = {name: values for name, values, _ in sweep.drives}
    return np.array(pulls[dim] if dim in pulls else getattr(sweep, dim))


def variables(sweep: Sweep) -> dict:
    """Variables on the axes of a records.Sweep: name -> (dims, values, attributes)."""
    found = {}
    for name, form in (_forms(sweep) | _drift_forms(sweep)).items():
        axes = [_axis(sweep, dim) for dim in form.arguments]
        # meshgrid puts the first coordinate last, as the datasets do
        values = form.function(*np.meshgrid(*axes))
        about: dict = {"description": form.description} if form.description else {}
        found[name] = variable(form.arguments[::-1], values, form.long_name, **about)
    return found


def curves(sweep: Sweep) -> dict:
    """Limits on axes fine enough to draw, in the groups `velocity_curves` and `amplitude_curves`.

    Every limit has a variable `<name>_curve`, on the fine axis `amplitude_curve` or
    `velocity_curve`.  A limit that depends on both is given at the largest amplitude.
    """
    found: dict[str, dict] = {}
    for name, form in _forms(sweep).items():
        first, *others = form.arguments
        axes = [np.array(getattr(sweep, dim)) for dim in form.arguments]
        along, fine = f"{first}_curve", _fine(first, axes[0])
        values = form.function(fine, *(axis[-1] for axis in axes[1:]))
        at = f", at amplitude {axes[1][-1]:g}" if others else ""
        group = found.setdefault(f"{along}s", {})
        group[along] = variable((along,), fine, f"fine {first} axis of the limits")
        said = f"{form.description or form.long_name}{at}"
        group[f"{name}_curve"] = variable((along,), values, form.long_name, description=said)
    return found


def _fine(dim: str, axis: np.ndarray) -> np.ndarray:
    """A fine axis over the range of an axis; velocities in equal ratios, from the first above 0."""
    positive = axis[axis > 0.0]
    if dim == "velocity" and len(positive):
        # the same digits on every machine, whatever its logarithm rounds to
        spaced = np.geomspace(positive[0], axis[-1], CURVE_POINTS)
        return np.array([float(f"{v:.12g}") for v in spaced])
    return np.linspace(axis[0], axis[-1], CURVE_POINTS)
