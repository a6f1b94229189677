"""Compute shifts of a sphere on CONTACT's elements: pressure, tractions, energies, stiffness.

CONTACT computes a shift in one backward Euler step on equal square elements. The traction bound of
an element is friction times its pressure. The pressure is computed on the same elements, or it is
the Hertz pressure at the element's centre. Lengths are in mm and forces in N.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from microslip.contact.convolution import influence
from microslip.contact.path import EULER, make_path
from microslip.contact.squares import CartesianContact
from microslip.scene.pressure import Pressure

RESIDUAL = 1e-11
"""Residual force of the step, divided by friction times load."""
SLIDES = 1e-7
"""Slip divided by u_lim above which an element counts as slipping."""
DIFFERENCE = 1e-4
"""Shift increment in the difference quotients of the stiffness, divided by u_lim."""
JOULE = 1e-3
"""Number of joules in 1 N mm."""


def normal_problem(case: dict, centres: np.ndarray) -> dict:
    """Compute the pressure of each element, the approach of the bodies, and the elastic energy.

    Elements with a negative pressure leave the contact until all pressures are positive.

    Parameters
    ----------
    case : dict
        CONTACT case in docs/measured/published_numbers.json.
    centres : np.ndarray, shape (n,)
        Coordinates of the centres of the elements along both axes.
    """
    count, element, prescribed = len(centres), case["element"], case["prescribed"]
    modulus = case["shear_modulus"] / (1.0 - case["poisson"])
    # the influence coefficients are for a square with half a side of 1
    single = influence(count, 2 * count, 0.0, modulus)[0] * 0.5 * element * count
    i, j = np.divmod(np.arange(count**2), count)
    compliance = single[i[:, None] - i, j[:, None] - j]
    gap = case["curvature"] * (centres[:, None] ** 2 + centres**2).ravel()
    inside, pressure = np.full(count**2, True), np.array([-1.0])
    while pressure.min() < 0.0:
        sides = np.stack([np.ones(count**2), gap], axis=1)[inside]
        of_approach, of_gap = np.linalg.solve(compliance[np.ix_(inside, inside)], sides).T
        approach = prescribed.get("approach")
        if approach is None:
            needed = prescribed["load"] / element**2 + of_gap.sum()
            approach = needed / of_approach.sum()
        pressure = approach * of_approach - of_gap
        field = np.zeros(count**2)
        field[inside] = pressure
        inside[inside] = pressure > 0.0
    energy = 0.5 * field @ compliance @ field * element**2
    return {
        "pressure": field.reshape(count, count),
        "approach": approach,
        "normal_energy": energy * JOULE,
    }


def elliptical_bound(case: dict, centres: np.ndarray) -> dict:
    """Return the Hertz pressure at each element's centre, for the arguments of normal_problem."""
    radius, load = case["prescribed"]["radius"], case["prescribed"]["load"]
    inside = 1.0 - (centres[:, None] ** 2 + centres**2) / radius**2
    return {"pressure": 1.5 * load / (np.pi * radius**2) * np.sqrt(np.maximum(inside, 0.0))}


def shifted(case: dict) -> dict:
    """Solve a CONTACT case on CONTACT's own elements.

    Returns
    -------
    dict
        The values that CONTACT prints, keyed by name as in the data file. For the elements in
        contact, the dict also contains the fields `pressure`, `forward` and `lateral` (tractions on
        the shifted body in N/mm2), `slip` (in mm), and the coordinates `x` and `y`.
    """
    element, prescribed = case["element"], case["prescribed"]
    count = case["elements_along_side"]
    first = case.get("first_centre", -0.5 * (count - 1) * element)
    centres = first + np.arange(count) * element
    out = (elliptical_bound if "radius" in prescribed else normal_problem)(case, centres)
    pressure = out["pressure"]
    bound = Pressure.from_array(centres, centres, pressure)
    across = max(bound.grid.forward.steps, bound.grid.lateral.steps)
    half = 0.5 * across * element
    contact = CartesianContact(across, case["poisson"], bound)
    load = float(pressure.sum()) * element**2
    modulus = 2.0 * case["shear_modulus"] / (2.0 - case["poisson"])
    u_lim = case["friction"] * load * bound.G_star / (modulus * half)

    def force(shift: tuple[float, float]) -> np.ndarray:
        """Return the forces at a shift (forward, lateral), divided by friction times load."""
        return tractions(contact, np.array(shift) / u_lim)[1] * load / nominal

    nominal = prescribed.get("load", load)
    shift = prescribed.get("shift")
    if shift is None:
        target = prescribed["force"]
        shift = brentq(lambda one: force((one, 0.0))[0] - target, 0.0, u_lim, xtol=1e-7 * u_lim)
    state, _ = tractions(contact, np.array([shift, 0.0]) / u_lim)
    elastic = contact.displacement(state)
    slip = np.array([shift / u_lim, 0.0])[:, None, None] - elastic
    energy_unit = case["friction"] * load * u_lim * JOULE
    energy = 0.5 * np.vdot(contact.weight * state, elastic) * energy_unit
    inside = contact.bound > 0.0
    size = np.hypot(*slip)
    slips = inside & (size > SLIDES)
    small = DIFFERENCE * u_lim
    rows, columns = (np.flatnonzero(pressure.any(axis=axis)) for axis in (1, 0))
    x, y = np.meshgrid(centres[rows], centres[columns], indexing="ij")
    traction_unit = case["friction"] * load / half**2
    return out | {
        "load": load,
        "shift": shift,
        "force": force((shift, 0.0))[0],
        "largest_pressure": pressure.max(),
        "friction_work": np.vdot(contact.weight * state, slip) * energy_unit,
        "elastic_energy": out.get("normal_energy", 0.0) + energy,
        "elements": [int(n) for n in (inside.sum(), inside.sum() - slips.sum(), slips.sum())],
        "stiffness_forward": (force((shift + small, 0.0)) - force((shift - small, 0.0)))[0]
        / (2.0 * small),
        "stiffness_lateral": force((shift, small))[1] / small,
        "x": x[inside],
        "y": y[inside],
        "pressure": pressure[np.ix_(rows, columns)][inside],
        "forward": -traction_unit * state[0][inside],
        "lateral": -traction_unit * state[1][inside],
        "slip": u_lim * size[inside],
    }


def tractions(contact: CartesianContact, shift: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Compute tractions and forces (forward, lateral) after a step to a shift, in working units."""

    def displacement(phase: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return shift[0] * phase, shift[1] * phase, 0.0 * phase

    path = make_path(displacement, np.array([0.0, 1.0]), EULER)
    march = contact.march(path, np.zeros((2, *contact.bound.shape)), RESIDUAL)
    return march.state, march.forces[-1, :2]
