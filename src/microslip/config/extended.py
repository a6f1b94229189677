"""Sweeps of other motions, pressures and drives than the paper's: the keys `extended` and `drives`
of a configuration.

What the solver calls a motion or a pressure is a name with numbers, such as
"elliptic:forward=0.5,phase=30". Only the solver can tell if there is one, so it is imported by the
functions that ask it, and by nothing else: the workflow reads this whenever it is parsed.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from microslip.config import axes
from microslip.config.records import TAKEN, ConfigError, Sweep
from microslip.foundation import named_files
from microslip.foundation.errors import InputError

if TYPE_CHECKING:
    from microslip.motions.problem import Problem

MOST_PANELS = 12
"""Sweeps on a figure of maps, each as often as it has Poisson's ratios."""
MOST_LINES = 8
"""Sweeps on a figure of lines, each with a colour and a marker of its own."""


def with_files_found(given: dict, where: str, folders: Iterable, strict: bool = True) -> dict:
    """Settings by the names of their sweeps, with the places and digests of files in them.

    Whoever reads them again, such as a job, finds the same files without knowing where the
    configuration lies.

    Parameters
    ----------
    given : dict
        Settings by name, as in the configuration.
    where : str
        How messages begin, file and key.
    folders : iterable of paths
        Where files are looked for, before the working directory.
    strict : bool
        Whether a file that is not there is refused; else its name stays as it is.

    Raises
    ------
    ConfigError
        For a file that is not there or cannot be read.
    """
    found = dict(given)
    for name, settings in given.items():
        pressure = settings.get("pressure")
        if not named_files.speaks_of_file(pressure):
            continue
        try:
            file = named_files.parsed(pressure)
            if file.digest and file.path:  # found before
                named_files.remember([pressure])
                continue
            file, _ = named_files.found(pressure, folders)
        except InputError as error:
            if strict:
                said = f"{error.value!r}: {error.allowed}"
                line = f"{where}.{name}.{error.argument}: {said}"
                raise ConfigError(" ".join(line.split())) from None
        else:
            found[name] = settings | {"pressure": file.placed}
    return found


def sweeps(given: dict, where: str) -> dict:
    """Sweeps by their names, in their order; given: dict of settings with defaults filled in.

    where: how messages begin, file and key. Raises ConfigError. Whether the solver knows the
    motions and pressures is not checked, see `refuse_unsolvable`.
    """
    found = {}
    for name, settings in given.items():
        if name in TAKEN or name.removeprefix("certified_") in given.keys() - {name}:
            raise ConfigError(f"{where}.{name}: another result has this name; allowed: a new one")
        more = {"group": settings["group"], "title": settings["title"] or name}
        more["pressure"] = _by_content(settings["pressure"])
        found[name] = axes.grid_of(name, settings["motion"], settings, f"{where}.{name}", **more)
    return found


def pulled_sweeps(given: dict, where: str, others: Iterable) -> dict:
    """Sweeps of what is pulled by their names, in their order; given, where: as for `sweeps`.

    others: names that are taken already. Raises ConfigError.
    """
    found, others = {}, set(others)
    for name, settings in given.items():
        at = f"{where}.{name}"
        names = given.keys() | others
        if name in TAKEN or name in others or name.removeprefix("certified_") in names - {name}:
            raise ConfigError(f"{at}: another result has this name; allowed: a new one")
        drives = axes.drives_of(settings, at)
        if not drives:
            raise ConfigError(f"{at}: missing; required: force or stiffness")
        more = {"title": settings["title"] or name, "drives": drives}
        more["contacts"] = settings["contacts"]
        more["pressure"] = _by_content(settings["pressure"])
        found[name] = axes.grid_of(name, settings["motion"], settings, at, **more)
    return found


def _by_content(pressure: str) -> str:
    """The name of a pressure, without the place of a file whose content is known."""
    if not named_files.speaks_of_file(pressure):
        return pressure
    file = named_files.parsed(pressure)
    return file.name if file.digest else pressure


def refuse_mixtures(given: list, where: str) -> None:
    """Raise ConfigError for a group of Sweeps that cannot be one figure; where: as above."""
    for group in dict.fromkeys(sweep.group for sweep in given):
        _refuse_mixture([sweep for sweep in given if sweep.group == group], where)


