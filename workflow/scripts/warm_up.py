"""Compile the solver's kernels into Numba's cache.

Output: a text file that says that it was done.
"""

from pathlib import Path

import microslip
from microslip.jobs import job_log

with job_log(snakemake.log[0]):
    microslip.warm_up()
    Path(snakemake.output[0]).write_text("The kernels are compiled.\n")
