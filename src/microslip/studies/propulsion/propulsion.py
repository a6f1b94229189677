"""Propulsion: the lines of self-propelled motions, from stall to no load."""

from microslip.config.settings import Propulsion, SelfPropelledMotion
from microslip.foundation.canonical import number

LINES_TOGETHER = 2
"""That one job computes."""


def line(study: Propulsion, motion: SelfPropelledMotion) -> dict:
    """The request for the line of a motion."""
    return {
        "kind": "propulsion",
        "motion": motion.motion,
        "amplitude": number(motion.amplitude),
        "poisson": number(motion.poisson),
        "tolerance": number(study.tolerance),
        "points": study.points,
    }


def pieces(study: Propulsion) -> tuple[list, list]:
    """Requests grouped by job: two lists of lists of requests, the slow jobs and the fast ones."""
    asked = [line(study, motion) for motion in study.motions.values()]
    distinct = [request for i, request in enumerate(asked) if request not in asked[:i]]
    return [], [distinct[i : i + LINES_TOGETHER] for i in range(0, len(distinct), LINES_TOGETHER)]
