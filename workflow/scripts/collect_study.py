"""Assemble the dataset of one study from its batches.

Output: netCDF-4, CF conventions, all quantities dimensionless but for seconds and bytes.
  accuracy_cost.nc  dim trial; groups points, scaling, transverse_map, bore_map, profile
  stability.nc      dims (method, case); group axes
  claims.nc         dim claim; groups parts, checks, runs, and those of the static limit and patches
and an HTML page that sums it up.
"""

from microslip import cache, config, dataset, studies, sweep
from microslip.jobs import job_log
from microslip.plan import Plan

study = snakemake.params.study

with job_log(snakemake.log[0]) as log:
    configuration = config.from_mapping(snakemake.config, ask_solver=False)
    Plan(configuration).refuse_edited(f"{snakemake.wildcards.dataset}.nc", snakemake.params.code)
    answer = sweep.lookup(sweep.records_in(snakemake.input.batches))
    data = studies.build(study, configuration, answer)
    dataset.write(data, snakemake.output[0], studies.groups(study))
    lines = list(studies.report(study, data))
    for line in lines:
        log.info(line)
    studies.write_page(study, snakemake.output.summary, data, lines)
    cache.mark(snakemake.output, snakemake.params.made_of)
