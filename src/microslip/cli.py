"""The command line: ``microslip point SCENE ...`` answers for one point, ``sweep`` for many."""

from __future__ import annotations

import argparse
import difflib
import json
import sys

from microslip import __version__, cli_predict, launch


class _OneLineParser(argparse.ArgumentParser):
    """Bad input gets one line on standard error and exit code 2."""

    def error(self, message):
        _complain(f"{self.prog}: {message} (see {self.prog} --help)")
        raise SystemExit(2)

    def parse_known_args(self, args=None, namespace=None):
        self._refuse_unknown_options(args)
        return super().parse_known_args(args, namespace)

    def _refuse_unknown_options(self, words):
        """Before argparse does, which would rather say that the right one is missing."""
        known = self._option_string_actions
        for word in words:
            if self._subparsers and not word.startswith("-"):
                return  # what follows belongs to a command
            name = word.partition("=")[0]
            strange = word.startswith("-") and name.strip("-") and name not in known
            if strange and not _is_number(word):
                self._refuse_option(name, [n for n in known if n.startswith("--")])

    def _refuse_option(self, name, known):
        near = difflib.get_close_matches(f"--{name.lstrip('-')}", known, n=1)
        hint = f"did you mean {near[0]}? " if near else ""
        first = [action.metavar for action in self._actions if action.nargs == argparse.PARSER]
        allowed = ", ".join([*known, *(f"{command} before other options" for command in first)])
        self.error(f"unknown option {name}; {hint}allowed: {allowed}")


def _complain(message):
    print(" ".join(message.split()), file=sys.stderr)


def _real(text):
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not allowed; allowed: a number") from None


def _real_or_none(text):
    return None if text == "none" else _real(text)


def _seconds(text):
    if not _real(text) > 0.0:
        raise argparse.ArgumentTypeError(f"{text!r} is not allowed; allowed: a number above 0")
    return _real(text)


def _whole(text):
    try:
        return int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"{text!r} is not allowed; allowed: an even whole number"
        ) from None


def build_parser(asked=None):
    """Parser of the command line, with all that follows the command ``asked``."""
    parser = _OneLineParser(
        allow_abbrev=False,
        prog="microslip",
        description="How far friction falls when a frictional contact is vibrated: an elastic "
        "sphere on a flat (Hertz contact, Coulomb friction at every point) slides forward while "
        "it also oscillates or rotates.  All quantities are dimensionless.",
    )
    parser.add_argument("--version", action="version", version=f"microslip {__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    point = commands.add_parser(
        "point",
        allow_abbrev=False,
        help="macroscopic friction at one (velocity, amplitude)",
        description="Mean forward friction force over mu F_z at one point, with an error estimate. "
        "1 means that the vibration does nothing, 0 that it takes all friction away.",
    )
    commands.add_parser("sweep", help="the workflow: maps, datasets and figures, by Snakemake")
    if asked == "point":
        _add_motions(point)
    else:
        point.add_argument("scene", metavar="SCENE")
    cli_predict.add_parser(commands)
    return parser


def _add_motions(parser):
    """A parser for each motion; what they are is asked of the solver, so only where it counts."""
    from microslip.scenes import FAMILIES, SCENES

    scenes = parser.add_subparsers(dest="scene", required=True, metavar="SCENE")
    known = {name: (scene.summary, scene.periodic, None) for name, scene in SCENES.items()}
    known |= {name: (family.SUMMARY, True, family.HELP) for name, family in FAMILIES.items()}
    for name, (summary, periodic, path) in known.items():
        scene = scenes.add_parser(
            name,
            help=summary,
            description=f"The indenter is {summary}. u_lim: the tangential displacement at which "
            "the whole contact slides; a: contact radius; phi_lk(a/2): the angle that leaves half "
            "of it sticking.",
            allow_abbrev=False,
        )
        record = SCENES.get(name) or FAMILIES[name].scene(name, **FAMILIES[name].DEFAULTS)
        scene.add_argument(
            "--velocity",
            type=_real,
            required=True,
            metavar="V",
            help=f"{record.velocity_label}; 0: v -> 0",
        )
        if periodic:
            scene.add_argument(
                "--amplitude", type=_real, required=True, metavar="A", help=record.amplitude_label
            )
        if path:
            scene.add_argument("--path", metavar="NUMBERS", help=path)
        _add_options(scene)


