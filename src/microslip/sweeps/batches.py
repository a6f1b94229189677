"""From a configuration to results: requests, batches of them, and their answers from the store.

A request is a plain dict that says what to compute, with numbers as canonical strings; together
with the digest of the solver it names a result. A job gets a batch of requests and computes those
that the store does not hold, so how points are cut into batches never decides what is computed.
"""

import functools
import importlib.metadata
import logging
import math
import platform
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import overload

from microslip.config.axes import DRIVES
from microslip.config.extended import solver_names
from microslip.config.records import HISTORIES_OF_SWEEP, Configuration, Sweep
from microslip.foundation import source_digest
from microslip.foundation.canonical import number
from microslip.foundation.errors import SolverError
from microslip.motions.body_contacts import contacts_of, contacts_text
from microslip.sweeps import batch_files, evaluate
from microslip.sweeps.cache import Store
from microslip.sweeps.keys import batch_name, result_key
from microslip.sweeps.sealed_files import CacheError

log = logging.getLogger(__name__)

# The initial states of Figure 5.
STARTS = ("stress-free", "full-rotation", "full-slip")

# Folders of the store by kind of request. Those in trials and scaling hold times that were
# measured: computed again they differ in these, and in nothing else.
FOLDERS = {
    "point": "points",
    "history": "histories",
    "field": "histories",
    "period": "periods",
    "trial": "trials",
    "choice": "trials",
    "probe": "probes",
    "scaling": "scaling",
    "run": "runs",
    "patches": "patches",
    "propulsion": "propulsion_lines",
}


class PointRequests(Sequence):
    """Requests for all points of a records.Sweep, each made when it is asked for.

    The order is that of the dataset: what pulls, Poisson's ratio, amplitude, velocity, the last one
    fastest; a force stands in the place of the velocity.
    """

    def __init__(self, sweep: Sweep):
        motion, pressure = solver_names(sweep)
        self._common: dict = {
            "kind": "point",
            "motion": motion,
            "model": sweep.model,
            "tolerance": None if sweep.tolerance is None else number(sweep.tolerance),
            "cells": sweep.cells,
            "steps": sweep.steps,
        }
        if pressure != "hertz":  # which goes without saying, as it did before there were others
            self._common["pressure"] = pressure
        if sweep.contacts is not None:
            self._common["contacts"] = contacts_text(contacts_of(sweep.contacts))
        amplitudes = [None] if sweep.amplitude is None else [number(a) for a in sweep.amplitude]
        pulls = {name: [number(v) for v in values] for name, values, _ in sweep.drives}
        last: dict[str, list] = {"velocity": [number(velocity) for velocity in sweep.velocity]}
        if not sweep.velocity:
            last = {"force": pulls.pop("force")}
            self._common["velocity"] = None
        rest: dict[str, list] = {
            "poisson": [number(nu) for nu in sweep.poisson],
            "amplitude": amplitudes,
        }
        self._axes = pulls | rest | last

    def __len__(self) -> int:
        return math.prod(map(len, self._axes.values()))

    @overload
    def __getitem__(self, index: int) -> dict: ...

    @overload
    def __getitem__(self, index: slice) -> list[dict]: ...

    def __getitem__(self, index: int | slice) -> dict | list[dict]:
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        rest, at = range(len(self))[index], {}
        for name, values in reversed(self._axes.items()):
            rest, place = divmod(rest, len(values))
            at[name] = values[place]
        return self._common | {name: at[name] for name in self._axes}


def history_requests(configuration: Configuration, name: str) -> list[dict]:
    """List the requests for the single runs that go into the dataset of the sweep `name`; none for
    one of `extended`."""
    given = configuration.histories
    requests = {
        "transverse": lambda settings: [
            _single("history", "transverse", settings, start="stress-free")
        ],
        "field": lambda settings: [_single("field", "continuous-bore", settings)],
        "transients": lambda settings: [
            _single("history", "continuous-bore", settings, start=start) for start in STARTS
        ],
    }
    return [r for run in HISTORIES_OF_SWEEP.get(name, ()) for r in requests[run](given[run])]


def _single(kind: str, motion: str, settings: dict, **more: object) -> dict:
    counts = ("cells", "steps", "periods")
    numbers = {k: number(v) for k, v in settings.items() if k not in counts}
    return {"kind": kind, "motion": motion} | settings | numbers | more


def key_of(request: dict) -> str:
    """Name of the result that answers a request with the code that is running."""
    return result_key(request, source_digest.of_request(request))


def batches(requests: Sequence[dict], size: int) -> dict[str, Sequence[dict]]:
    """Cut requests into lists of `size` and return them by name; the name tells the content."""
    cuts = (requests[i : i + size] for i in range(0, len(requests), size))
    return {name_of_batch(cut): cut for cut in cuts}


def name_of_batch(requests: Sequence[dict]) -> str:
    """Name of the batch that answers these requests with the code that is running."""
    return batch_name([key_of(request) for request in requests])


