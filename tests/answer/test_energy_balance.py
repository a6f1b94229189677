"""The dissipated energy equals traction times slip at every point, for problems of all kinds.

`solve` computes the energy from the work of the forces on the rigid displacements.  Here it is
computed again from the friction bound and the slip of every point.  The two differ by the change
of the elastic energy, and by the errors of the time steps.
"""

from pathlib import Path

import numpy as np
import pytest

import microslip
from microslip.answer.limits import choose_model, problem_of
from microslip.contact.contact import FORWARD, forces, project, rigid_displacement
from microslip.contact.path import make_path
from microslip.periodic import simulate, static_limit

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
SEED, COUNT = 46, 200
TOLERANCE = 1e-2
QUARTER = 256
"""Number of steps in the first loading of an oscillation on a line."""


def energy_of_slip(contact, path, march):
    """Friction bound times slip in a period, summed over all points and steps."""
    stages = len(path.carry)
    bounds = contact.bound[None] if path.depth is None else contact.bounds_along(path)[:, None]
    bounds = bounds if len(bounds) == 1 else bounds[::stages]
    tractions = np.moveaxis(project(np.moveaxis(march.fields[::stages], 1, 0), bounds), 1, 0)
    places = path.positions.copy()
    if len(march.body):
        places[:, FORWARD] += march.body[:, 0]
    rigid = np.array([rigid_displacement(contact, place) for place in places])
    elastic = np.array([contact.displacement(one) for one in tractions])
    slip = np.diff(rigid - elastic, axis=0)
    bounds = np.broadcast_to(bounds, tractions[:, 0].shape)
    lost = contact.weight * 0.5 * (bounds[1:] + bounds[:-1]) * np.hypot(slip[:, 0], slip[:, 1])
    return float(lost.sum()) * 2.0 * np.pi / (path.phase[-1] - path.phase[0])


def work_of_loop(contact, oscillation, oscillating=None):
    """8 W - 4 F A, with the work W of the first loading to the force F and the amplitude A."""
    path = make_path(oscillation, np.linspace(0.0, 0.5 * np.pi, QUARTER + 1))
    start = np.zeros((2, *contact.lateral_position.shape))
    march = contact.march(path, start, 1e-8)
    mean = 0.5 * (march.forces[1:] + march.forces[:-1])
    work = np.vdot(mean, np.diff(path.positions, axis=0))
    return float(8.0 * work - 4.0 * forces(contact, march.state) @ path.positions[-1])


def both_energies(point, monkeypatch):
    """The Result with the energy of the forces, and the Result with the energy of the slip."""
    place = {name: value for name, value in point.items() if name != "stratum"}
    names = ("force", "stiffness", "mass", "damping")
    drive = {name: place.get(name) for name in names}
    rest = {k: v for k, v in place.items() if k not in (*names, "tolerance")}
    problem = problem_of(**rest, drive=drive)
    place |= {"tolerance": max(place["tolerance"], TOLERANCE), "model": choose_model(problem)}
    work = microslip.solve(**place)
    with monkeypatch.context() as patch:
        for module in (simulate, static_limit):
            patch.setattr(module, "dissipated_energy", energy_of_slip)
        patch.setattr(static_limit, "loop_energy", work_of_loop)
        slip = microslip.solve(**place)
    return work, slip


@pytest.mark.slow
@pytest.mark.parametrize("number", range(COUNT))
def test_friction_dissipates_the_work_of_the_forces(number, monkeypatch):
    """For random problems the two energies differ by at most their errors."""
    monkeypatch.syspath_prepend(BENCHMARKS)
    from blind_points import point

    drawn = point(SEED, number)
    if "contacts" in drawn:  # several contacts on one body are not solved
        return
    work, slip = both_energies(drawn, monkeypatch)
    assert work.mu_macro == slip.mu_macro or work.reason, drawn
    if not work.converged:
        return
    apart = abs(work.dissipated_energy - slip.dissipated_energy)
    errors = work.dissipated_energy_error + slip.dissipated_energy_error
    assert apart <= errors, (drawn, work.dissipated_energy, slip.dissipated_energy)
