# The paper's sweeps, from the configuration to the figures:
#
#   config.yaml --> points, cut into batches --> solve_batch --+--> results/batches/*/*.json
#                                 warm_up -->----^             +--> results/points (one file a point)
#   batches of a sweep --> collect --> results/{transverse,bore,continuous_bore}.nc
#   datasets --> draw_figure --> results/figures/fig{1..6}_*.{png,pdf}
#
# Batches are named by the hashes of their points, points by what they depend on: the physics, the
# tolerance and the solver's sources. So what is there is never stale, and never computed twice.

from snakemake.utils import min_version

min_version("9.0")

# A file given with --configfile takes the place of the default, they are not mixed.
if not workflow.overwrite_configfiles:

    configfile: "config/config.yaml"


include: "workflow/rules/common.smk"
include: "workflow/rules/points.smk"
include: "workflow/rules/datasets.smk"
include: "workflow/rules/figures.smk"


rule all:
    default_target: True
    input:
        expand(f"{RESULTS}/{{sweep}}.nc", sweep=CONFIGURATION.sweeps),
        expand(f"{RESULTS}/figures/{{figure}}.{{format}}", figure=FIGURES, format=["png", "pdf"]),
