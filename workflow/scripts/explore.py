"""Make an interactive page of sweeps, with stored periods for points of the maps.

Output: one HTML file that needs no network.  All numbers in it are dimensionless.
"""

from microslip.app.plan import product_job
from microslip.report.explorer import explorer, page
from microslip.report.figures.data import loaded
from microslip.sweeps import batches

product = f"pages/{snakemake.wildcards.page}"

with product_job(snakemake, product) as (plan, log):
    configuration = plan.configuration
    answer = batches.lookup(batches.records_in(snakemake.input.batches))
    periods = {
        name: [answer(request) for request in explorer.period_requests(configuration, name)]
        for name in explorer.maps_of(configuration)
    }
    paths = zip(plan.products[product].datasets, snakemake.input.datasets, strict=True)
    datasets = {name: loaded(path) for name, path in paths}
    certified = [datasets.pop(name) for name in explorer.certified_of(configuration)]
    page.write(snakemake.output[0], datasets, periods, certified)
    for line in explorer.report(periods):
        log.info(line)
