"""Put the maps and a period behind each of their points on one page.

Output: HTML, one file that needs no network; the numbers in it are dimensionless.
"""

from microslip.app import plan
from microslip.app.job_log import job_log
from microslip.config import load
from microslip.report.explorer import explorer, page
from microslip.report.figures.data import loaded
from microslip.sweeps import batches, sealed_files

with job_log(snakemake.log[0]) as log:
    configuration = load.from_mapping(snakemake.config, ask_solver=False)
    plan.Plan(configuration).refuse_edited(plan.PAGE, snakemake.params.code)
    names = snakemake.params.names
    answer = batches.lookup(batches.records_in(snakemake.input.batches))
    periods = {
        name: [answer(request) for request in explorer.period_requests(configuration, name)]
        for name in names
    }
    datasets = {name: loaded(p) for name, p in zip(names, snakemake.input.datasets, strict=True)}
    page.write(snakemake.output[0], datasets, periods)
    for line in explorer.report(periods):
        log.info(line)
    sealed_files.mark(snakemake.output, snakemake.params.made_of)
