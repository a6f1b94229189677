"""Driving: the lines of motions that drive the contact, from stall to no load."""

from microslip.config.records import Driving, DrivingMotion
from microslip.foundation.canonical import number

LINES_TOGETHER = 2
"""That one job computes."""


def line(study: Driving, motion: DrivingMotion) -> dict:
    """The request for the line of a motion.

    study: records.Driving. motion: records.DrivingMotion.
    """
    return {
        "kind": "drive",
        "scene": motion.scene,
        "amplitude": number(motion.amplitude),
        "poisson": number(motion.poisson),
        "tolerance": number(study.tolerance),
        "points": study.points,
    }


def pieces(study: Driving) -> tuple[list, list]:
    """What one job each answers: two lists of lists of requests, those that take long first."""
    asked = [line(study, motion) for motion in study.motions.values()]
    distinct = [request for i, request in enumerate(asked) if request not in asked[:i]]
    return [], [distinct[i : i + LINES_TOGETHER] for i in range(0, len(distinct), LINES_TOGETHER)]
