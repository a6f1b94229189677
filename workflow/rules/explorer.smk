# The explorer: one page to look behind every point of the maps.


rule explorer:
    input:
        datasets=lambda wildcards: datasets_explored(),
        batches=lambda wildcards: whole_batches(*(f"{name}_periods" for name in EXPLORED)),
    output:
        report(
            kept(PAGE),
            caption="../report/explorer.rst",
            category="Explorer",
            labels={"page": "explorer.html"},
        ),
    log:
        f"{RESULTS}/logs/explorer.log",
    conda:
        "../envs/microslip.yaml"
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 10 * attempt,
    params:
        names=EXPLORED,
        made_of=lambda wildcards: PLAN.fingerprint_of(plan.PAGE),
        code=lambda wildcards: PLAN.code_of(plan.PAGE),
    script:
        "../scripts/explore.py"
