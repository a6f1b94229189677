"""Compute a batch of requests: points of a sweep, single runs for a figure, or part of a study.

Output: the records of the batch in the order of the requests, as JSON lines.  All numbers in them
are dimensionless, except times (s) and memory (byte) of trials and scaling.  Each record is also
stored as soon as it is computed, in the folders of batches.FOLDERS.
"""

import json

from microslip.app.job_log import job_log
from microslip.config import load
from microslip.sweeps import batches, store

with job_log(snakemake.log[0]) as log:
    load.remember_files(snakemake.config)
    batch = batches.Batch(**json.loads(snakemake.params.batch))
    if batch.name != snakemake.wildcards.batch:
        raise batches.SourcesEdited("the solver")
    records, summary = batches.run_batch(batch.requests, store.Store(snakemake.params.store))
    store.write(snakemake.output[0], records, summary["final"])
    log.info(
        "%(points)d points, %(computed)d computed in %(solver_seconds).2f s of CPU time", summary
    )
