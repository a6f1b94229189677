"""Choose the points of a certified map that are solved next, from the answers so far.

Output: a round as JSON: scaled coordinates of the nodes, requests for them, the number of batches
that they are cut into. A round without nodes is the last one.
"""

from microslip.app.job_log import job_log
from microslip.config import load
from microslip.sweeps import batches, map_rounds, sealed_files

name = snakemake.wildcards.certified

with job_log(snakemake.log[0]) as log:
    configuration = load.from_mapping(snakemake.config, ask_solver=False)
    done = map_rounds.read_rounds(snakemake.input.get("rounds", ()))
    known = map_rounds.answers_in(done, batches.records_in(snakemake.input.get("batches", ())))
    size = configuration.points_per_job[name.removeprefix("certified_")]
    found = map_rounds.next_round(configuration.certified[name], known, size)
    sealed_files.write_atomically(snakemake.output[0], map_rounds.text_of(found))
    log.info("%s, round %s: %d points", name, snakemake.wildcards.round, len(found["nodes"]))
