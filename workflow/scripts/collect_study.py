"""Assemble the dataset of one study from its batches.

Output: netCDF-4, CF conventions, all quantities dimensionless but for seconds and bytes.
  accuracy_cost.nc  dims trial, point, scaling_model, scaling_size, map_tolerance, and the axes of
                    the maps
  stability.nc      dims (method, case), axis
  claims.nc         dims claim, part, check, run, and axes of curves and patches
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
    dataset.write(data, snakemake.output[0])
    lines = list(studies.report(study, data))
    for line in lines:
        log.info(line)
    studies.write_page(study, snakemake.output.summary, data, lines)
    cache.mark(snakemake.output, snakemake.params.made_of)
