"""Energy balance over a period: the work of vibration and drive equals the dissipation.

Elastic, kinetic and spring energy are periodic.  The vibration does work on the contact; the drive
does work on the body, a force at the body, a spring at its far end.  Slip and a dashpot dissipate
energy.  The slip dissipation at a point is the friction bound times the slip path, from tractions
that are marched step by step.
"""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from microslip.contact.contact import Body, forces, rigid_displacement
from microslip.contact.path import make_path
from microslip.periodic.discretise import Resolution, contact_of, path_of
from microslip.periodic.run import Settings
from microslip.periodic.simulate import simulate
from microslip.scene.by_name import motion_named
from microslip.scene.problem import Force, Problem, Spring

DRIVES = {
    "a force": Force(0.4),
    "a force on a mass": Force(0.4, mass=0.5),
    "a spring": Spring(stiffness=0.3),
    "a spring, a mass and a dashpot": Spring(stiffness=0.3, mass=0.5, damping=0.4),
}
PLACES = {
    "rings": ("transverse", 0.2, 1.2, 0.0, "radial", Resolution(16, 1, 192)),
    "angular modes": ("bore", 0.3, 1.5, 0.3, "polar", Resolution(8, 8, 96)),
    "rings on a loop": (
        "elliptic:forward_cycles=2,phase=0",
        0.2,
        1.0,
        0.0,
        "radial",
        Resolution(12, 1, 192),
    ),
}


def balance(problem, drive, model, resolution):
    """Mean powers of the vibration, the drive, the slip and the dashpot."""
    driven = replace(problem, drive=drive)
    result = simulate(driven, model, resolution, 1e-6, settings=Settings(slope=1.0))
    assert result.converged, result.reason
    contact = contact_of(problem, model, resolution)
    load = (drive.force or 0.0) - drive.damping * problem.drift
    body = Body(drive.stiffness, drive.damping, drive.mass, load)
    q, at = result.state, result.place
    if drive.stiffness > 0.0 and not body.remembers:
        at = np.array([(load - forces(contact, q)[0]) / drive.stiffness, 0.0])
    phases = path_of(problem, contact, resolution.steps).phase
    vibration = pulled = slipped = damped = 0.0
    for begin, end in pairwise(phases):
        step = make_path(problem.displacement, np.array([begin, end]))
        march = contact.march(step, q, 1e-11, body=body, start=at)
        ahead = march.body[1, 0] - march.body[0, 0]
        travel = np.subtract(problem.displacement(end), problem.displacement(begin))
        displacement = rigid_displacement(contact, travel)
        displacement[0] += ahead
        slip = displacement - contact.displacement(march.state - q)
        slipped += np.sum(contact.weight * contact.bound * np.hypot(*slip))
        swung = np.diff([problem.oscillation(phase) for phase in (begin, end)], axis=0)[0]
        vibration += 0.5 * (forces(contact, q) + forces(contact, march.state)) @ swung
        length, places = end - begin, march.body[:, 0]
        if drive.force is None:
            pulled += -drive.stiffness * places.mean() * problem.drift * length
        else:
            pulled += drive.force * (ahead + problem.drift * length)
        damped += drive.damping * np.mean((problem.drift + march.body[:, 1]) ** 2) * length
        q = march.state
        at = march.body[1] if body.remembers else np.array([places[1], 0.0])
    return np.array([vibration, pulled, slipped, damped]) / (phases[-1] - phases[0])


@pytest.mark.slow
@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.parametrize("place", PLACES)
def test_what_goes_in_is_dissipated(place, drive):
    motion, velocity, amplitude, poisson, model, resolution = PLACES[place]
    problem = Problem(motion_named(motion), velocity, amplitude, poisson)
    vibration, pulled, slipped, damped = balance(problem, DRIVES[drive], model, resolution)
    assert slipped + damped == pytest.approx(vibration + pulled, rel=5e-4)
    # each power matters
    least = 0.015 * slipped
    assert vibration > least and pulled > least
    assert damped > 0.0 if DRIVES[drive].damping else damped == 0.0
