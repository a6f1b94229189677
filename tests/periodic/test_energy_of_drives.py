"""Energy balance over a period: the work of vibration and drive equals the dissipation.

Elastic, kinetic and spring energy are periodic.  The vibration does work on the contact; the drive
does work on the body, a force at the body, a spring at its far end.  Slip and a dashpot dissipate
energy.  The slip dissipation at a point is the friction bound times the slip path.
"""

from dataclasses import replace

import numpy as np
import pytest
from answer.test_energy_balance import energy_of_slip

from microslip.contact.contact import Body, forces
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
}


def balance(problem, drive, model, resolution):
    """Energies of the vibration, the drive, the slip and the dashpot in a period."""
    driven, settings = replace(problem, drive=drive), Settings(slope=1.0)
    run = simulate(driven, model, resolution, 1e-6, settings=settings)
    assert run.converged, run.reason
    contact, drift = contact_of(problem, model, resolution), problem.drift
    path = path_of(problem, contact, resolution.steps)
    load = (drive.force or 0.0) - drive.damping * drift
    body, at = Body(drive.stiffness, drive.damping, drive.mass, load), run.place
    if drive.stiffness > 0.0 and not body.remembers:
        at = np.array([(load - forces(contact, run.state)[0]) / drive.stiffness, 0.0])
    march = contact.march(path, run.state, 1e-11, body=body, start=at)

    def over_time(values):
        return (path.weights @ values) * 2.0 * np.pi

    halves = 2.0 * np.pi / (path.phase[-1] - path.phase[0])
    swung = np.diff(np.transpose(problem.displacement(path.phase, 0.0)), axis=0)
    vibration = halves * np.vdot(0.5 * (march.forces[1:] + march.forces[:-1]), swung)
    places, rates = march.body.T
    if drive.force is None:
        pulled = -drive.stiffness * drift * over_time(places)
    else:
        pulled = drive.force * (halves * (places[-1] - places[0]) + 2.0 * np.pi * drift)
    damped = drive.damping * over_time((drift + rates) ** 2)
    slipped = energy_of_slip(contact, path, march)
    assert run.values["dissipation"] == pytest.approx(slipped, rel=5e-4)
    return vibration, pulled, slipped, damped


@pytest.mark.slow
@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.parametrize("place", PLACES)
def test_what_goes_in_is_dissipated(place, drive):
    motion, velocity, amplitude, poisson, model, resolution = PLACES[place]
    problem = Problem(motion_named(motion), velocity, amplitude, poisson)
    vibration, pulled, slipped, damped = balance(problem, DRIVES[drive], model, resolution)
    assert slipped + damped == pytest.approx(vibration + pulled, rel=5e-4)
    # each energy matters
    least = 0.015 * slipped
    assert vibration > least and pulled > least
    assert damped > 0.0 if DRIVES[drive].damping else damped == 0.0
