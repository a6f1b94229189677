"""Sweeps of other motions and pressures than the paper's: the key `extended` of a configuration.

What the solver calls a motion or a pressure is a name with numbers, such as
"elliptic:forward=0.5,phase=30". Only the solver can tell if there is one, so it is imported by the
functions that ask it, and by nothing else: the workflow reads this whenever it is parsed.
"""

from . import grids
from .settings import TAKEN, ConfigError

MOST_PANELS = 12
"""Sweeps on a figure of maps, each as often as it has Poisson's ratios."""
MOST_LINES = 8
"""Sweeps on a figure of lines, each with a colour and a marker of its own."""


def sweeps(given, where):
    """Sweeps by their names, in their order; given: dict of settings with defaults filled in.

    where: how messages begin, file and key. Raises ConfigError. Whether the solver knows the
    motions and pressures is not checked, see `refuse_unsolvable`.
    """
    found = {}
    for name, settings in given.items():
        if name in TAKEN:
            raise ConfigError(f"{where}.{name}: another result has this name; allowed: a new one")
        more = {key: settings[key] for key in ("pressure", "group")}
        more["title"] = settings["title"] or name
        found[name] = grids.grid_of(name, settings["scene"], settings, f"{where}.{name}", **more)
        grids.refuse_static_model(found[name], f"{where}.{name}")
    return found


def refuse_mixtures(given, where):
    """Raise ConfigError for a group of Sweeps that cannot be one figure; where: as above."""
    for group in dict.fromkeys(sweep.group for sweep in given):
        _refuse_mixture([sweep for sweep in given if sweep.group == group], where)


def _refuse_mixture(together, where):
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


def refuse_unsolvable(given, where):
    """Raise ConfigError where the solver refuses one of the Sweeps; where: as above."""
    for sweep in given:
        try:
            _ask_solver(sweep)
        except ValueError as error:
            # It begins with the name of an argument, which is that of the key, and its value.
            key, _, rest = str(error).partition(" = ")
            raise ConfigError(f"{where}.{sweep.name}.{key}: {rest}") from None


def _ask_solver(sweep):
    """Raise ValueError, in the solver's words, for what it does not know or do."""
    scene = _scene_of(sweep)
    if scene.periodic and sweep.amplitude is None:
        raise ValueError(f"amplitude = missing; required for {scene.name}")
    if sweep.amplitude is not None and not scene.periodic:
        raise ValueError(
            f"amplitude = {list(sweep.amplitude)} is not allowed; {scene.name} has no amplitude"
        )
    if sweep.model != "auto":
        from .choice import choose_model

        choose_model(scene, sweep.poisson[-1], sweep.model)
    if sweep.velocity[0] == 0:
        from .point import checked_point

        amplitude = sweep.amplitude and sweep.amplitude[0]
        checked_point(sweep.scene, 0, amplitude, sweep.poisson[-1], sweep.pressure)


def solver_names(sweep):
    """Names of a Sweep's scene and pressure as the solver writes them, however they were given.

    Equal ones are written alike, so that their points are found again.
    """
    if ":" not in sweep.scene + sweep.pressure:
        return sweep.scene, sweep.pressure  # there are no two ways to write a plain name
    scene = _scene_of(sweep)
    return scene.name, scene.pressure.name


def _scene_of(sweep):
    """The Scene of a Sweep; raises ValueError where the solver knows no such motion or pressure."""
    from .scenes import scene_named

    if sweep.pressure.startswith("file:"):
        from . import pressure_files  # noqa: F401  tells the solver how to read them
    return scene_named(sweep.scene, sweep.pressure)
