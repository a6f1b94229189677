# Datasets: the points of a sweep, the limits from theory and the single runs beside them; studies.


rule collect:
    input:
        batches=lambda wildcards: batches_of(wildcards.sweep),
    output:
        f"{RESULTS}/{{sweep}}.nc",
        summary=report(
            f"{RESULTS}/summaries/{{sweep}}.html",
            caption="../report/dataset.rst",
            category="Datasets",
            labels={"dataset": "{sweep}.nc"},
        ),
    log:
        f"{RESULTS}/logs/collect/{{sweep}}.log",
    conda:
        "../envs/microslip.yaml"
    threads: 1
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 10 * attempt,
    params:
        # These two are not read by the script; they make Snakemake notice a change.
        code=lambda wildcards: keys.digest_of_modules(
            "dataset.py", "columns.py", "limits.py", "summary.py"
        ),
        settings=lambda wildcards: keys.canonical_json(CONFIGURATION.of_sweep(wildcards.sweep)),
        store=lambda wildcards, output: str(Path(output[0]).parent),
    script:
        "../scripts/collect.py"


rule collect_study:
    input:
        batches=lambda wildcards: batches_of_study(wildcards.dataset),
    output:
        f"{RESULTS}/{{dataset}}.nc",
        summary=report(
            f"{RESULTS}/summaries/{{dataset}}.html",
            caption="../report/dataset.rst",
            category="Datasets",
            labels={"dataset": "{dataset}.nc"},
        ),
    log:
        f"{RESULTS}/logs/collect/{{dataset}}.log",
    conda:
        "../envs/microslip.yaml"
    threads: 1
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 10 * attempt,
    params:
        # Not read by the script, as above.
        code=lambda wildcards: keys.digest_of_modules(
            "dataset.py", "columns.py", "summary.py", "studies"
        ),
        settings=lambda wildcards: keys.canonical_json(
            studies.settings(STUDIES[wildcards.dataset], CONFIGURATION)
        ),
        study=lambda wildcards: STUDIES[wildcards.dataset],
        store=lambda wildcards, output: str(Path(output[0]).parent),
    script:
        "../scripts/collect_study.py"
