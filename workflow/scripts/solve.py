"""Compute a batch: points of a sweep, single runs, a part of a study, or a certified map.

The output contains the records of the batch as JSON lines, in the order of the requests.  All
numbers are dimensionless, except times (s) and memory (byte) of trials and scaling.
"""

import json
import signal

from microslip.app.job_log import end_job, job_log

signal.signal(signal.SIGINT, end_job)
if __name__ == "__main__":  # False in the processes that solve points of a map
    with job_log(snakemake.log[0]) as log:
        from microslip.app import solving

        order = json.loads(snakemake.params.batch)
        log.info(solving.solve(order, snakemake.config, snakemake.output[0], snakemake.threads))
