"""The command `microslip gc`: list and remove result files that no configuration requests.

The workflow keeps all older results after an edit of the configuration or the solver.  Another
configuration may request them.  Only files that the workflow names or stamps are considered, since
all other files belong to the user.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from contextlib import suppress
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
PLACES = {".": (".", "summaries"), "figures": ("figures",), "pages": (".",)}
"""Folders with the files of products, keyed by the folder of the stamps."""


def requested(plan: Plan, folder: Path) -> set[str]:
    """Return the paths of all files that a plan makes, relative to the folder of results.

    The points of a certified map are read from its batch.  If the batch is missing or damaged, all
    points of the motion count as requested.
    """
    certified = plan.configuration.certified
    paths = {file for product in plan.products.values() for file in product.files}
    paths |= {stamps.stamp_of(product) for product in plan.products}
    paths |= {*plan.batch_files(*plan.groups, *certified)}
    planned = [batch for group in plan.groups for batch in plan.batches_in(group).values()]
    paths |= {_path_of(request) for batch in planned if batch for request in batch.requests}
    for name, map_ in certified.items():
        (file,) = plan.batch_files(name)
        try:
            paths |= {_path_of(record["request"]) for record in store.read(folder / file)}
        except CacheError:
            motion = solver_names(map_.sweep)[0].partition(":")[0]
            group = f"{batches.FOLDERS['point']}/{motion}"
            complain(f"{folder / file} is missing or damaged; all files in {group} are kept")
            paths |= {p.relative_to(folder).as_posix() for p in (folder / group).rglob("*.json")}
    return paths


def _path_of(request: dict) -> str:
    return store.Store(".").path(batches.group(request), batches.key_of(request)).as_posix()


def _named(folder: Path) -> Iterator[tuple[str, Path]]:
    """Yield the kind and path of each file in a folder, if the file has the name of a result."""
    for group in sorted(set(batches.FOLDERS.values())):
        for path in sorted((folder / group).rglob("*.json")):
            if RECORD.fullmatch(path.name):
                yield KINDS[0], path
    for path in sorted((folder / "batches").glob("*/*")):
        if BATCH.fullmatch(path.name):
            yield KINDS[1], path
    for stamp in sorted((folder / stamps.FOLDER).rglob("*.json")):
        yield KINDS[2], stamp
        inner = stamp.parent.relative_to(folder / stamps.FOLDER).as_posix()
        for place in PLACES.get(inner, ()):
            for name in stamps.read(stamp).get("sums", ()):
                if Path(name).name == name:
                    yield KINDS[2], folder / place / name


def find_leftovers(folder: Path, plans: Iterable[Plan]) -> dict[str, list[Path]]:
    """Return the files that no plan requests, by kind.

    Links belong to the user and are not listed, nor are files that are reached through links.  A
    folder is never listed.
    """
    needed = {file for plan in plans for file in requested(plan, folder)}
    paths: dict[str, list[Path]] = {kind: [] for kind in KINDS}
    for kind, path in _named(folder):
        inner = path.relative_to(folder)
        is_own = path.is_file() and path.resolve() == folder.resolve() / inner
        if is_own and inner.as_posix() not in needed:
            paths[kind].append(path)
    return paths


def remove(paths: Iterable[Path], folder: Path) -> None:
    """Remove files from a folder of results, and also subfolders that become empty."""
    for path in paths:
        try:
            path.unlink(missing_ok=True)
        except OSError as error:
            raise CacheError(files.advice("remove", path, error)) from error
        for inner in list(path.relative_to(folder).parents)[:-1]:
            with suppress(OSError):  # it is not empty
                (folder / inner).rmdir()


def main(arguments: list[str]) -> int:
    """Entry point of `microslip gc`.  Returns the exit code, which is 0, or 2 for bad input."""
    options = _parser().parse_args(arguments)
    try:
        configurations = [_loaded(path) for path in options.configfile or [DEFAULT]]
        folder = _folder(configurations)
        files.refuse_unusable([folder], [])
        if not os.path.isdir(folder):
            raise ConfigError(f"results: {folder} is not there; allowed: a folder of results")
        remaining = find_leftovers(folder, map(Plan, configurations))
        for kind, paths in remaining.items():
            size = sum(path.stat().st_size for path in paths) / 1e6
            print(f"{folder}: {len(paths)} {kind} that no configuration requests, {size:.1f} MB")
            for path in paths if options.list else ():
                print(f"  {path}")
        if any(remaining.values()):
            print("removed" if options.delete else "nothing is removed without --delete")
        if options.delete:
            remove((path for paths in remaining.values() for path in paths), folder)
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
    """Return the folder of results that all configurations share.  Raises ConfigError if their
    folders differ."""
    folders = {os.path.realpath(each.results): Path(each.results) for each in configurations}
    if len(folders) > 1:
        names = ", ".join(sorted(map(str, folders.values())))
        raise ConfigError(f"results: {names} are several folders; allowed: the same folder in all")
    return next(iter(folders.values()))


def _parser() -> OneLineParser:
    parser = OneLineParser(
        prog="microslip gc",
        description="List points, batches, datasets and figures in a folder of results that none "
        "of the configurations requests, with this version of the solver. This includes "
        "points that the command line or solve_stored has stored there.",
    )
    parser.add_argument(
        "--configfile",
        nargs="+",
        action="extend",  # a repeated option adds files, so that no results are lost
        metavar="FILE",
        help="configurations whose results are kept (config/config.yaml)",
    )
    parser.add_argument("--list", action="store_true", help="list every file")
    parser.add_argument("--delete", action="store_true", help="remove the listed files")
    return parser
