"""Solve all points of a certified map by several processes.

Output: the records of all points, as JSON lines.  All numbers in them are dimensionless.  Each
record is also stored as soon as it is computed.
"""

from tqdm import tqdm

from microslip.app.job_log import job_log
from microslip.app.plan import Plan
from microslip.config import load
from microslip.sweeps import batches, map_refinement, store

name = snakemake.wildcards.certified

if __name__ == "__main__":  # not in the worker processes
    with job_log(snakemake.log[0]) as log:
        configuration = load.from_mapping(snakemake.config, ask_solver=False)
        if snakemake.wildcards.batch != Plan(configuration).map_batch(name):
            raise batches.SourcesEdited("the solver")
        records, seconds = map_refinement.solve_points(
            configuration.certified[name],
            store.Store(snakemake.params.store),
            snakemake.threads,
            lambda items, count: tqdm(items, name, count, unit="point", mininterval=1.0),
        )
        summary = batches.statistics(records, seconds)
        store.write(snakemake.output[0], records, summary["final"])
        log.info(
            "%(points)d points, %(computed)d computed in %(solver_seconds).2f s of CPU time",
            summary,
        )
