"""Count iterations of the step solvers in microslip.contact, for several constants.

    PYTHONPATH=src python benchmarks/splitting.py

For each value of a constant, the tables show the mean number of iterations per step during the
search for the periodic state. The cases are few and many rings, a bore, and squares.
"""

import numpy as np

from microslip.contact import convolution, ring_contact, splitting
from microslip.contact.modes import polar_contact
from microslip.contact.ring_contact import RadialContact
from microslip.periodic.discretise import Resolution
from microslip.periodic.simulate import simulate
from microslip.scene.by_name import motion_named
from microslip.scene.problem import Problem

POINTS = ((0.1, 1.0), (0.01, 0.3), (1.0, 3.0))
"""Velocities and amplitudes."""
CONTACTS = {
    "12 rings": ("transverse", "radial", Resolution(12, 1, 32)),
    "48 rings": ("transverse", "radial", Resolution(48, 1, 32)),
    "192 rings": ("transverse", "radial", Resolution(192, 1, 32)),
    "bore, 12 rings": ("bore", "polar", Resolution(12, 8, 16)),
    "16 squares": ("transverse", "cartesian", Resolution(16, 1, 16)),
}


def iterations(motion, model, resolution):
    """Return the number of iterations per step, averaged over the points."""
    runs = [
        simulate(Problem(motion_named(motion), *point, 0.0), model, resolution, 1e-5)
        for point in POINTS
    ]
    return np.mean([run.effort.iterations / run.effort.solves for run in runs])


def table(name, values, set_value, contacts):
    """Print the iterations for each value of a constant."""
    print(f"{name:20s}" + "".join(f"{contact:>16s}" for contact in contacts))
    for value in values:
        set_value(value)
        for cached in (RadialContact.resolved, polar_contact):
            cached.cache_clear()
        counts = [iterations(*CONTACTS[contact]) for contact in contacts]
        print(f"{value:<20g}" + "".join(f"{count:16.1f}" for count in counts))


def main():
    contacts = [name for name in CONTACTS if "squares" not in name]

    def balanced(value):
        splitting.BALANCED_RINGS = value

    table("BALANCED_RINGS", (3, 6, 12, 24, 48), balanced, contacts)
    balanced(12)

    def ratio(value):
        """Set the ratio of consecutive penalties. With 1, all steps have the same penalty."""
        penalties = value ** (np.arange(4) - 1.5)
        for module in (splitting, ring_contact):
            module.PENALTIES = penalties

    table("ratio of penalties", (1.0, 1.5, 2.0, 3.0), ratio, contacts)
    ratio(2.0)

    def patience(value):
        convolution.PATIENCE = value

    table("PATIENCE", (15, 30, 60, 120), patience, ["16 squares"])


if __name__ == "__main__":
    main()
