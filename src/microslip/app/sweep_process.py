"""Snakemake as `microslip sweep` starts it: what can be seen to be wrong is one line, before it.

Snakemake reads the files given with --configfile before the workflow has a say, prints all of its
options where one is unknown, and ends with the exit code 1 whatever is wrong.  So its own parser,
which knows profiles and abbreviations, is asked first, and the configuration is read here, too.
"""

from __future__ import annotations

import argparse
import atexit
import io
import os
import re
import shutil
import sys
import tempfile
from contextlib import redirect_stderr
from pathlib import Path

from microslip.app.sweep_command import RULES, TARGETS, snakefile
from microslip.app.terminal import complain
from microslip.config import load, schema
from microslip.foundation.errors import CacheError, InputError
from microslip.report.figures import drawing
from microslip.sweeps import sealed_files

KEY_AND_VALUE = re.compile(r"[A-Za-z_][\w-]*\w=")


def main(arguments: list[str]) -> int:
    """Run Snakemake in this process; returns its exit code, 2 for arguments that are bad."""
    try:
        try:
            _check(arguments)
        except InputError as error:
            complain(f"microslip sweep: {error}")
            return 2
        except load.ConfigError as error:
            complain(f"microslip sweep: {error}")
            return 2
        _spare_cache()
        from snakemake.cli import main as snakemake

        snakemake(arguments)  # ends by SystemExit
    except KeyboardInterrupt:  # what Snakemake does not catch while it plans
        complain("microslip sweep: interrupted")
        return 130
    return 0


def _spare_cache() -> None:
    """Have Snakemake keep its own files in a temporary folder where the home takes none.

    It makes a folder there whenever it starts, and ends with a traceback where it cannot.
    """
    home = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    try:
        os.makedirs(os.path.join(home, "snakemake"), exist_ok=True)
        if os.access(home, os.W_OK):
            return
    except OSError:
        pass
    spare = tempfile.mkdtemp(prefix="microslip-")
    atexit.register(shutil.rmtree, spare, ignore_errors=True)
    os.environ["XDG_CACHE_HOME"] = spare
    complain(f"microslip sweep: {home} cannot be written to: Snakemake's own files are in {spare}")


def _check(arguments: list[str]) -> None:
    """Raise InputError or ConfigError for what Snakemake would be slow, or long, to refuse."""
    options = _parsed(arguments)
    if options is None:
        return
    if options.directory is None and not os.access(".", os.W_OK):
        raise InputError("--directory", os.getcwd(), "allowed is a folder that can be written to")
    for name in ("cores", "jobs"):
        count = getattr(options, name)
        if isinstance(count, int) and count < 1:
            raise InputError(f"--{name}", count, "allowed is a whole number of at least 1, or all")
    for target in options.targets:
        if not _may_be_made(target):
            hint = schema.near_miss(target, [*TARGETS, *drawing.SHORT_NAMES, *drawing.FIGURES])
            allowed = f"allowed is one of {', '.join(TARGETS)}, a figure such as fig2, or a file"
            raise InputError("TARGET", target, hint + allowed)
    for entry in options.config or ():
        if not KEY_AND_VALUE.match(entry):
            raise InputError("--config", entry, "allowed is KEY=VALUE")
    if sum(word.partition("=")[0] == "--configfile" for word in arguments) > 1:
        raise InputError(
            "--configfile", "twice", "Snakemake would forget the first; allowed is --configfile A B"
        )
    _check_configuration(options)


def _check_configuration(options: argparse.Namespace) -> None:
    """Raise ConfigError for the configuration that the Snakefile would read and refuse."""
    from snakemake.cli import parse_config
    from snakemake.utils import update_config

    files = [os.path.relpath(file) for file in options.configfile or ()]
    if not files:
        places = (Path(options.directory or "."), snakefile().parent)
        defaults = [os.path.relpath(place / "config" / "config.yaml") for place in places]
        files = [next(filter(os.path.lexists, defaults), defaults[-1])]
    mapping: dict = {}
    for file in files:
        update_config(mapping, load.read_yaml(file))
    update_config(mapping, parse_config(options.config))
    source = ", ".join([*files, *(["--config"] if options.config else [])])
    folders = [os.path.dirname(os.path.abspath(file)) for file in files]
    configuration = load.from_mapping(mapping, source=source, folders=folders)
    results = Path(options.directory or ".", configuration.results)
    try:
        sealed_files.refuse_unusable([results], [])
    except CacheError as error:
        raise load.ConfigError(f"{source}: results: {error}") from None


def _may_be_made(target: str) -> bool:
    """Whether a target is a file, a target of the workflow or the name of a figure.

    The configuration decides which figures of groups and of certified maps there are.
    """
    figures = (*drawing.FIGURES, *drawing.SHORT_NAMES)
    of_configuration = target.startswith((drawing.figure_of(""), drawing.CERTIFIED))
    is_file = bool({".", "/"} & set(target))
    return is_file or of_configuration or target in (*TARGETS, *RULES, *figures)


def _parsed(arguments: list[str]) -> argparse.Namespace | None:
    """The arguments parsed by Snakemake; None where Snakemake prints a message by itself."""
    from snakemake.cli import parse_args

    said = io.StringIO()
    try:
        with redirect_stderr(said):
            _, options = parse_args(arguments)
    except SystemExit as error:
        if error.code in (0, None):
            raise  # --version
        line = said.getvalue().strip().rpartition("\n")[2]
        complain(f"microslip sweep: {line.partition('error: ')[2] or line}")
        raise SystemExit(2) from None
    except Exception:  # it will say so again
        return None
    return options


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
