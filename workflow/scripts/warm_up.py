"""Compile the solver's kernels into Numba's cache.

Output: a text file that says that it was done.
"""

import microslip
from microslip.cache import write_atomically
from microslip.jobs import job_log

with job_log(snakemake.log[0]):
    microslip.warm_up()
    write_atomically(snakemake.output[0], b"The kernels are compiled.\n")