def group(request: dict) -> str:
    """Name the subfolder of the store that a request's result goes to."""
    motion = request["motion"] if "motion" in request else request["model"]
    return "/".join([FOLDERS[request["kind"]], motion.partition(":")[0]])  # numbers apart


def answer(request: dict, store: Store, time_limit: float | None = None) -> tuple[dict, float]:
    """Return the record that answers `request` and the CPU seconds that the solver took for it.

    It comes from the store if that has it (0 seconds), else it is computed and stored. The record
    is a dict: key, request, result, versions. What need not come out so again is not stored, see
    answers.is_final: whoever asks next has it computed again. time_limit: of a point, as for
    microslip.solve. Raises CacheError if it cannot be stored.
    """
    key = key_of(request)
    record = store.read(group(request), key)
    if record is not None:
        return record, 0.0
    store.try_writing()
    started = time.process_time()
    result = evaluate.computed(request, time_limit)
    seconds = time.process_time() - started
    # How long it took is left out: equal requests have equal records, bit for bit, but for those
    # that ask for a time.
    record = {"key": key, "request": request, "result": result, "versions": versions()}
    edited = source_digest.LOADED.edited(source_digest.files_of_request(request))
    if edited:
        raise SourcesEdited(edited[0], record)
    if evaluate.is_final(result):
        store.write(group(request), key, record)
    return record, seconds


class SourcesEdited(CacheError):
    """The code on disk is no longer the one that is running.

    A result may then be of either code, so it is not kept under the name of one.

    Attributes
    ----------
    record : dict
        What was computed, by code that was loaded before the edit or after it.
    """

    def __init__(self, file: str | Path, record: dict | None = None):
        super().__init__(
            f"{file} was edited while its code was running, so what it computes is not kept; "
            "run again: finished points are kept"
        )
        self.record = record


def run_batch(
    requests: Sequence[dict], store: Store, progress: Callable = iter, name: str | None = None
) -> tuple[list[dict], dict]:
    """Answer every request; return the records (list) and statistics of the batch (dict).

    progress: wraps the list of requests and yields them one by one, such as tqdm. The records
    depend on the requests and the solver alone; times and counts are in the statistics. name: of
    the batch where it was planned; raises SourcesEdited if it has another one by now. Raises
    SolverError where the solver fails at every point of the batch.
    """
    if name not in (None, name_of_batch(requests)):
        raise SourcesEdited("the solver")
    records, computed, seconds = [], 0, 0.0
    for request in progress(requests):
        record, took = answer(request, store)
        records.append(record)
        computed += took > 0
        seconds += took
        if not record["result"].get("converged", True):
            log.info("not converged: %s: %s", label(request), record["result"]["reason"])
    if records and all(record["result"].get("crashed") for record in records):
        first = f"{label(requests[0])}: {records[0]['result']['reason']}"
        raise SolverError(f"every point of this batch failed ({len(records)}), first {first}")
    final = all(evaluate.is_final(record["result"]) for record in records)
    statistics = {"points": len(records), "computed": computed, "solver_seconds": seconds}
    statistics["final"] = final
    return records, statistics


def records_in(paths: Iterable[Path]) -> Iterator[dict]:
    """Records in the files of batches, one by one in their order.

    Raises CacheError, one line that says what to do, for a file that is damaged.
    """
    for path in paths:
        records = batch_files.read_batch(path)
        if records is None:
            raise CacheError(f"{path} is damaged; run again: it is made again from finished points")
        yield from records


def records_for(requests: Iterable[dict], paths: Iterable[Path]) -> Iterator[dict]:
    """Records in the files of batches, one by one, each the answer to the next of the requests.

    They may lie in any order, and others between them. Raises CacheError as `records_in` does, and
    where a request is not answered.
    """
    records = batch_files.Records(paths)
    for request in requests:
        record = records.get(key_of(request))
        if record is None:
            raise CacheError(
                f"no batch answers {label(request)}; remove the folder batches and run again: "
                "finished points are kept"
            )
        yield record


def lookup(records: Iterable[dict]) -> Callable[[dict], dict]:
    """A function that finds the record that answers a request among these."""
    found = {record["key"]: record for record in records}
    return lambda request: found[key_of(request)]


def label(request: dict) -> str:
    """Describe a request in a few words, for messages."""
    names = ["pressure", "poisson", "amplitude", "velocity", *DRIVES, "start"]
    if request["kind"] != "point":
        names += ["model", "method", "cells", "angles", "steps"]
    given = ", ".join(f"{name} {request[name]}" for name in names if request.get(name) is not None)
    return f"{request.get('motion', request['kind'])} at {given}"


@functools.cache
def versions() -> dict[str, str]:
    """Versions of Python and of the numerical libraries that compute a result, as a dict."""
    found = {name: importlib.metadata.version(name) for name in ("numpy", "scipy", "numba")}
    return {"python": platform.python_version(), **found}
