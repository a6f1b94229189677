"""Answer a batch of requests: points of a sweep, single runs for a figure, or part of a study.

Output: the records of the batch, in the order of the requests, one a line as JSON with a checksum.
All numbers in them are dimensionless, but for the times (s) and sizes of memory (byte) of trials
and scaling. Each is kept in the store as well, as soon as it is computed, under the folders that
batches.FOLDERS names.
"""

import json

from microslip.app.job_log import job_log
from microslip.app.progress import counted
from microslip.foundation import named_files
from microslip.sweeps import batch_files, batches, cache

with job_log(snakemake.log[0]) as log:
    # Requests name files by what these hold.
    for others in ("extended", "drives"):
        named_files.remember(given["pressure"] for given in snakemake.config[others].values())
    records, done = batches.run_batch(
        json.loads(snakemake.params.requests),
        cache.Store(snakemake.params.store),
        lambda requests: counted(requests, snakemake.params.counter),
        name=snakemake.wildcards.batch,
    )
    batch_files.write_batch(snakemake.output[0], records, done["final"])
    log.info("%(points)d points, %(computed)d computed in %(solver_seconds).2f s of CPU time", done)
