"""The study of self-propelled motions: its settings, checked."""

from collections.abc import Iterable

from microslip.config.records import ConfigError, Propulsion, SelfPropelledMotion
from microslip.foundation.canonical import number
from microslip.foundation.errors import InputError

MOST_LINES = 8
"""That a panel can tell apart."""
MOST_PANELS = 4


def study(given: dict, where: str, ask_solver: bool) -> Propulsion:
    """The Propulsion of settings with defaults filled in.

    where: how messages begin, file and key. ask_solver: whether the solver is to say that these
    motions may drive. Raises ConfigError.
    """
    motions = [_motion(name, settings) for name, settings in given["motions"].items()]
    _refuse_crowd(motions, where)
    found = Propulsion(
        tolerance=float(number(given["tolerance"])),
        points=given["points"],
        motions={motion.name: motion for motion in motions},
    )
    if ask_solver:
        _refuse_what_drives_nothing(motions, f"{where}.motions")
    return found


def _motion(name: str, given: dict) -> SelfPropelledMotion:
    return SelfPropelledMotion(
        name=str(name),
        motion=given["motion"],
        amplitude=float(number(given["amplitude"])),
        poisson=float(number(given["poisson"])),
        panel=given["panel"],
        title=given["title"] or str(name),
    )


def _refuse_crowd(motions: Iterable[SelfPropelledMotion], where: str) -> None:
    panels: dict[str, list[str]] = {}
    for motion in motions:
        panels.setdefault(motion.panel, []).append(motion.name)
        if len(panels[motion.panel]) > MOST_LINES:
            raise ConfigError(
                f"{where}.motions.{motion.name}.panel: {motion.panel} has more than {MOST_LINES} "
                "lines; allowed: another panel"
            )
        if len(panels) > MOST_PANELS:
            raise ConfigError(
                f"{where}.motions.{motion.name}.panel: {motion.panel} is one of more than "
                f"{MOST_PANELS}; allowed: {', '.join(list(panels)[:-1])}"
            )


def _refuse_what_drives_nothing(motions: Iterable[SelfPropelledMotion], where: str) -> None:
    from microslip.adaptive.checks import checked_propulsion

    for motion in motions:
        try:
            checked_propulsion(motion.motion, motion.amplitude, poisson=motion.poisson)
        except InputError as error:  # its arguments have the names of the keys
            line = f"{where}.{motion.name}.{error.argument}: {error.value!r}: {error.allowed}"
            raise ConfigError(" ".join(line.split())) from None
