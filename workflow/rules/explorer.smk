# The explorer: one page to look behind every point of the maps, and one with every other sweep, too.


rule explorer:
    input:
        datasets=lambda wildcards: datasets_explored(explorer.PAGE),
        batches=lambda wildcards: whole_batches(*(f"{name}_periods" for name in EXPLORED)),
        certified=in_results(f"{name}.nc" for name in ANSWERING),
    output:
        report(
            kept(f"{RESULTS}/{explorer.PAGE}"),
            caption="../report/explorer.rst",
            category="Explorer",
            labels={"page": explorer.PAGE},
        ),
    log:
        f"{RESULTS}/logs/explorer.log",
    conda:
        "../envs/microslip.yaml"
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 10 * attempt,
    params:
        names=explorer.sweeps_of(CONFIGURATION, explorer.PAGE),
        explored=EXPLORED,
        made_of=lambda wildcards: PLAN.fingerprint_of(explorer.PAGE),
        code=lambda wildcards: PLAN.code_of(explorer.PAGE),
    script:
        "../scripts/explore.py"


use rule explorer as explorer_all with:
    input:
        datasets=lambda wildcards: datasets_explored(explorer.PAGE_OF_ALL),
        batches=lambda wildcards: whole_batches(*(f"{name}_periods" for name in EXPLORED)),
        certified=in_results(f"{name}.nc" for name in ANSWERING),
    output:
        report(
            kept(f"{RESULTS}/{explorer.PAGE_OF_ALL}"),
            caption="../report/explorer.rst",
            category="Explorer",
            labels={"page": explorer.PAGE_OF_ALL},
        ),
    log:
        f"{RESULTS}/logs/explorer_all.log",
    params:
        names=explorer.sweeps_of(CONFIGURATION, explorer.PAGE_OF_ALL),
        explored=EXPLORED,
        made_of=lambda wildcards: PLAN.fingerprint_of(explorer.PAGE_OF_ALL),
        code=lambda wildcards: PLAN.code_of(explorer.PAGE_OF_ALL),
