"""Answer a batch of requests: points of a sweep, single runs for a figure, or part of a study.

Output: JSON with `keys`, the names of the results in the order of the requests, and
`not_converged`, a count. The results themselves are files of their own under the store's folders
that sweep.FOLDERS names; all numbers in them are dimensionless, but for the times (s) and sizes of
memory (byte) of trials and scaling.
"""

import json

from microslip import named_files, sweep
from microslip.cache import Store, write_atomically
from microslip.jobs import job_log
from microslip.keys import canonical_json
from microslip.watch import counted

with job_log(snakemake.log[0]) as log:
    # Requests name files by what these hold.
    named_files.remember(given["pressure"] for given in snakemake.config["extended"].values())
    index, done = sweep.run_batch(
        json.loads(snakemake.params.requests),
        Store(snakemake.params.store),
        lambda requests: counted(requests, snakemake.params.counter),
    )
    write_atomically(snakemake.output[0], canonical_json(index).encode())
    log.info("%(points)d points, %(computed)d computed in %(solver_seconds).2f s of CPU time", done)
