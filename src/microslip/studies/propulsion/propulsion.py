"""Requests for the force-velocity lines of self-propelled motions, from stall to no load."""

from microslip.config.settings import Propulsion, SelfPropelledMotion
from microslip.foundation.canonical import number

LINES_PER_JOB = 2


def line(study: Propulsion, motion: SelfPropelledMotion) -> dict:
    """Return the request for the force-velocity line of a motion."""
    return {
        "kind": "propulsion",
        "motion": motion.motion,
        "amplitude": number(motion.amplitude),
        "poisson": number(motion.poisson),
        "tolerance": number(study.tolerance),
        "points": study.points,
    }


def pieces(study: Propulsion) -> tuple[list, list]:
    """Return the slow jobs and the fast jobs as two lists. A job is a list of requests."""
    requests = [line(study, motion) for motion in study.motions.values()]
    distinct = [request for i, request in enumerate(requests) if request not in requests[:i]]
    return [], [distinct[i : i + LINES_PER_JOB] for i in range(0, len(distinct), LINES_PER_JOB)]
