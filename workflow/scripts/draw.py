"""Draw one figure from its datasets.

Output: the figure as PNG and as PDF.
"""

from microslip.app.job_log import job_log
from microslip.app.plan import Plan
from microslip.config import load
from microslip.report.figures import drawing
from microslip.report.figures.data import loaded
from microslip.sweeps import stamps

with job_log(snakemake.log[0]):
    name, made_of = snakemake.wildcards.figure, snakemake.params.made_of
    configuration = load.from_mapping(snakemake.config, ask_solver=False)
    Plan(configuration).refuse_edited(f"figures/{name}", made_of)
    files = zip(snakemake.params.names, snakemake.input.datasets, strict=True)
    figure = drawing.draw(name, {dataset: loaded(path) for dataset, path in files})
    stamps.set_aside(snakemake.output.stamp, snakemake.output[:2])
    for path in snakemake.output[:2]:
        drawing.save(figure, path)
    stamps.write(snakemake.output.stamp, made_of, snakemake.output[:2])
