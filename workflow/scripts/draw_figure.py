"""Draw one figure from its datasets.

Output: the figure as PNG and as PDF.
"""

from microslip.app.job_log import job_log
from microslip.app.plan import Plan
from microslip.config import load
from microslip.report.figures import drawing
from microslip.report.figures.data import loaded
from microslip.sweeps import sealed_files

with job_log(snakemake.log[0]):
    configuration = load.from_mapping(snakemake.config, ask_solver=False)
    file = f"figures/{snakemake.wildcards.figure}.png"
    Plan(configuration).refuse_edited(file, snakemake.params.code)
    names = snakemake.params.names
    data = {name: loaded(path) for name, path in zip(names, snakemake.input, strict=True)}
    figure = drawing.draw(snakemake.wildcards.figure, data)
    for path in snakemake.output:
        drawing.save(figure, path)
    sealed_files.mark(snakemake.output, snakemake.params.made_of)