def _add_options(parser):
    parser.add_argument(
        "--pressure",
        default="hertz",
        metavar="NAME",
        help="hertz (a sphere), power:exponent=1 (a cone; any power), punch:flat=0.8 (rounded "
        "edge), ring:inner=0.5, ellipse:ratio=0.5 (across=1: long axis across), or file:FILE, a "
        "grid of forward,lateral,pressure (hertz)",
    )
    parser.add_argument(
        "--poisson", type=_real, default=0.0, metavar="NU", help="Poisson's ratio, 0 to 0.5 (0)"
    )
    parser.add_argument(
        "--model",
        default="auto",
        metavar="NAME",
        help="auto (the cheapest that is right), rigid, slider, dahl, mdr, radial, polar or "
        "cartesian",
    )
    parser.add_argument(
        "--tolerance",
        type=_real_or_none,
        default=1e-3,
        metavar="T",
        help="largest accepted error of mu_macro, absolute (1e-3); none, where cells and steps are "
        "imposed: whatever their error is",
    )
    parser.add_argument(
        "--cells",
        type=_whole,
        metavar="N",
        help="impose N rings, or N x N squares (even, from 4 on)",
    )
    parser.add_argument("--steps", type=_whole, metavar="N", help="impose N steps a period (even)")
    parser.add_argument(
        "--time-limit",
        type=_seconds,
        metavar="SECONDS",
        help="give up after so long, looked at between two marches; the answer is not kept then",
    )
    parser.add_argument(
        "--method",
        default="shipped",
        metavar="NAME",
        help="another way to compute it, for comparison: the name of a file in microslip/methods",
    )
    parser.add_argument(
        "--results",
        metavar="FOLDER",
        help="look the answer up in a folder of results, say of a sweep, and keep it there",
    )
    parser.add_argument(
        "--json", action="store_true", help="print one JSON object and nothing else"
    )


def main(arguments=None):
    """Entry point.  Exit codes: 0 converged, 1 not converged, 2 bad input; sweep: Snakemake's."""
    arguments = sys.argv[1:] if arguments is None else arguments
    if arguments[:1] == ["sweep"]:  # not for argparse: what follows is Snakemake's
        return launch.main(arguments[1:])
    options = build_parser(next(iter(arguments), None)).parse_args(_joined(arguments))
    if options.command == "predict":
        return cli_predict.run(options)
    from microslip.answers import plain  # only now: --help and bad options need no solver
    from microslip.cache import CacheError

    progress = _Progress(enabled=sys.stderr.isatty())
    try:
        result = _answer(options, progress)
    except (ValueError, CacheError) as error:
        named = "--" if isinstance(error, ValueError) else "--results: "
        problem = str(error).replace("scene = ", "path = ", 1)  # the scene itself is known
        _complain(f"microslip point {options.scene}: {named}{problem}")
        return 2
    finally:
        progress.close()
    if options.json:
        print(json.dumps({"amplitude": None} | plain(result.to_dict())))
    else:
        print(_as_text(result))
    return 0 if result.converged else 1


def _answer(options, progress):
    """What the options ask for; raises ValueError and CacheError as microslip.solve_stored."""
    from microslip import solve, solve_stored

    path = getattr(options, "path", None)
    scene = f"{options.scene}:{path}" if path else options.scene
    place = (scene, options.velocity, getattr(options, "amplitude", None))
    names = ("pressure", "poisson", "model", "tolerance", "cells", "steps", "time_limit")
    settings = {name: getattr(options, name) for name in names}
    if options.results is None:
        return solve(*place, **settings, method=options.method, progress=progress)
    if options.method != "shipped":
        raise ValueError(
            f"method = {options.method!r}: not with --results, which keeps points of sweeps"
        )
    return solve_stored(*place, **settings, results=options.results)


def _joined(arguments):
    """Options and negative numbers, with a unit or not, as one word: argparse takes -1e-3 for an
    option."""
    out = []
    for word in arguments:
        number = word.partition(" ")[0]
        if word.startswith("-") and out and out[-1].startswith("--") and _is_number(number):
            out[-1] += f"={word}"
        else:
            out.append(word)
    return out


def _is_number(word):
    try:
        float(word)
    except ValueError:
        return False
    return True


class _Progress:
    """A line on standard error that counts the runs; silent where nobody looks."""

    def __init__(self, enabled):
        self.enabled, self.bar = enabled, None

    def __call__(self, resolution):
        if not self.enabled:
            return
        if self.bar is None:
            from tqdm import tqdm

            self.bar = tqdm(unit=" runs", leave=False)
        self.bar.set_description(
            f"{resolution.cells} cells, {resolution.angles} angles, {resolution.steps} steps"
        )
        self.bar.update()

    def close(self):
        if self.bar is not None:
            self.bar.close()


def _as_text(result):
    lines = [f"mu_macro = {result.mu_macro:.6g} +- {result.mu_macro_error:.1g}"]
    if result.mu_torque is not None:
        lines.append(f"mu_torque = {result.mu_torque:.6g} +- {result.mu_torque_error:.1g}")
    resolved = f"{result.cells} cells"
    if result.angles > 1:
        resolved += f" x {result.angles} angles"
    if result.steps_per_period:
        resolved += f", {result.steps_per_period} steps a period"
    lines.append(f"model {result.model}" + (f" ({resolved})" if result.cells else ""))
    if not result.converged:
        lines.append(f"NOT CONVERGED: {result.reason}")
    return "\n".join(lines)


if __name__ == "__main__":
    raise SystemExit(main())
