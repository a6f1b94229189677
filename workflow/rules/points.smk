# Points and single runs, in batches.


# Compiles the solver once, before jobs that would all do it at the same time. Two jobs share the
# work, since what they compile has little in common.
rule warm_up:
    output:
        f"{RESULTS}/warm_up/{source_digest.of_solver()[:16]}.txt",
    log:
        f"{RESULTS}/logs/warm_up.log",
    conda:
        "../envs/microslip.yaml"
    # What a job takes where a scheduler starts it, Snakemake within it included: see
    # docs/how-to/cluster.md.
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 10 * attempt,
    params:
        kernels="rings",
    script:
        "../scripts/warm_up.py"


use rule warm_up as warm_up_angles with:
    output:
        f"{RESULTS}/warm_up/{source_digest.of_solver()[:16]}_angles.txt",
    log:
        f"{RESULTS}/logs/warm_up_angles.log",
    params:
        kernels="angles",


# The same of what marches contacts that a force or a spring pulls.
use rule warm_up as warm_up_pulled with:
    input:
        ancient(rules.warm_up.output),
        ancient(rules.warm_up_angles.output),
    output:
        f"{RESULTS}/warm_up/{source_digest.of_solver()[:16]}_pulled.txt",
    log:
        f"{RESULTS}/logs/warm_up_pulled.log",
    params:
        kernels="pulled",


rule solve_batch:
    input:
        # They only have to be there: their names hold the digest of the solver, as those of the
        # points.
        ancient(lambda wildcards: kernels_of(wildcards.get("group", wildcards.get("early")))),
    output:
        f"{RESULTS}/batches/{{group}}/{{batch}}.json",
    log:
        f"{RESULTS}/logs/solve_batch/{{group}}/{{batch}}.log",
    wildcard_constraints:
        group="|".join(group for group in PLAN.groups if group not in EARLY),
    conda:
        "../envs/microslip.yaml"
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 60 * attempt,
    params:
        requests=lambda wildcards: requests_of(wildcards.group, wildcards.batch),
        store=lambda wildcards, output: str(Path(output[0]).parents[2]),
        counter=COUNTER,
    script:
        "../scripts/solve_batch.py"


# The same for what takes long, so that it does not start when all else is done.
use rule solve_batch as solve_early_batch with:
    output:
        f"{RESULTS}/batches/{{early}}/{{batch}}.json",
    log:
        f"{RESULTS}/logs/solve_batch/{{early}}/{{batch}}.log",
    priority: 10
    params:
        requests=lambda wildcards: requests_of(wildcards.early, wildcards.batch),
        store=lambda wildcards, output: str(Path(output[0]).parents[2]),
        counter=COUNTER,
