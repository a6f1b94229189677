# The paper's sweeps, from the configuration to the figures:
#
#   config.yaml --> points, cut into batches --> solve_batch --+--> results/batches/*/*.json
#                                 warm_up -->----^             +--> results/points (one file a point)
#   batches of a sweep --> collect --> results/{transverse,bore,continuous_bore}.nc
#   datasets --> draw_figure --> results/figures/fig{1..6}_*.{png,pdf}
#
# snakemake, or snakemake all, makes the above; snakemake fig2 makes one figure with its dataset.
# snakemake --report report.zip makes one page of
# figures, captions and what made them.
#
# Two studies compare methods: snakemake accuracy, snakemake stability; a third one judges what the
# paper says: snakemake claims. A fourth one shows what motions drive: snakemake propulsion.
#
#   methods, points --> pieces --> solve_batch --+--> results/batches/{accuracy,stability,claims,propulsion}*/
#                                                +--> results/{points,trials,probes,scaling,...}
#   pieces of a study --> collect_study --> results/{accuracy_cost,stability,claims,propulsion}.nc
#   datasets --> draw_figure
#
# Sweeps of other motions and pressures, those under `extended`, come the same way: snakemake extended
# makes results/NAME.nc of each, and a figure extended_GROUP of each of their groups. So do those of
# contacts that are pulled, under `drives`: snakemake drives makes results/NAME.nc of each.
#
# Maps with an error that holds everywhere, of those sweeps that say `adaptive`: snakemake certified.
#
#   answers so far --> next_round --> solve_round --> results/rounds --> ... --> collect_certified
#                                                              --> results/certified_{transverse,bore}.nc
#
# snakemake explorer makes one page to look behind every point of the maps.
#
#   points of the maps --> periods, cut into batches --> solve_batch --> results/periods
#   datasets, periods, certified maps --> explorer --> results/explorer.html
#
# snakemake explorer_all makes the same of every sweep: results/explorer_all.html.
#
# Batches are named by the hashes of their points, points by what they depend on: the physics, the
# tolerance and the solver's sources. So what is there is never stale, and never computed twice.
# A batch stays as it was planned: results/batches/*/*.plan lists them, and new points get new ones.

import os

from snakemake.utils import min_version

min_version("9.4")


report: "workflow/report/workflow.rst"


include: "workflow/rules/package.smk"


# A file given with --configfile takes the place of the default, they are not mixed. Without one, that
# of the working directory comes first. A module is configured by the workflow that uses it.
MAIN = workflow.modifier.base_snakefile is None
if not (workflow.overwrite_configfiles if MAIN else config):
    DEFAULT = "config/config.yaml"
    if not (MAIN and os.path.exists(DEFAULT)):
        DEFAULT = str(workflow.current_basedir.join(DEFAULT))
    if "://" not in DEFAULT:
        with refused_in_one_line(DEFAULT):
            load.read_yaml(os.path.relpath(DEFAULT))  # says where a mistake is

    configfile: DEFAULT


include: "workflow/rules/common.smk"
include: "workflow/rules/stale.smk"
include: "workflow/rules/points.smk"
include: "workflow/rules/datasets.smk"
include: "workflow/rules/certified.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/explorer.smk"


onstart:
    make_ready()


onsuccess:
    show_the_end()


onerror:
    show_the_end()


rule all:
    input:
        datasets_of(CONFIGURATION.sweeps),
        figures_of(CONFIGURATION.sweeps),


rule certified:
    input:
        datasets_of(CERTIFIED_AT_VELOCITIES),
        figures_of(CERTIFIED_AT_VELOCITIES),


rule extended:
    input:
        datasets_of(CONFIGURATION.extended),
        figures_of(CONFIGURATION.extended),


rule drives:
    input:
        datasets_of(DRIVEN),
        figures_of(DRIVEN),


rule accuracy:
    input:
        datasets_of(["accuracy_cost"]),
        figures_of(["accuracy_cost"]),


rule stability:
    input:
        datasets_of(["stability"]),
        figures_of(["stability"]),


rule propulsion:
    input:
        datasets_of(["propulsion"]),
        figures_of(["propulsion"]),


rule claims:
    input:
        datasets_of(["claims"]),
        figures_of(["claims"]),
