"""Assemble the dataset of one sweep from its batches.

Output: netCDF-4, CF conventions, all quantities dimensionless (units 1, phases in rad).
  transverse.nc       dims (amplitude, velocity)
  bore.nc             dims (amplitude, velocity)
  continuous_bore.nc  dims (velocity)
  any of `extended`   dims (amplitude, velocity), or (velocity) if its motion is steady
  any of `drives`     the same, the force in place of the velocity where one pulls, after the mass,
                      the damping and the stiffness, those of them that are axes
What has other axes is in groups of the file, see dataset.GROUPS: limits on fine axes, single runs.
A sweep with a list of Poisson's ratios has the dim poisson before these. Beside it an HTML
page that sums it up.
"""

import xarray as xr

from microslip.app.job_log import job_log
from microslip.app.plan import Plan
from microslip.config import load
from microslip.datasets import sweep_dataset
from microslip.report import dataset_page
from microslip.sweeps import batches, sealed_files

name = snakemake.wildcards.sweep

with job_log(snakemake.log[0]) as log:
    configuration = load.from_mapping(snakemake.config, ask_solver=False)
    Plan(configuration).refuse_edited(f"{name}.nc", snakemake.params.code)
    grid = configuration.grids[name]
    sweep_dataset.write_sweep(
        snakemake.output[0],
        grid,
        batches.records_for(batches.PointRequests(grid), snakemake.input.batches),
        list(batches.records_in(snakemake.input.histories)),
        configuration.of_sweep(name),
    )
    with xr.open_dataset(snakemake.output[0]) as data:
        lines = list(sweep_dataset.report(data, name if grid.group or grid.drives else None))
        for line in lines:
            log.info(line)
        dataset_page.write(snakemake.output.summary, data, lines)
    sealed_files.mark(snakemake.output, snakemake.params.made_of)
