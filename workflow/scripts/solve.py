"""Compute a batch: points of a sweep, single runs, part of a study, or a whole certified map.

Output: the records of the batch in the order of the requests, as JSON lines.  All numbers in them
are dimensionless, except times (s) and memory (byte) of trials and scaling.
"""

import json

from microslip.app.job_log import job_log

if __name__ == "__main__":  # not in the processes that solve points of a map
    with job_log(snakemake.log[0]) as log:
        from microslip.app import solving

        order = json.loads(snakemake.params.batch)
        log.info(solving.solve(order, snakemake.config, snakemake.output[0], snakemake.threads))
