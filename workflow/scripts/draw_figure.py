"""Draw one figure from its dataset.

Output: the figure as PNG and as PDF.
"""

import xarray as xr

from microslip import plot
from microslip.jobs import job_log

with job_log(snakemake.log[0]), xr.open_dataset(snakemake.input.dataset) as data:
    figure = plot.draw(snakemake.wildcards.figure, {snakemake.params.name: data})
    for path in snakemake.output:
        plot.save(figure, path)
