"""Compile the solver's kernels into Numba's cache.

Output: a text file that marks the end of the compilation.
"""

import microslip
from microslip.app.job_log import job_log
from microslip.foundation.files import write_atomically

with job_log(snakemake.log[0]):
    microslip.warm_up(snakemake.wildcards.kernels)
    write_atomically(snakemake.output[0], b"The kernels are compiled.\n")
