"""Time and memory for 10^8 queries of a certified map, in chunks.

    python benchmarks/many_questions.py MAP.nc [--questions N] [--chunk N] [--threads N]
                                        [--markdown FILE]

Velocities (or forces) and amplitudes are random, and are never in memory as a whole. For each
chunk, dask draws them, queries the map, and keeps only the sum and the largest error.
"""

from __future__ import annotations

import one_thread  # noqa: F401

# isort: split

import resource
import time
from pathlib import Path

import dask
import dask.array
import tables
import xarray as xr

import microslip
from microslip.datasets import certified_map


def questions(dataset, count, chunk):
    """Random arguments of `at` by name, in chunks."""
    across = "force" if certified_map.is_of_drift(dataset) else "velocity"
    draw = dask.array.random.default_rng(3)
    return {
        name: xr.DataArray(
            draw.uniform(
                float(dataset[name].min()), float(dataset[name].max()), count, chunks=chunk
            ),
            dims="question",
        )
        for name in (across, "amplitude")
    }


def memory():
    """Peak memory of this process so far, in bytes."""
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def main():
    parser = tables.parser_of(__doc__)
    parser.add_argument("map", type=Path)
    parser.add_argument("--questions", type=int, default=10**8)
    parser.add_argument("--chunk", type=int, default=10**5)
    parser.add_argument("--threads", type=int, default=1)
    options = parser.parse_args()
    dataset = microslip.open_map(options.map).load()
    accessor, value = dataset.microslip, "mu_macro"
    few = accessor.at(**questions(dataset, options.chunk, options.chunk))
    dask.compute(few[value].mean())
    before, begun = memory(), time.process_time()
    answer = accessor.at(**questions(dataset, options.questions, options.chunk))
    with dask.config.set(scheduler="threads", num_workers=options.threads):
        mean, error = dask.compute(answer[value].mean(), answer[f"{value}_error"].max())
    seconds = time.process_time() - begun
    rows = [
        ("map", f"{options.map.stem}, {dataset.points} points, {dataset.sizes['cell']} cells"),
        ("queries", f"{options.questions:.0e}, {options.chunk:.0e} in a chunk"),
        ("threads", options.threads),
        ("CPU seconds", f"{seconds:.0f}"),
        ("queries per CPU second", f"{options.questions / seconds:.1e}"),
        ("largest memory after one chunk, MB", f"{before / 1e6:.0f}"),
        ("largest memory after all, MB", f"{memory() / 1e6:.0f}"),
        ("mean of the answers, largest error", f"{float(mean):.4f}, {float(error):.1e}"),
    ]
    head = "# Many queries of a certified map\n\nMade by `benchmarks/many_questions.py`."
    tables.publish(f"{head}\n\n{tables.measured(rows)}", options)


if __name__ == "__main__":
    main()
