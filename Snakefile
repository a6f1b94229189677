# From the configuration to the figures:
#
#   config.yaml --> batches --> solve, map --> results/batches --> collect --> results/NAME.nc
#                     results/points (the store) <--'               draw --> results/figures
#                                                                explore --> results/*.html
#
# CONTRIBUTING.md follows one point along this way, and explains how stamps and the file
# results/.again decide what is made again.  Inputs that are up to date are marked `ancient`, so
# neither other modification times nor .snakemake matter.

from snakemake.utils import min_version

min_version("9.4")


report: "workflow/report/workflow.rst"


include: "workflow/rules/common.smk"


onstart:
    make_ready()


wildcard_constraints:
    batch="[0-9a-f]+",
    dataset="|".join(PLAN.datasets),
    figure="|".join(PLAN.figures),
    page="explorer|explorer_all",
    kernels="rings|angles|pulled",


rule all:
    input:
        files_of_target("all"),


# snakemake certified, snakemake fig2, and all other targets that `microslip sweep --help` lists.
for target in PLAN.targets:
    if target != "all":

        rule:
            name:
                target
            input:
                files_of_target(target),


# Compiles the solver once, so that parallel jobs do not all compile it.
rule warm_up:
    input:
        lambda wildcards: ancient(
            compiled("rings", "angles") if wildcards.kernels == "pulled" else []
        ),
    output:
        f"{RESULTS}/warm_up/{source_digest.of_solver()[:16]}_{{kernels}}.txt",
    log:
        f"{RESULTS}/logs/warm_up/{{kernels}}.log",
    conda:
        "workflow/envs/microslip.yaml"
    # Memory and time on a cluster, including Snakemake: see docs/how-to/cluster.md.
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 10 * attempt,
    script:
        "workflow/scripts/warm_up.py"


rule solve:
    input:
        ancient(lambda wildcards: kernels_for(wildcards.group)),
        again=lambda wildcards: made_again(
            is_whole(f"batches/{wildcards.group}/{wildcards.batch}.jsonl")
        ),
    output:
        f"{RESULTS}/batches/{{group}}/{{batch}}.jsonl",
    log:
        f"{RESULTS}/logs/solve/{{group}}/{{batch}}.log",
    wildcard_constraints:
        group="|".join(PLAN.groups),
    conda:
        "workflow/envs/microslip.yaml"
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 60 * attempt,
    params:
        batch=lambda wildcards: batch_of(wildcards.group, wildcards.batch),
        store=lambda wildcards, output: output[0].rpartition("/batches/")[0],
    script:
        "workflow/scripts/solve.py"


# Solves all points of a certified map in several processes.
use rule solve as map with:
    log:
        f"{RESULTS}/logs/map/{{group}}/{{batch}}.log",
    wildcard_constraints:
        group="|".join(CONFIGURATION.certified) or "(?!)",
    threads: 8
    resources:
        mem_mb=lambda wildcards, attempt, threads: 500 * attempt * (threads + 1),
        runtime=lambda wildcards, attempt: 120 * attempt,


rule collect:
    input:
        batches=lambda wildcards: batches_for(wildcards.dataset),
        again=lambda wildcards: made_again(is_right(wildcards.dataset)),
    output:
        in_place(f"{RESULTS}/{{dataset}}.nc"),
        summary=report(
            in_place(f"{RESULTS}/summaries/{{dataset}}.html"),
            caption="workflow/report/dataset.rst",
            category="Datasets",
            labels={"dataset": "{dataset}.nc"},
        ),
        stamp=in_place(f"{RESULTS}/{stamps.stamp_of('{dataset}')}"),
    log:
        f"{RESULTS}/logs/collect/{{dataset}}.log",
    conda:
        "workflow/envs/microslip.yaml"
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 10 * attempt,
    params:
        made_of=lambda wildcards: PLAN.made_of(wildcards.dataset),
    script:
        "workflow/scripts/collect.py"


rule draw:
    input:
        datasets=lambda wildcards: datasets_for(f"figures/{wildcards.figure}"),
        again=lambda wildcards: made_again(is_right(f"figures/{wildcards.figure}")),
    output:
        report(
            in_place(f"{RESULTS}/figures/{{figure}}.png"),
            caption="workflow/report/figure.rst",
            category=lambda wildcards: figure_targets.heading_of(
                CONFIGURATION, PLAN.figures[wildcards.figure][0]
            ),
            labels={"figure": "{figure}"},
        ),
        in_place(f"{RESULTS}/figures/{{figure}}.pdf"),
        stamp=in_place(f"{RESULTS}/{stamps.stamp_of('figures/{figure}')}"),
    log:
        f"{RESULTS}/logs/draw/{{figure}}.log",
    conda:
        "workflow/envs/microslip.yaml"
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 10 * attempt,
    params:
        made_of=lambda wildcards: PLAN.made_of(f"figures/{wildcards.figure}"),
    script:
        "workflow/scripts/draw.py"


# Interactive page of the maps. The page explorer_all.html also contains all other sweeps.
rule explore:
    input:
        datasets=lambda wildcards: datasets_for(f"pages/{wildcards.page}"),
        batches=lambda wildcards: batches_for(f"pages/{wildcards.page}"),
        again=lambda wildcards: made_again(is_right(f"pages/{wildcards.page}")),
    output:
        report(
            in_place(f"{RESULTS}/{{page}}.html"),
            caption="workflow/report/explorer.rst",
            category="Explorer",
            labels={"page": "{page}.html"},
        ),
        stamp=in_place(f"{RESULTS}/{stamps.stamp_of('pages/{page}')}"),
    log:
        f"{RESULTS}/logs/explore/{{page}}.log",
    conda:
        "workflow/envs/microslip.yaml"
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 10 * attempt,
    params:
        made_of=lambda wildcards: PLAN.made_of(f"pages/{wildcards.page}"),
    script:
        "workflow/scripts/explore.py"


# The folder in which the rules write results, with the prefix of a Snakemake module.
PLACE = os.path.dirname(str(rules.collect.output[0]))

with refused_in_one_line():
    if HERE:
        groups = {"batches", "figures", "logs", "warm_up", *batches.FOLDERS.values()}
        made = [file for product in PLAN.products.values() for file in product.files]
        files.refuse_unusable(*([f"{PLACE}/{name}" for name in names] for names in (groups, made)))
    stamps.write_again(f"{PLACE}/{stamps.AGAIN}" if HERE else AGAIN, dated=HERE)
