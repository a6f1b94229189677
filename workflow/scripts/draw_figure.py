"""Draw one figure from its datasets.

Output: the figure as PNG and as PDF.
"""

from microslip import cache, config, plot
from microslip.jobs import job_log
from microslip.plan import Plan
from microslip.plot.data import loaded

with job_log(snakemake.log[0]):
    configuration = config.from_mapping(snakemake.config, ask_solver=False)
    file = f"figures/{snakemake.wildcards.figure}.png"
    Plan(configuration).refuse_edited(file, snakemake.params.code)
    names = snakemake.params.names
    data = {name: loaded(path) for name, path in zip(names, snakemake.input, strict=True)}
    figure = plot.draw(snakemake.wildcards.figure, data)
    for path in snakemake.output:
        plot.save(figure, path)
    cache.mark(snakemake.output, snakemake.params.made_of)
