# Certified maps: rounds of points, each chosen by the answers of those before it.

CERTIFIED = CONFIGURATION.certified
# Maps of drift are made with the sweeps of drives, whose kernels they need.
DRIFT = [name for name, map_ in CERTIFIED.items() if map_.force is not None]
CERTIFIED_AT_VELOCITIES = [name for name in CERTIFIED if name not in DRIFT]
DRIVEN = [*CONFIGURATION.drives, *DRIFT]
ROUNDS = f"{RESULTS}/rounds/{{certified}}/{{chosen}}"


checkpoint next_round:
    input:
        unpack(lambda wildcards: answered_rounds(wildcards.certified, int(wildcards.round))),
    output:
        f"{ROUNDS}/{{round}}.json",
    log:
        f"{RESULTS}/logs/next_round/{{certified}}/{{chosen}}/{{round}}.log",
    conda:
        "../envs/microslip.yaml"
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 10 * attempt,
    script:
        "../scripts/next_round.py"


rule solve_round:
    input:
        ancient(lambda wildcards: kernels_of(wildcards.certified)),
        round=f"{ROUNDS}/{{round}}.json",
    output:
        f"{ROUNDS}/{{round}}-{{part}}.json",
    log:
        f"{RESULTS}/logs/solve_round/{{certified}}/{{chosen}}/{{round}}-{{part}}.log",
    conda:
        "../envs/microslip.yaml"
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 60 * attempt,
    params:
        store=lambda wildcards, output: str(Path(output[0]).parents[3]),
        counter=COUNTER,
    script:
        "../scripts/solve_round.py"


rule collect_certified:
    input:
        unpack(all_rounds),
    output:
        # The old one stays until the new one is whole, whatever happens to the job.
        kept(f"{RESULTS}/{{certified}}.nc"),
        summary=report(
            kept(f"{RESULTS}/summaries/{{certified}}.html"),
            caption="../report/dataset.rst",
            category="Datasets",
            labels={"dataset": "{certified}.nc"},
        ),
    log:
        f"{RESULTS}/logs/collect_certified/{{certified}}.log",
    conda:
        "../envs/microslip.yaml"
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 10 * attempt,
    params:
        made_of=lambda wildcards: PLAN.fingerprint_of(f"{wildcards.certified}.nc"),
        code=lambda wildcards: PLAN.code_of(f"{wildcards.certified}.nc"),
    script:
        "../scripts/collect_certified.py"
