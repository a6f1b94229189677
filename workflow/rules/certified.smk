# Certified maps: rounds of points, each chosen by the answers of those before it.

from itertools import count

from microslip.sweeps import map_rounds

CERTIFIED = CONFIGURATION.certified
ROUNDS = f"{RESULTS}/rounds/{{certified}}/{{chosen}}"


def round_files(name):
    """Files of the rounds of a map, one by one; Snakemake goes on here when the next is there."""
    if STORED_ELSEWHERE:
        sys.exit(f"Error in {ORIGIN}: {name} needs a folder of results on this machine")
    for number in count():
        path = f"{placed(PLAN.rounds_folder(name))}/{number}.json"
        if workflow.is_main_process:
            chosen = os.path.basename(PLAN.rounds_folder(name))
            checkpoints.next_round.get(certified=name, chosen=chosen, round=number)
        yield path


def answered_rounds(name, most):
    """Files of the rounds of a map that have points, `most` of them at most; and of the batches
    that answer them."""
    rounds, batches_there = [], []
    for number, path in zip(range(most), round_files(name)):
        parts = map_rounds.read_round(path)["parts"]
        if not parts:
            break
        folder = f"{RESULTS}/{PLAN.rounds_folder(name)}"
        rounds.append(f"{folder}/{number}.json")
        batches_there += [f"{folder}/{number}-{part}.json" for part in range(parts)]
    return {"rounds": rounds, "batches": batches_there}


def all_rounds(wildcards):
    """All that a map is made of."""
    look_after(f"{wildcards.certified}.nc")
    return answered_rounds(wildcards.certified, map_rounds.MOST_ROUNDS)


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
        ancient(rules.warm_up.output),
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
        store=PLACE,
        counter=COUNTER,
    script:
        "../scripts/solve_round.py"


rule collect_certified:
    input:
        unpack(all_rounds),
    output:
        # The old one stays until the new one is whole, whatever happens to the job.
        kept(f"{RESULTS}/{{certified}}.nc"),
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
