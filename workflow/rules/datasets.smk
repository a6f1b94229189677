# Datasets: the points of a sweep, the limits from theory and the single runs beside them; studies.


rule collect:
    input:
        batches=lambda wildcards: batches_of(wildcards.sweep),
        code=[f"{PACKAGE}/dataset.py", f"{PACKAGE}/limits.py", f"{PACKAGE}/theory.py"],
    output:
        f"{RESULTS}/{{sweep}}.nc",
    log:
        f"{RESULTS}/logs/collect/{{sweep}}.log",
    conda:
        "../envs/microslip.yaml"
    resources:
        mem_mb=500,
        runtime=10,
    params:
        # Not read by the script; it makes Snakemake notice a change.
        settings=lambda wildcards: keys.canonical_json(CONFIGURATION.of_sweep(wildcards.sweep)),
        store=lambda wildcards, output: str(Path(output[0]).parent),
    script:
        "../scripts/collect.py"


rule collect_study:
    input:
        batches=lambda wildcards: batches_of_study(wildcards.dataset),
        code=[
            f"{PACKAGE}/dataset.py",
            f"{PACKAGE}/theory.py",
            *sorted(map(str, Path(PACKAGE, "studies").glob("*.py"))),
        ],
    output:
        f"{RESULTS}/{{dataset}}.nc",
    log:
        f"{RESULTS}/logs/collect/{{dataset}}.log",
    conda:
        "../envs/microslip.yaml"
    resources:
        mem_mb=500,
        runtime=10,
    params:
        # Not read by the script, as above.
        settings=lambda wildcards: keys.canonical_json(
            studies.settings(STUDIES[wildcards.dataset], CONFIGURATION)
        ),
        study=lambda wildcards: STUDIES[wildcards.dataset],
        store=lambda wildcards, output: str(Path(output[0]).parent),
    script:
        "../scripts/collect_study.py"
