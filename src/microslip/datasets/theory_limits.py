"""Compute the theoretical limits for the dataset of a sweep.

Each closed form of datasets.catalogue is evaluated twice: at the points of the sweep for
comparison, and on a fine axis for drawing.
"""

import numpy as np

from microslip.config.settings import Sweep
from microslip.datasets import catalogue
from microslip.datasets.catalogue import ClosedForm
from microslip.datasets.variables import TABLE, described
from microslip.sweeps.request import solver_names

CURVE_POINTS = 241


def formulas(motion: str, pressure: str = "hertz") -> dict:
    """Return the closed forms for the motion and the pressure with the given names.

    The result is a dict of catalogue.ClosedForm by name.  The dict is empty if no closed form is
    known.
    """
    if pressure == "hertz":
        return catalogue.FORMS.get(motion, {})
    from microslip.datasets.pressure_limits import formulas_under  # slow to import

    return formulas_under(motion, pressure)


def _forms(sweep: Sweep) -> dict[str, ClosedForm]:
    """Return the closed forms of friction for a sweep.  If the sweep has a drive, only the forms
    that depend on the amplitude alone are returned."""
    forms = formulas(*solver_names(sweep))
    if sweep.drives:
        forms = {name: form for name, form in forms.items() if form.arguments == ("amplitude",)}
    return forms


def variables(sweep: Sweep) -> dict:
    """Evaluate the closed forms at the points of a sweep.  Returns a dict with a tuple (dims,
    values, attributes) for each name."""
    motion, pressure = solver_names(sweep)
    forms, limits = [*_forms(sweep).values()], {}
    drift = catalogue.DRIFT_FORMS.get(motion)
    if drift and [*sweep.drives] == ["force"] and len(sweep.force) > 1:
        forms += [drift] if drift.any_pressure or pressure == "hertz" else []
    for form in forms:
        axes = [np.array(sweep.axes[dim]) for dim in form.arguments]
        # In the results of meshgrid and in the datasets, the first argument is the last dimension.
        values = form.function(*np.meshgrid(*axes))
        dims = tuple(dim for dim in form.arguments[::-1] if dim in sweep.dims)
        values = np.reshape(values, [len(sweep.axes[dim]) for dim in dims])
        about = {"long_name": form.long_name, "description": form.description}
        limits[form.name] = described(about, values, dims)
    return limits


def curves(sweep: Sweep) -> dict:
    """Evaluate the closed forms on fine axes, for the groups velocity_curves and amplitude_curves.

    For each closed form, there is a variable `<name>_curve`, which depends on `velocity_curve` or
    `amplitude_curve`. A closed form that depends on velocity and amplitude is evaluated at the
    largest amplitude.
    """
    groups: dict[str, dict] = {}
    for name, form in _forms(sweep).items():
        first, *others = form.arguments
        axes = [np.array(getattr(sweep, dim)) for dim in form.arguments]
        along, fine = f"{first}_curve", _fine(first, axes[0])
        values = form.function(fine, *(axis[-1] for axis in axes[1:]))
        at = f", at amplitude {axes[1][-1]:g}" if others else ""
        group = groups.setdefault(f"{along}s", {along: described(TABLE[along], fine, (along,))})
        text = f"{form.description or form.long_name}{at}"
        about = {"long_name": form.long_name, "description": text}
        group[f"{name}_curve"] = described(about, values, (along,))
    return groups


def _fine(dim: str, axis: np.ndarray) -> np.ndarray:
    """Return a fine axis over the range of a coarse axis.

    Velocities are spaced logarithmically, starting at the smallest velocity above 0.
    """
    positive = axis[axis > 0.0]
    if dim == "velocity" and len(positive):
        # Round to twelve digits, because the last digits of logarithms depend on the machine.
        spaced = np.geomspace(positive[0], axis[-1], CURVE_POINTS)
        return np.array([float(f"{v:.12g}") for v in spaced])
    return np.linspace(axis[0], axis[-1], CURVE_POINTS)
