"""Compute a batch: points of a sweep, single runs for a figure, part of a study, or all points of a
certified map.

Output: the records of the batch in the order of the requests, as JSON lines.  All numbers in them
are dimensionless, except times (s) of trials.  As soon as a record is
computed, it is also stored in a folder of batches.FOLDERS.
"""

import json

from microslip.app.job_log import job_log
from microslip.config import load
from microslip.sweeps import batches, store

group, name = snakemake.wildcards.group, snakemake.wildcards.batch
folder = store.Store(snakemake.params.store)


def solved_batch(batch: batches.Batch) -> tuple[list[dict], dict]:
    """Return the records of a batch of requests, and their statistics."""
    load.remember_files(snakemake.config)  # requests name files by their content
    if batch.name != name:
        raise batches.SourcesEdited("the solver")
    return batches.run_batch(batch.requests, folder)


def solved_map() -> tuple[list[dict], dict]:
    """Return the records of the points of a certified map, and their statistics."""
    from microslip.app.plan import Plan
    from microslip.sweeps import map_refinement

    plan = Plan(load.from_mapping(snakemake.config, ask_solver=False))
    if name not in plan.batches_in(group):
        raise batches.SourcesEdited("the solver")
    map_ = plan.configuration.certified[group]
    return map_refinement.solve_points(map_, folder, snakemake.threads)


if __name__ == "__main__":  # not in the processes that solve points of a map
    with job_log(snakemake.log[0]) as log:
        batch = json.loads(snakemake.params.batch)
        records, summary = solved_batch(batches.Batch(**batch)) if batch else solved_map()
        store.write(snakemake.output[0], records, summary["final"])
        line = "%(points)d points, %(computed)d computed in %(solver_seconds).2f s of CPU time"
        log.info(line, summary)
