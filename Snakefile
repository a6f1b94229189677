# From the configuration to the figures:
#
#   config.yaml --> solve_batch, solve_map --> results/batches --> make_dataset --> draw_figure
#                                                            data/NAME.HASH.nc, .png in results
#
# The name of a file contains a hash of everything that it is made from, so an existing file is up
# to date.  Rules therefore run only for missing files.  The dates of files and the contents of
# .snakemake do not matter.  Plain names, such as results/bore.nc, are links.  CONTRIBUTING.md
# follows one point through this workflow.

from snakemake.utils import min_version

min_version("9.4")


report: "workflow/report/workflow.rst"


include: "workflow/rules/common.smk"


onstart:
    make_ready()


rule all:
    input:
        everything,


# Make all missing datasets and figures in one process, so that the libraries are imported once.
rule make_products:
    input:
        inputs_of(*PLAN.products),
    output:
        temp(f"{RESULTS}/data/{{marker}}.made"),
    log:
        f"{RESULTS}/logs/make/{{marker}}.log",
    wildcard_constraints:
        marker="[0-9a-f]+",
    conda:
        "workflow/envs/microslip.yaml"
    # Memory and time on a cluster, including those of Snakemake (see docs/how-to/cluster.md).
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 30 * attempt,
    params:
        products=lambda wildcards: STATE.orders(*STATE.missing),
    script:
        "workflow/scripts/make.py"


# State of the results folder, whose path includes the prefix of a Snakemake module.
STATE = look(os.path.dirname(os.path.dirname(str(rules.make_products.output[0]))))


# Make each dataset and each figure a target.
for name in PLAN.products:

    rule:
        name:
            name
        input:
            files_of(name),


# Solve a batch of points.
rule solve_batch:
    output:
        in_place(f"{RESULTS}/batches/{{folder}}/{{batch}}.jsonl"),
    log:
        f"{RESULTS}/logs/{{folder}}/{{batch}}.log",
    wildcard_constraints:
        folder="[^/.]+",
        batch=any_of(STATE.batches(certified=False)),
    conda:
        "workflow/envs/microslip.yaml"
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 60 * attempt,
    params:
        batch=lambda wildcards: STATE.order_of_batch(wildcards.folder, wildcards.batch),
    script:
        "workflow/scripts/solve.py"


# Solve all points of a certified map in several processes.
use rule solve_batch as solve_map with:
    wildcard_constraints:
        folder="[^/.]+",
        batch=any_of(STATE.batches(certified=True)),
    threads: 8
    resources:
        mem_mb=lambda wildcards, attempt, threads: 500 * attempt * (threads + 1),
        runtime=lambda wildcards, attempt: 120 * attempt,


rule make_dataset:
    input:
        lambda wildcards: inputs_of_stem(wildcards.stem),
    output:
        in_place(f"{RESULTS}/data/{{stem}}.nc"),
        report(
            in_place(f"{RESULTS}/data/{{stem}}.html"),
            caption="workflow/report/dataset.rst",
            category="Datasets",
            labels={"dataset": "{stem}.nc"},
        ),
    log:
        f"{RESULTS}/logs/dataset/{{stem}}.log",
    wildcard_constraints:
        stem=any_of(STATE.stems_of("dataset")),
    conda:
        "workflow/envs/microslip.yaml"
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 10 * attempt,
    params:
        products=lambda wildcards: STATE.orders(PRODUCT_OF[wildcards.stem]),
    script:
        "workflow/scripts/make.py"


use rule make_dataset as draw_figure with:
    output:
        report(
            in_place(f"{RESULTS}/data/{{stem}}.png"),
            caption="workflow/report/figure.rst",
            category="Figures",
            labels={"figure": "{stem}"},
        ),
        in_place(f"{RESULTS}/data/{{stem}}.pdf"),
    log:
        f"{RESULTS}/logs/draw/{{stem}}.log",
    wildcard_constraints:
        stem=any_of(STATE.stems_of("figure")),


# Make an interactive page of maps, with stored periods of points.
use rule make_dataset as make_page with:
    output:
        report(
            in_place(f"{RESULTS}/data/{{stem}}.html"),
            caption="workflow/report/explorer.rst",
            category="Explorer",
            labels={"page": "{stem}.html"},
        ),
    log:
        f"{RESULTS}/logs/explore/{{stem}}.log",
    wildcard_constraints:
        stem=any_of(STATE.stems_of("explorer")),


# Make each plain name, such as results/bore.nc, a target.
rule link_file:
    input:
        unpack(lambda wildcards: inputs_of_link(wildcards.plain)),
    output:
        f"{RESULTS}/{{plain}}",
    log:
        f"{RESULTS}/logs/link/{{plain}}.log",
    wildcard_constraints:
        plain=any_of(STATE.plain()),
    localrule: True
    conda:
        "workflow/envs/microslip.yaml"
    params:
        to=lambda wildcards, input, output: os.path.relpath(
            input.file, os.path.dirname(output[0])  # a module adds its prefix to both paths
        ),
    shell:
        "(ln -s {params.to:q} {output:q} || cp {input.file:q} {output:q}) 2> {log:q}"
