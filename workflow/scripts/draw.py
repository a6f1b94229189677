"""Draw one figure from its datasets.

Output: the figure as PNG and as PDF.
"""

from microslip.app.plan import product_job
from microslip.report.figures import drawing
from microslip.report.figures.data import loaded

name = snakemake.wildcards.figure

with product_job(snakemake, f"figures/{name}") as (plan, _):
    files = zip(plan.figures[name], snakemake.input.datasets, strict=True)
    figure = drawing.draw(name, {dataset: loaded(path) for dataset, path in files})
    for path in snakemake.output[:2]:
        drawing.save(figure, path)
