"""Assemble the dataset of a certified map from the answers of its rounds.

Output: netCDF-4, CF conventions, all quantities dimensionless (units 1).
  certified_transverse.nc  dims point, cell, node
  certified_bore.nc        the same
Beside it an HTML page that sums it up.
"""

from microslip.app.job_log import job_log
from microslip.app.plan import Plan
from microslip.config import load
from microslip.datasets import certified_map
from microslip.report import dataset_page
from microslip.sweeps import batches, map_rounds, sealed_files

name = snakemake.wildcards.certified

with job_log(snakemake.log[0]) as log:
    configuration = load.from_mapping(snakemake.config, ask_solver=False)
    Plan(configuration).refuse_edited(f"{name}.nc", snakemake.params.code)
    rounds = map_rounds.read_rounds(snakemake.input.rounds)
    records = batches.records_in(snakemake.input.batches)
    data = certified_map.build(configuration.certified[name], rounds, records)
    certified_map.write(snakemake.output[0], data)
    lines = list(certified_map.report(data, name))
    for line in lines:
        log.info(line)
    dataset_page.write(snakemake.output.summary, data, lines)
    sealed_files.mark(snakemake.output, snakemake.params.made_of)
