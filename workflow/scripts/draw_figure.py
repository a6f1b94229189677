"""Draw one figure from its datasets.

Output: the figure as PNG and as PDF.
"""

from microslip import plot
from microslip.jobs import job_log
from microslip.plot.data import loaded

with job_log(snakemake.log[0]):
    names = snakemake.params.names
    data = {name: loaded(path) for name, path in zip(names, snakemake.input, strict=True)}
    figure = plot.draw(snakemake.wildcards.figure, data)
    for path in snakemake.output:
        plot.save(figure, path)
