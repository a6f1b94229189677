# Datasets: the points of a sweep, the limits from theory and the single runs beside them; studies.


rule collect:
    input:
        batches=lambda wildcards: batches_for(wildcards.sweep),
        histories=lambda wildcards: histories_for(wildcards.sweep),
    output:
        # The old one stays until the new one is whole, whatever happens to the job.
        kept(f"{RESULTS}/{{sweep}}.nc"),
        summary=report(
            kept(f"{RESULTS}/summaries/{{sweep}}.html"),
            caption="../report/dataset.rst",
            category="Datasets",
            labels={"dataset": "{sweep}.nc"},
        ),
    log:
        f"{RESULTS}/logs/collect/{{sweep}}.log",
    conda:
        "../envs/microslip.yaml"
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 10 * attempt,
    params:
        made_of=lambda wildcards: PLAN.fingerprint_of(f"{wildcards.sweep}.nc"),
        code=lambda wildcards: PLAN.code_of(f"{wildcards.sweep}.nc"),
    script:
        "../scripts/collect.py"


rule collect_study:
    input:
        batches=lambda wildcards: batches_for(wildcards.dataset),
    output:
        # The old one stays until the new one is whole, whatever happens to the job.
        kept(f"{RESULTS}/{{dataset}}.nc"),
        summary=report(
            kept(f"{RESULTS}/summaries/{{dataset}}.html"),
            caption="../report/dataset.rst",
            category="Datasets",
            labels={"dataset": "{dataset}.nc"},
        ),
    log:
        f"{RESULTS}/logs/collect/{{dataset}}.log",
    conda:
        "../envs/microslip.yaml"
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 10 * attempt,
    params:
        made_of=lambda wildcards: PLAN.fingerprint_of(f"{wildcards.dataset}.nc"),
        code=lambda wildcards: PLAN.code_of(f"{wildcards.dataset}.nc"),
        study=lambda wildcards: STUDIES[wildcards.dataset],
    script:
        "../scripts/collect_study.py"
