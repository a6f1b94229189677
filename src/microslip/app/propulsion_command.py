"""The command `microslip propulsion`: force of a self-propelled motion, from stall to no load."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from microslip.app.option_parser import StoreSpelling
from microslip.app.question import Answer, add_answer, add_options, typed_options
from microslip.foundation.number_text import aligned, number_text

if TYPE_CHECKING:
    from microslip.adaptive.propulsion import PropulsionLine

OPTIONS = {
    "amplitude": ("A", "amplitude of the oscillation, as for `microslip point`"),
    "pressure": ("NAME", "pressure of the contact, as for `microslip point` (hertz)"),
    "poisson": ("NU", "Poisson's ratio, 0 to 0.5 (0)"),
    "model": ("NAME", "auto, rigid, radial, polar or cartesian (auto)"),
    "tolerance": ("T", "largest accepted error of a force, absolute (1e-3)"),
    "points": ("N", "number of points on the line, both ends included (9)"),
    "time-limit": ("SECONDS", "time limit of the computation, checked between two runs"),
}
REALS = ("amplitude", "poisson", "tolerance", "time_limit")
COLUMNS = ("force", "power_out", "power_in", "efficiency")
"""Fields of a PropulsionLine with an error estimate."""
REFERENCE_LOADS = (
    "u_lim belongs to the load without oscillation (the reference load); forces and powers are "
    "divided by mu times the mean load"
)
"""Remark for an oscillating normal load."""


def fill(parser: argparse.ArgumentParser) -> None:
    """Add the description and the arguments of `propulsion` to its parser."""
    parser.description = (
        "Some motions propel a body by themselves: a loop that is not symmetric under a shift by "
        "half a period, or a normal load that is larger on the way back.  The answer is the line "
        "from the stall force, which stops the body, to the no-load velocity.  Forces are divided "
        "by mu times the mean normal load, powers by that force times u_lim omega.  The body "
        "is heavy, so it moves at a constant velocity; a negative velocity is backward."
    )
    parser.add_argument(
        "motion",
        action=StoreSpelling,
        metavar="MOTION",
        help="elliptic or normal, with numbers after a colon, such as elliptic:forward_cycles=2",
    )
    add_options(parser, OPTIONS, required=("amplitude",))
    add_answer(parser, _answer)


def _answer(options: argparse.Namespace) -> Answer:
    from microslip import propulsion

    arguments = typed_options(options, REALS, ("points",))
    line = propulsion(options.motion, arguments.pop("amplitude"), **arguments)
    return Answer(line.to_dict(), _as_text(line), line.converged)


def _as_text(line: PropulsionLine) -> str:
    stall = number_text(line.stall_force, line.stall_force_error)
    no_load = number_text(line.no_load_velocity, line.no_load_velocity_error)
    lines = [f"stall_force = {stall}", f"no_load_velocity = {no_load}"]
    if line.motion.startswith("normal"):
        lines.append(REFERENCE_LOADS)
    if line.velocity.size:
        best = line.efficiency.argmax()
        largest = number_text(line.efficiency[best], line.efficiency_error[best])
        columns = {"velocity": (line.velocity, None)} | {
            name: (getattr(line, name), getattr(line, f"{name}_error")) for name in COLUMNS
        }
        lines += [f"largest efficiency of these points = {largest}", "", *aligned(columns)]
    if not line.converged:
        lines.append(f"NOT CONVERGED: force or power: {line.reason}")
    elif line.reason:
        lines.append(line.reason)
    return "\n".join(lines)
