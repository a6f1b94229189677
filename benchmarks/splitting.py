"""Count iterations of the step solvers in microslip.contact, for several constants.

    PYTHONPATH=src python benchmarks/splitting.py

For each value of a constant, the tables show the mean number of iterations per step during the
search for the periodic state. The cases are few and many rings, a bore, and squares.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from microslip.contact import convolution, ring_contact
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


def at_ratio(value, contacts):
    """Return the iterations for a ratio of consecutive penalties, in a process of its own.

    Compiled code contains the penalties, so it is compiled anew.  With the ratio 1, all steps have
    the same penalty.
    """
    code = (
        "import numpy as np; from microslip.contact import splitting as kernels\n"
        f"kernels.PENALTIES = {value} ** (np.arange(4) - 1.5)\n"
        "from splitting import CONTACTS, iterations\n"
        f"print(*(iterations(*CONTACTS[contact]) for contact in {contacts}))"
    )
    with tempfile.TemporaryDirectory() as folder:
        paths = os.pathsep.join([str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")])
        environment = os.environ | {"NUMBA_CACHE_DIR": folder, "PYTHONPATH": paths}
        command = [sys.executable, "-c", code]
        out = subprocess.run(command, env=environment, check=True, capture_output=True, text=True)
    return [float(count) for count in out.stdout.split()]


def main():
    contacts = [name for name in CONTACTS if "squares" not in name]

    def balanced(value):
        ring_contact.BALANCED_RINGS = value

    table("BALANCED_RINGS", (3, 6, 12, 24, 48), balanced, contacts)
    balanced(12)

    print(f"{'ratio of penalties':20s}" + "".join(f"{contact:>16s}" for contact in contacts))
    for value in (1.0, 1.5, 2.0, 3.0):
        counts = at_ratio(value, contacts)
        print(f"{value:<20g}" + "".join(f"{count:16.1f}" for count in counts))

    def patience(value):
        convolution.PATIENCE = value

    table("PATIENCE", (15, 30, 60, 120), patience, ["16 squares"])


if __name__ == "__main__":
    main()
