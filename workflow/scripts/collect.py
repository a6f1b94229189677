"""Assemble the dataset of one sweep from its batches.

Output: netCDF-4, CF conventions, all quantities dimensionless (units 1, phases in rad).
  transverse.nc       dims (amplitude, velocity)
  bore.nc             dims (amplitude, velocity)
  continuous_bore.nc  dims (velocity)
  any of `extended`   dims (amplitude, velocity), or (velocity) if its motion is steady
What has other axes is in groups of the file, see dataset.GROUPS: limits on fine axes, single runs.
A sweep with a list of Poisson's ratios has the dim poisson before these. Beside it an HTML
page that sums it up.
"""

import xarray as xr

from microslip import cache, config, dataset, summary, sweep
from microslip.jobs import job_log
from microslip.plan import Plan

name = snakemake.wildcards.sweep

with job_log(snakemake.log[0]) as log:
    configuration = config.from_mapping(snakemake.config, ask_solver=False)
    Plan(configuration).refuse_edited(f"{name}.nc", snakemake.params.code)
    grid = configuration.grids[name]
    dataset.write_sweep(
        snakemake.output[0],
        grid,
        sweep.records_for(sweep.PointRequests(grid), snakemake.input.batches),
        list(sweep.records_in(snakemake.input.histories)),
        configuration.of_sweep(name),
    )
    with xr.open_dataset(snakemake.output[0]) as data:
        lines = list(dataset.report(data, grid.group and name))
        for line in lines:
            log.info(line)
        summary.write(snakemake.output.summary, data, lines)
    cache.mark(snakemake.output, snakemake.params.made_of)
