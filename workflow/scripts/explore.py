"""Put sweeps, and a period behind each point of the maps, on one page that answers questions.

Output: HTML, one file that needs no network; the numbers in it are dimensionless.
"""

from pathlib import Path

from microslip.app import plan
from microslip.app.job_log import job_log
from microslip.config import load
from microslip.report.explorer import explorer, page
from microslip.report.figures.data import loaded
from microslip.sweeps import batches, sealed_files

with job_log(snakemake.log[0]) as log:
    configuration = load.from_mapping(snakemake.config, ask_solver=False)
    made = Path(snakemake.output[0]).name
    plan.Plan(configuration).refuse_edited(made, snakemake.params.code)
    answer = batches.lookup(batches.records_in(snakemake.input.batches))
    periods = {
        name: [answer(request) for request in explorer.period_requests(configuration, name)]
        for name in snakemake.params.explored
    }
    files = zip(snakemake.params.names, snakemake.input.datasets, strict=True)
    datasets = {name: loaded(path) for name, path in files}
    certified = [loaded(path) for path in snakemake.input.get("certified", ())]
    page.write(snakemake.output[0], datasets, periods, certified)
    for line in explorer.report(periods):
        log.info(line)
    sealed_files.mark(snakemake.output, snakemake.params.made_of)
