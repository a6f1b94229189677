# The explorer: one page to look behind every point of the maps.


rule explorer:
    input:
        datasets=lambda wildcards: datasets_explored(),
        batches=lambda wildcards: indices_of(*(f"{name}_periods" for name in EXPLORED)),
    output:
        report(
            PAGE,
            caption="../report/explorer.rst",
            category="Explorer",
            labels={"page": "explorer.html"},
        ),
    log:
        f"{RESULTS}/logs/explorer.log",
    conda:
        "../envs/microslip.yaml"
    threads: 1
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 10 * attempt,
    params:
        names=EXPLORED,
        # Not read by the script; it makes Snakemake notice a change.
        code=lambda wildcards: explorer.digest(),
        store=lambda wildcards, output: str(Path(output[0]).parent),
    script:
        "../scripts/explore.py"
