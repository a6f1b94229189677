"""`microslip gc`: what is in a folder of results that no configuration asks for any more.

After an edit of the solver, an axis or a tolerance, older points, batches, datasets and figures
stay where they are: another configuration may ask for them.  This lists them, and removes them if
told to.  Only files that the workflow names or stamps are looked at; all else in a folder is
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
from microslip.config.records import ConfigError, Configuration
from microslip.foundation import files
from microslip.foundation.errors import CacheError
from microslip.sweeps import batches, stamps, store

RECORD = re.compile(r"[0-9a-f]{64}\.json")
BATCH = re.compile(r"[0-9a-f]{20}\.jsonl")
DEFAULT = "config/config.yaml"
KINDS = ("points and single runs", "batches", "datasets, pages and figures")


def asked_for(plan: Plan, folder: Path) -> set[str]:
    """Paths, inside the folder of results, of all that a plan would make.

    The points of a certified map are those in its batch.  Where that is not there or damaged, all
    points of the motion count as requested.
    """
    certified = plan.configuration.certified
    found = {file for product in plan.products.values() for file in product.files}
    found |= {stamps.stamp_of(product) for product in plan.products}
    found |= {*plan.batch_files(*plan.groups, *certified)}
    requests = (
        r for group in plan.groups for b in plan.batches_in(group).values() for r in b.requests
    )
    found |= {_path_of(request) for request in requests}
    for name, map_ in certified.items():
        (file,) = plan.batch_files(name)
        try:
            found |= {_path_of(record["request"]) for record in store.read(folder / file)}
        except CacheError:
            motion = solver_names(map_.sweep)[0].partition(":")[0]
            group = f"{batches.FOLDERS['point']}/{motion}"
            complain(f"{folder / file} is missing or damaged; all files in {group} are kept")
            found |= {p.relative_to(folder).as_posix() for p in (folder / group).rglob("*.json")}
    return found


def _path_of(request: dict) -> str:
    return store.Store(".").path(batches.group(request), batches.key_of(request)).as_posix()


def present(folder: Path) -> Iterator[tuple[str, Path]]:
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
    for stamp in sorted((folder / stamps.FOLDER).rglob("*.json")):
        yield KINDS[2], stamp
        places = {"": (".", "summaries"), "figures": ("figures",), "pages": (".",)}
        inner = stamp.parent.relative_to(folder / stamps.FOLDER).as_posix().strip(".")
        for place in places.get(inner, ()):
            for name in stamps.read(stamp).get("sums", ()):
                if Path(name).name == name and (folder / place / name).exists():
                    yield KINDS[2], folder / place / name


def left_over(folder: Path, plans: Iterable[Plan]) -> dict[str, list[Path]]:
    """Files in a folder of results that none of the plans asks for, by their kind."""
    wanted = {file for plan in plans for file in asked_for(plan, folder)}
    found: dict[str, list[Path]] = {kind: [] for kind in KINDS}
    for kind, path in present(folder):
        if path.relative_to(folder).as_posix() not in wanted:
            found[kind].append(path)
    return found


def remove(paths: Iterable[Path], folder: Path) -> None:
    """Remove files of a folder of results, and folders inside it that are empty then."""
    for path in paths:
        try:
            path.unlink(missing_ok=True)
        except OSError as error:
            raise CacheError(files.advice("remove", path, error)) from error
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
        files.refuse_unusable([folder], [])
        if not os.path.isdir(folder):
            raise ConfigError(f"results: {folder} is not there; allowed: a folder of results")
        found = left_over(folder, map(Plan, configurations))
        _say(found, folder, options.delete, options.list)
        if options.delete:
            remove((path for paths in found.values() for path in paths), folder)
    except (ConfigError, CacheError) as error:
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
