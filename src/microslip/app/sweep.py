"""The command `microslip sweep`: run this package's workflow with Snakemake in the current folder.

For bad input, Snakemake prints a list of all its options or a traceback, and returns exit code 1.
Therefore, this module checks the arguments and the configuration first.  Bad input is reported in
one line, with exit code 2.
"""

from __future__ import annotations

import argparse
import atexit
import io
import os
import re
import shutil
import signal
import sys
import tempfile
from contextlib import redirect_stderr, redirect_stdout, suppress
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from microslip.app.parser import Option, Parser
from microslip.app.terminal import complain
from microslip.foundation import extras, files, source_digest
from microslip.foundation.errors import CacheError, InputError
from microslip.foundation.spec import near_miss

if TYPE_CHECKING:
    from microslip.config.settings import Configuration

SETS_CORES = re.compile(r"-[cje]|--(cores|jobs|executor|profile|workflow-profile)(=|$)")
"""Pattern of arguments that set the number of parallel jobs, directly or by a profile."""
PRODUCTS = (".nc", ".html", ".pdf", ".png")
"""File extensions of products.  Such files are not configurations."""
OPTIONS = {
    "configfile": Option("FILE", "the configuration (config/config.yaml); targets go before it"),
    "cores": Option("N", "number of jobs at the same time, at least 1 (all cores)"),
    "report": Option("FILE", "after a run: a page (.html or .zip) of figures and provenance"),
}
"""Options in the help text."""


def main(arguments: list[str]) -> int:
    """Run the Snakemake workflow that makes maps, datasets and figures.

    The workflow runs in the current folder and writes datasets to results/, and figures to
    results/figures/.  Existing results are not computed again.  CONFIGURATION is the name of a file
    in the folder config of the current folder or of the package; the default is config/config.yaml.
    A TARGET is a dataset or a figure of the configuration (for example bore), or a file (for
    example results/bore.nc).  Without a TARGET, all datasets and figures are made.  All other
    options are passed to Snakemake (see snakemake --help); default options are in profiles/default.
    The exit code is 2 for bad input, and otherwise the exit code of Snakemake. Examples: microslip
    sweep --cores 2; microslip sweep extended --dry-run; microslip sweep --configfile mine.yaml
    --config points_per_job=10.
    """
    if {"-h", "--help"} & set(arguments):
        usage = "microslip sweep [CONFIGURATION | TARGET ...] [--dry-run] [options of Snakemake]"
        parser = Parser(usage=usage, description=main.__doc__)
        for name, one in OPTIONS.items():
            parser.add(name, one)
        paths = {name: os.path.relpath(path) for name, path in configurations().items()}
        parser.print_help_with("configurations", paths)
        return 0
    with redirect_stdout(sys.__stdout__):  # also for the jobs of Snakemake
        return _run(arguments)


def _run(arguments: list[str]) -> int:
    from microslip.config.load import ConfigError

    try:
        if hint := extras.missing("snakemake"):
            raise ConfigError(hint)
        os.getcwd()
        file = configurations().get(next(iter(arguments), ""))
        if file is not None and "--configfile" not in arguments:
            arguments = [*arguments[1:], "--configfile", os.path.relpath(file)]
        words = ["--snakefile", str(source_digest.workflow_file("Snakefile")), *arguments]
        if "SNAKEMAKE_PROFILE" not in os.environ and not any(map(SETS_CORES.match, arguments)):
            words = ["--cores", "all", *words]
        is_silent = _check(words)
    except (InputError, ConfigError, CacheError, FileNotFoundError) as error:
        place = "the current folder: " if isinstance(error, FileNotFoundError) else ""
        complain(f"microslip sweep: {place}{getattr(error, 'strerror', None) or error}")
        return 2
    _spare_cache()
    from snakemake.cli import main as snakemake

    interrupts: list[int] = []

    def interrupt(number: int, frame: object) -> None:
        interrupts.append(number)
        raise KeyboardInterrupt

    if signal.getsignal(signal.SIGINT) != signal.SIG_IGN:
        signal.signal(signal.SIGINT, interrupt)
    try:
        snakemake(words)
    except (KeyboardInterrupt, SystemExit) as end:  # an interrupt of planning, or of the jobs
        if not interrupts:
            if is_silent and getattr(end, "code", None):
                complain("microslip sweep: not finished; run it without --quiet for the reason")
            raise
    if interrupts:
        complain("microslip sweep: interrupted")
    return 130 if interrupts else 0


