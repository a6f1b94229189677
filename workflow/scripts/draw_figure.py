"""Draw one figure from its dataset.

Output: the figure as PNG and as PDF.
"""

from microslip import plot
from microslip.jobs import job_log
from microslip.plot.data import loaded

with job_log(snakemake.log[0]):
    data = loaded(snakemake.input.dataset)
    figure = plot.draw(snakemake.wildcards.figure, {snakemake.params.name: data})
    for path in snakemake.output:
        plot.save(figure, path)
