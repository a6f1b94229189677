"""Assemble a dataset from its batches.

Output: netCDF-4, CF conventions; dimensionless (units 1, phases in rad) except for the seconds and
bytes of studies.
  NAME.nc            a sweep: dims (amplitude, velocity), as far as the motion has them, after
                     mass, damping, stiffness, poisson if these are axes; force replaces velocity
  certified_NAME.nc  dims point, cell, node
  accuracy_cost.nc   dim trial; groups points, transverse_map, bore_map, profile
  stability.nc       dims (method, case); group axes
  claims.nc          dim claim; groups parts, checks, runs, static limit, patches
Variables with other axes are in groups of the file.  An HTML page summarises the file.
"""

import logging

import xarray as xr

from microslip.app.plan import product_job
from microslip.datasets import certified_map, netcdf, sweep_dataset
from microslip.report import claims_page, dataset_page
from microslip.studies import registry
from microslip.sweeps import batches

name, path = snakemake.wildcards.dataset, snakemake.output[0]


def write_sweep(grid, paths) -> list[str]:
    """Write the dataset and the page of a sweep; return the lines of its report."""
    of_points = len(plan.batch_files(name))  # the files of single runs follow
    points, runs = map(batches.records_in, (paths[:of_points], paths[of_points:]))
    sweep_dataset.write_sweep(path, grid, points, list(runs), configuration.of_sweep(name))
    with xr.open_dataset(path) as data:
        lines = list(sweep_dataset.report(data, name if grid.group or grid.drives else None))
        dataset_page.write(snakemake.output.summary, data, lines)
    return lines


def write_map(map_, records) -> list[str]:
    """Write the dataset and the page of a certified map; return the lines of its report."""
    data = certified_map.build(map_, records)
    netcdf.write(path, data)
    lines = list(certified_map.report(data, name))
    dataset_page.write(snakemake.output.summary, data, lines)
    return lines


def write_study(study, records) -> list[str]:
    """Write the dataset and the page of a study; return the lines of its report."""
    data = registry.build(study, configuration, batches.lookup(records))
    netcdf.write(path, *netcdf.divide(data, registry.groups(study)))
    lines = list(registry.report(study, data))
    page = claims_page if study == "claims" else dataset_page
    page.write(snakemake.output.summary, data, lines)
    return lines


with product_job(snakemake, name, shown=logging.INFO) as (plan, log):
    configuration = plan.configuration
    records = batches.records_in(snakemake.input.batches)
    if name in configuration.grids:
        report = write_sweep(configuration.grids[name], snakemake.input.batches)
    elif name in configuration.certified:
        report = write_map(configuration.certified[name], records)
    else:
        report = write_study(plan.studies[name], records)
    for line in report:
        log.info(line)