def configurations() -> dict[str, Path]:
    """Return the paths of all configurations, keyed by name.  Configurations are in the folder
    config of the package, and in the folder config of the current folder."""
    folders = source_digest.workflow_file("config/config.yaml").parent, Path("config")
    return {file.stem: file for folder in folders for file in sorted(folder.glob("*.yaml"))}


def _spare_cache() -> None:
    """Use a temporary folder for Snakemake's internal files if the home folder is not writable.

    At each start, Snakemake creates a folder in the home folder.  If this fails, Snakemake ends
    with a traceback.
    """
    home = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    with suppress(OSError):
        os.makedirs(os.path.join(home, "snakemake"), exist_ok=True)
        if os.access(home, os.W_OK):
            return
    spare = tempfile.mkdtemp(prefix="microslip-")
    atexit.register(shutil.rmtree, spare, ignore_errors=True)
    os.environ["XDG_CACHE_HOME"] = spare
    complain(f"microslip sweep: {home} cannot be written to: Snakemake's own files are in {spare}")


def _check(arguments: list[str]) -> bool:
    """Raise InputError for invalid arguments, ConfigError for an invalid configuration, or
    CacheError for a folder that cannot be written to.  Returns True if Snakemake will not print
    errors."""
    options = _parsed(arguments)
    if options is None:
        return False
    if os.environ.get("NUMBA_DISABLE_JIT"):
        import_module("microslip.foundation.compiled")  # refuses it
    for name in ("cores", "jobs"):
        count = getattr(options, name)
        if isinstance(count, int) and count < 1:
            raise InputError(f"--{name}", count, "allowed is a whole number of at least 1, or all")
    for entry in options.config or ():
        if not re.match(r"[A-Za-z_][\w-]*\w=", entry):
            raise InputError("--config", entry, "allowed is KEY=VALUE")
    if sum(word.partition("=")[0] == "--configfile" for word in arguments) > 1:
        allowed = "Snakemake would ignore the first; allowed is --configfile A B"
        raise InputError("--configfile", "twice", allowed)
    configuration = _configuration(options)
    names = ["all", *configuration.datasets, *configuration.figures]
    for target in options.targets:
        if not ({".", "/"} & set(target) or target in names):
            hint = near_miss(target, [*names, *configurations()])
            allowed = f"{hint}allowed is one of {', '.join(names)}, or a file"
            raise InputError("TARGET", target, allowed)
    files.refuse_unwritable(Path(options.directory or ".", ".snakemake"))
    return "all" in map(str, options.quiet or ())


def _configuration(options: argparse.Namespace) -> Configuration:
    """Return the configuration.  Raises ConfigError if the Snakefile would refuse this
    configuration."""
    from snakemake.cli import parse_config
    from snakemake.utils import update_config

    from microslip.config import load

    for index, file in enumerate(map(str, options.configfile or ())):
        is_product = file.endswith(PRODUCTS)
        if is_product or not os.path.isfile(file):
            problem = "not a configuration" if is_product else "no such file"
            hint = "; targets go before --configfile" if index or is_product else ""
            raise InputError("--configfile", file, f"{problem}; allowed is a YAML file{hint}")
    folder, default = options.directory or ".", "config/config.yaml"
    mine, shipped = Path(folder, default), source_digest.workflow_file(default)
    given = options.configfile or [mine if os.path.lexists(mine) else shipped]
    paths, mapping = list(map(os.path.relpath, given)), dict[str, object]()
    for file in paths:
        update_config(mapping, load.read_yaml(file))
    update_config(mapping, parse_config(options.config))
    source = ", ".join([*paths, *(["--config"] if options.config else [])])
    folders = [os.path.dirname(os.path.abspath(file)) for file in paths]
    configuration = load.from_mapping(mapping, source=source, folders=folders)
    load.refuse_unsolvable(configuration, source=source)
    try:
        files.refuse_unusable([Path(folder, configuration.results)], [])
    except CacheError as error:
        raise load.ConfigError(f"{source}: results: {error}") from None
    return configuration


def _parsed(arguments: list[str]) -> argparse.Namespace | None:
    """Return the arguments as parsed by Snakemake, or None if Snakemake will print its own
    message."""
    from snakemake.cli import parse_args

    messages = io.StringIO()
    try:
        with redirect_stderr(messages):
            return parse_args(arguments)[1]
    except SystemExit as error:
        if error.code in (0, None):
            raise  # --version
        line = messages.getvalue().strip().rpartition("\n")[2]
        complain(f"microslip sweep: {line.partition('error: ')[2] or line}")
        raise SystemExit(2) from None
    except Exception:  # Snakemake raises it again
        return None