def _refuse_mixture(together: list[Sweep], where: str) -> None:
    first, last = together[0], together[-1]
    for sweep in together:
        if sweep.drawn_over != first.drawn_over:
            raise ConfigError(
                f"{where}.{sweep.name}.group: {sweep.group} is drawn over {first.drawn_over}, as "
                f"{first.name} asks, and this over {sweep.drawn_over}; allowed: another group"
            )
    most = MOST_PANELS if first.spans_a_map else MOST_LINES
    drawn = sum(len(sweep.poisson) for sweep in together)
    if drawn > most:
        ratios = " at their Poisson's ratios" if drawn > len(together) else ""
        raise ConfigError(
            f"{where}.{last.name}.group: {first.group} has {drawn} sweeps{ratios}; allowed: up to "
            f"{most}, or another group"
        )


def refuse_unsolvable(given: list, where: str) -> None:
    """Raise ConfigError where the solver refuses one of the Sweeps; where: as above."""
    for sweep in given:
        try:
            _ask_solver(sweep, f"{where}.{sweep.name}")
        except InputError as error:  # its arguments have the names of the keys
            line = f"{where}.{sweep.name}.{error.argument}: {error.value!r}: {error.allowed}"
            raise ConfigError(" ".join(line.split())) from None
        except ConfigError:
            raise
        except ValueError as error:  # what reads a file may say it in its own words
            line = f"{where}.{sweep.name}: {error}"
            raise ConfigError(" ".join(line.split())) from None


def _ask_solver(sweep: Sweep, where: str) -> None:
    """Raise InputError, in the solver's words, for what it does not know or do; ConfigError for an
    amplitude that is missing, or too much."""
    from microslip.motions.by_name import motion_named
    from microslip.pressures.by_name import pressure_named

    motion = motion_named(sweep.motion)
    pressure_named(sweep.pressure)
    if motion.periodic and sweep.amplitude is None:
        raise ConfigError(f"{where}.amplitude: missing; required for {motion.name}")
    if sweep.amplitude is not None and not motion.periodic:
        raise ConfigError(
            f"{where}.amplitude: {list(sweep.amplitude)} is not allowed; {motion.name} has no "
            "amplitude"
        )
    if sweep.model != "auto":
        from microslip.adaptive.choice import choose_model

        choose_model(_problem(sweep, 1.0, -1), sweep.model)
    if sweep.velocity[:1] == (0,):
        _problem(sweep, 0.0, 0)
    if sweep.drives:
        _ask_of_drive(sweep)


def _problem(sweep: Sweep, velocity: float | None, end: int, **drive: float | None) -> Problem:
    """The problem of a Sweep at a velocity and one end of its amplitudes; raises InputError."""
    from microslip.adaptive.checks import checked_driven_problem

    return checked_driven_problem(
        sweep.motion,
        velocity,
        None if sweep.amplitude is None else sweep.amplitude[end],
        pressure=sweep.pressure,
        poisson=sweep.poisson[-1],
        contacts=sweep.contacts,
        **drive,
    )


def _ask_of_drive(sweep: Sweep) -> None:
    """Raise InputError for what does not go together, or with the motion, at any point."""
    from microslip.adaptive.choice import choose_model
    from microslip.adaptive.pulled import refuse_drive

    drives = {name: values for name, values, _ in sweep.drives}
    for end in (0, -1):
        given = {name: drives[name][end] if name in drives else None for name in axes.DRIVES}
        velocity = sweep.velocity[end] if sweep.velocity else None
        problem = _problem(sweep, velocity, -1, **given)
        refuse_drive(problem, choose_model(problem, sweep.model))


def solver_names(sweep: Sweep) -> tuple[str, str]:
    """Names of a Sweep's motion and pressure as the solver writes them, however they were given.

    Equal ones are written alike, so that their points are found again.
    """
    if ":" not in sweep.motion + sweep.pressure:
        return sweep.motion, sweep.pressure  # there are no two ways to write a plain name
    from microslip.motions.by_name import motion_named
    from microslip.pressures.by_name import pressure_named

    return motion_named(sweep.motion).name, pressure_named(sweep.pressure).name
