"""`microslip gc`: what is in a folder of results that no configuration asks for any more.

After an edit of the solver, an axis or a tolerance, older points, batches, datasets and figures
stay where they are: another configuration may ask for them. This lists them, and removes them if
told to. Only files that the workflow names and seals are looked at; all else in a folder is
somebody's own.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from microslip.app.option_parser import OneLineParser
from microslip.app.plan import Plan
from microslip.app.terminal import complain
from microslip.config import load
from microslip.config.extended import solver_names
from microslip.config.records import CertifiedMap, ConfigError, Configuration
from microslip.sweeps import batch_plans, batches, cache, map_rounds, sealed_files

RECORD = re.compile(r"[0-9a-f]{64}\.json")
BATCH = re.compile(r"[0-9a-f]{16}\.(json|plan)")
ROUND = re.compile(r"[0-9]+(-[0-9]+)?\.json")
MADE = (".nc", ".html", ".png", ".pdf")
FOLDERS_MADE = (".", "summaries", "figures")
DEFAULT = "config/config.yaml"
KINDS = ("points and single runs", "batches", "datasets, pages and figures")


def asked_for(plans: Iterable[Plan], folder: Path = Path()) -> set[str]:
    """Paths, inside the folder of results, of all that some of the plans would make.

    Which points a certified map has is known from the rounds in that folder.  Where one of them is
    damaged, all points of the motion count as requested.
    """
    found = set()
    for plan in plans:
        found |= {*plan.made_files(), *plan.batch_files(*plan.groups), *plan.plan_files()}
        for group in plan.groups:
            found |= {_path_of(request) for request in plan.requests_in(group)}
        for name in plan.configuration.certified:
            rounds = sorted((folder / plan.rounds_folder(name)).glob("*.json"))
            found |= {path.relative_to(folder).as_posix() for path in rounds}
            for path in rounds:
                if path.stem.isdecimal():
                    found |= _points_of(path, plan.configuration.certified[name], folder)
    return found


def _points_of(path: Path, map_: CertifiedMap, folder: Path) -> set[str]:
    """Paths of the points of a round; of all points of the motion if its file is damaged."""
    try:
        round_ = map_rounds.read_round(path)
    except sealed_files.CacheError:
        group = f"{batches.FOLDERS['point']}/{solver_names(map_.sweep)[0].partition(':')[0]}"
        complain(f"{path} is damaged; the next run makes it again; all files in {group} are kept")
        return {file.relative_to(folder).as_posix() for file in (folder / group).rglob("*.json")}
    return {_path_of(request) for request in round_["requests"]}


def _path_of(request: dict) -> str:
    key = batches.key_of(request)
    return cache.Store(".").path(batches.group(request), key).as_posix()


def there(folder: Path) -> Iterator[tuple[str, Path]]:
    """(kind of KINDS, path) of every file in a folder of results that a run has made.

    A folder under the name of a file belongs to the user, and so do links and all that lies behind
    one: it may be outside the folder of results.
    """
    for kind, path in _named(folder):
        if path.is_file() and not any(part.is_symlink() for part in (path, *_above(path, folder))):
            yield kind, path


def _above(path: Path, folder: Path) -> Iterator[Path]:
    """Folders that a path lies in, below a folder of results, the innermost first."""
    for parent in path.parents:
        if parent == folder:
            return
        yield parent


def _named(folder: Path) -> Iterator[tuple[str, Path]]:
    for group in sorted(set(batches.FOLDERS.values())):
        for path in sorted((folder / group).rglob("*.json")):
            if RECORD.fullmatch(path.name):
                yield KINDS[0], path
    for path in sorted((folder / "batches").glob("*/*")):
        if BATCH.fullmatch(path.name):
            yield KINDS[1], path
    for path in sorted((folder / "rounds").glob("*/*/*")):
        if ROUND.fullmatch(path.name):
            yield KINDS[1], path
    for place in FOLDERS_MADE:
        for path in sorted((folder / place).glob("*")):
            if path.suffix in MADE and sealed_files.seal_of(path).exists():
                yield KINDS[2], path


def left_over(folder: Path, plans: Iterable[Plan]) -> dict[str, list[Path]]:
    """Files in a folder of results that none of the plans asks for, by their kind."""
    wanted = asked_for(plans, folder)
    found: dict[str, list[Path]] = {kind: [] for kind in KINDS}
    for kind, path in there(folder):
        if path.relative_to(folder).as_posix() not in wanted:
            found[kind].append(path)
    return found


def remove(paths: Iterable[Path], folder: Path) -> None:
    """Remove files of a folder of results with their seals, and folders inside it that are empty
    then."""
    for path in paths:
        for file in (path, sealed_files.seal_of(path)):
            try:
                file.unlink(missing_ok=True)
            except OSError as error:
                raise sealed_files.CacheError(sealed_files.advice("remove", file, error)) from error
        for inner in _above(path, folder):
            try:
                inner.rmdir()
            except OSError:  # it is not empty
                break


def main(arguments: list[str]) -> int:
    """Entry point of `microslip gc`; returns the exit code: 0, or 2 for bad input."""
    options = _parser().parse_args(arguments)
    try:
        configurations = [_loaded(path) for path in options.configfile or [DEFAULT]]
        folder = _folder(configurations)
        sealed_files.refuse_unusable([folder], [])
        if not os.path.isdir(folder):
            raise ConfigError(f"results: {folder} is not there; allowed: a folder of results")
        earlier = batch_plans.Folder(folder)
        found = left_over(
            folder, [Plan(configuration, earlier) for configuration in configurations]
        )
        _say(found, folder, options.delete, options.list)
        if options.delete:
            remove((path for paths in found.values() for path in paths), folder)
    except (ConfigError, sealed_files.CacheError) as error:
        complain(f"microslip gc: {error}")
        return 2
    return 0


def _loaded(path: str) -> Configuration:
    try:
        return load.load(path)
    except ConfigError as error:
        raise ConfigError(f"--configfile: {error}") from None


def _folder(configurations: list[Configuration]) -> Path:
    """The one folder of results that they all have, however its path is written."""
    folders = {
        os.path.realpath(configuration.results): Path(configuration.results)
        for configuration in configurations
    }
    if len(folders) > 1:
        names = ", ".join(sorted(map(str, folders.values())))
        raise ConfigError(f"results: {names} are several folders; allowed: configurations of one")
    return next(iter(folders.values()))


def _say(found: dict[str, list[Path]], folder: Path, deletes: bool, lists: bool) -> None:
    for kind, paths in found.items():
        size = sum(path.stat().st_size for path in paths) / 1e6
        print(f"{folder}: {len(paths)} {kind} that nothing asks for, {size:.1f} MB")
        for path in paths if lists else ():
            print(f"  {path}")
    if any(found.values()):
        print("removed" if deletes else "nothing is removed without --delete")


def _parser() -> OneLineParser:
    parser = OneLineParser(
        prog="microslip gc",
        description="List points, batches, datasets and figures in a folder of results that none "
        "of the configurations asks for, with this version of the solver. Points that only the "
        "command line or solve_stored has kept there are among them.",
        allow_abbrev=False,
    )
    parser.add_argument(
        "--configfile",
        nargs="+",
        action="extend",  # of an option given twice none may be forgotten: its results would go
        metavar="FILE",
        help="configurations whose results are to stay (config/config.yaml)",
    )
    parser.add_argument("--list", action="store_true", help="list every file")
    parser.add_argument("--delete", action="store_true", help="remove them")
    return parser
