"""Make datasets with HTML pages, figures, and explorer pages.

A dataset is written as a netCDF-4 file with CF conventions and as an HTML page.  A figure is
written as a PNG and a PDF file.  The explorer is one HTML file that needs no network.  All
quantities are dimensionless, except the seconds and bytes of studies.
"""

import logging
import signal
from pathlib import Path

from microslip.app.job_log import end_job, job_log
from microslip.app.products import make_products

signal.signal(signal.SIGINT, end_job)
with job_log(snakemake.log[0], shown=logging.INFO):
    make_products(snakemake)
    if snakemake.output[0].endswith(".made"):
        Path(snakemake.output[0]).touch()
