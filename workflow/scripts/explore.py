"""Make an interactive page of sweeps, with a period behind each point of the maps.

Output: one HTML file that needs no network.  All numbers in it are dimensionless.
"""

from microslip.app.job_log import job_log
from microslip.app.plan import Plan
from microslip.config import load
from microslip.report.explorer import explorer, page
from microslip.report.figures.data import loaded
from microslip.sweeps import batches, stamps

with job_log(snakemake.log[0]) as log:
    configuration = load.from_mapping(snakemake.config, ask_solver=False)
    made_of = snakemake.params.made_of
    Plan(configuration).refuse_edited(f"pages/{snakemake.wildcards.page}", made_of)
    answer = batches.lookup(batches.records_in(snakemake.input.batches))
    periods = {
        name: [answer(request) for request in explorer.period_requests(configuration, name)]
        for name in explorer.maps_of(configuration)
    }
    paths = zip(snakemake.params.names, snakemake.input.datasets, strict=True)
    datasets = {name: loaded(path) for name, path in paths}
    certified = [datasets.pop(name) for name in explorer.certified_of(configuration)]
    stamps.set_aside(snakemake.output.stamp, snakemake.output[:1])
    page.write(snakemake.output[0], datasets, periods, certified)
    for line in explorer.report(periods):
        log.info(line)
    stamps.write(snakemake.output.stamp, made_of, snakemake.output[:1])
