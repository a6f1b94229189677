"""Assemble the dataset of one study from its batches.

Output: netCDF-4, CF conventions, all quantities dimensionless but for seconds and bytes.
  accuracy_cost.nc  dim trial; groups points, scaling, transverse_map, bore_map, profile
  stability.nc      dims (method, case); group axes
  propulsion.nc        dims (line, point)
  claims.nc         dim claim; groups parts, checks, runs, and those of the static limit and patches
and an HTML page that sums it up.
"""

from microslip.app.job_log import job_log
from microslip.app.plan import Plan
from microslip.config import load
from microslip.datasets import sweep_dataset
from microslip.report import study_page
from microslip.studies import registry
from microslip.sweeps import batches, sealed_files

study = snakemake.params.study

with job_log(snakemake.log[0]) as log:
    configuration = load.from_mapping(snakemake.config, ask_solver=False)
    Plan(configuration).refuse_edited(f"{snakemake.wildcards.dataset}.nc", snakemake.params.code)
    answer = batches.lookup(batches.records_in(snakemake.input.batches))
    data = registry.build(study, configuration, answer)
    sweep_dataset.write(data, snakemake.output[0], registry.groups(study))
    lines = list(registry.report(study, data))
    for line in lines:
        log.info(line)
    study_page.write(study, snakemake.output.summary, data, lines)
    sealed_files.mark(snakemake.output, snakemake.params.made_of)
