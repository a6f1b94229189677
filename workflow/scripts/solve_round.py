"""Answer a part of a round of a certified map.

Output: the records of the batch, in the order of the requests, one a line as JSON with a checksum.
All numbers in them are dimensionless. Each is kept in the store as well, as soon as it is computed.
"""

from microslip.app.job_log import job_log
from microslip.app.progress import counted
from microslip.sweeps import batch_files, batches, cache, map_rounds

with job_log(snakemake.log[0]) as log:
    chosen = map_rounds.read_round(snakemake.input.round)
    records, done = batches.run_batch(
        map_rounds.part_of(chosen, int(snakemake.wildcards.part)),
        cache.Store(snakemake.params.store),
        lambda requests: counted(requests, snakemake.params.counter),
    )
    batch_files.write_batch(snakemake.output[0], records, done["final"])
    log.info("%(points)d points, %(computed)d computed in %(solver_seconds).2f s of CPU time", done)
