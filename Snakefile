# The paper's sweeps, from the configuration to the figures:
#
#   config.yaml --> points, cut into batches --> solve_batch --+--> results/batches/*/*.json
#                                 warm_up -->----^             +--> results/points (one file a point)
#   batches of a sweep --> collect --> results/{transverse,bore,continuous_bore}.nc
#   datasets --> draw_figure --> results/figures/fig{1..6}_*.{png,pdf}
#
# Two studies compare methods: snakemake accuracy, snakemake stability.
#
#   methods, points --> pieces --> solve_batch --+--> results/batches/{accuracy,stability}*/*.json
#                                                +--> results/{points,trials,probes,scaling}
#   pieces of a study --> collect_study --> results/{accuracy_cost,stability}.nc --> draw_figure
#
# Batches are named by the hashes of their points, points by what they depend on: the physics, the
# tolerance and the solver's sources. So what is there is never stale, and never computed twice.

from snakemake.utils import min_version

min_version("9.0")


include: "workflow/rules/package.smk"


# A file given with --configfile takes the place of the default, they are not mixed.
if not workflow.overwrite_configfiles:
    with refused_in_one_line("config/config.yaml"):
        microslip_config.read_yaml("config/config.yaml")  # says where a mistake is

    configfile: "config/config.yaml"


include: "workflow/rules/common.smk"
include: "workflow/rules/points.smk"
include: "workflow/rules/datasets.smk"
include: "workflow/rules/figures.smk"


onstart:
    make_ready()


onsuccess:
    show_the_end()


onerror:
    show_the_end()


rule all:
    default_target: True
    input:
        expand(f"{RESULTS}/{{sweep}}.nc", sweep=CONFIGURATION.sweeps),
        figures_of(CONFIGURATION.sweeps),


rule accuracy:
    input:
        f"{RESULTS}/accuracy_cost.nc",
        figures_of(["accuracy_cost"]),


rule stability:
    input:
        f"{RESULTS}/stability.nc",
        figures_of(["stability"]),
