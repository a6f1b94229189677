# Points and single runs, in batches.


# Compiles the solver once, before jobs that would do it at the same time. Made again in every run
# that computes something, since the compiler's own cache may be gone.
rule warm_up:
    output:
        temp(f"{RESULTS}/warm_up/{DIGEST[:16]}.txt"),
    log:
        f"{RESULTS}/logs/warm_up.log",
    conda:
        "../envs/microslip.yaml"
    resources:
        mem_mb=500,
        runtime=10,
    script:
        "../scripts/warm_up.py"


rule solve_batch:
    input:
        ancient(rules.warm_up.output),
    output:
        f"{RESULTS}/batches/{{group}}/{{batch}}.json",
    log:
        f"{RESULTS}/logs/solve_batch/{{group}}/{{batch}}.log",
    conda:
        "../envs/microslip.yaml"
    resources:
        mem_mb=500,
        runtime=60,
    params:
        # One string: Snakemake compares parameters as a set and would miss two swapped numbers.
        requests=lambda wildcards: keys.canonical_json(BATCHES[wildcards.group][wildcards.batch]),
        store=lambda wildcards, output: str(Path(output[0]).parents[2]),
    script:
        "../scripts/solve_batch.py"
