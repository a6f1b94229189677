"""Do sweeps survive?  Kills, damage, full disks and more, each followed by a plain re-run.

    python benchmarks/faults.py [--kills N] [--corruptions N] [--others N] [--quick] [--seed S]
                                [--output FILE] [--markdown FILE]

The project is copied to a temporary folder, and the sweeps of config/smoke.yaml are run there once
undisturbed.  Then come rounds of faults at random moments, in random files, from a random part of
the results:

- kills: SIGKILL to Snakemake with all its jobs, or to Snakemake alone, a few times in a row;
- corruptions: a result truncated, emptied, overwritten, or a bit of it flipped;
- others, N of each: SIGINT or SIGTERM; two runs started at once; a disk that fills; a folder that
  becomes read-only (the last two on a disk of their own in memory, which takes root to mount).

After each round comes one plain re-run (where Snakemake says to unlock, that is done and counted),
and all files of the results but logs have to be those of the undisturbed run, bit for bit:
datasets, figures, points, single runs, index files and checksums.  No point that had been stored
before a kill may be lost or written again.  On a full or read-only disk the run has to fail with a
message that names a file, and not with a traceback as its last word.

Rounds go to a file of JSON lines; a campaign that is interrupted goes on where it stopped.  It ends
with an error if anything was found.  Processes are told apart as on Linux.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import fault_rounds
import tables
from fault_project import Project, Run, group_of
from tqdm import tqdm

ROUNDS = {
    "kills": fault_rounds.kills,
    "read_only": fault_rounds.read_only,
    "full_disk": fault_rounds.full_disk,
    "pair": fault_rounds.pair,
    "corruption": fault_rounds.corruption,
    "interruption": fault_rounds.interruption,
}
NEEDS_ROOT = ("full_disk", "read_only")


def prepared(folder):
    """A Bench in a folder: the project, compiled, with the results of an undisturbed run."""
    project = Project(folder / "project")
    for name in ("compiling", "undisturbed"):
        print(f"a run for {name}..." if name == "compiling" else "the undisturbed run...")
        started = time.perf_counter()
        run = project.start().wait_for_all()
        if run.process.returncode:
            sys.exit(f"the {name} run failed:\n{run.said}")
        found = project.digests()
        if name == "compiling":
            first = found
            project.remove(*{group_of(path) for path in found})
    if found != first:
        sys.exit("two undisturbed runs differ")
    return fault_rounds.Bench(project, found, time.perf_counter() - started)


def weight(line):
    """Faults in a round."""
    if line["kind"] == "kills":
        return line["alone"] + line["all"]
    return len(line.get("damage", [1]))


def complete(wanted, lines):
    """Whether nothing is left to do."""
    done = dict.fromkeys(wanted, 0)
    for line in lines:
        if line["kind"] in done:
            done[line["kind"]] += weight(line)
    return all(done[kind] >= count for kind, count in wanted.items())


def campaign(bench, wanted, seed, lines, out):
    """Do the rounds that are not among `lines` yet; append them there and to the file `out`."""
    with tqdm(total=sum(wanted.values()), unit="fault") as bar:
        for kind, count in wanted.items():
            done = [line for line in lines if line["kind"] == kind]
            faults, index = sum(map(weight, done)), len(done)
            bar.update(min(faults, count))
            while faults < count:
                bar.set_description(kind)
                rng = random.Random(f"{seed} {kind} {index}")
                line = {"kind": kind, "index": index, "seed": seed}
                line |= ROUNDS[kind](bench, rng)
                lines.append(line)
                out.write(json.dumps(line) + "\n")
                out.flush()
                bar.update(min(weight(line), count - faults))
                faults, index = faults + weight(line), index + 1
                for finding in line["findings"]:
                    tqdm.write(f"{kind} {line['index']}: {finding}")


def damaged(how):
    """Counts in a round the files that were damaged in this way."""
    return lambda line: sum(done == how for _, _, done in line["damage"])


def summary(lines, rooted):
    """Markdown: how many faults of which kind, what it took to go on, what was found."""
    compared = next(line for line in reversed(lines) if line["kind"] == "compared")["files"]
    lines = [line for line in lines if line["kind"] in ROUNDS]
    rows = {
        "SIGKILL, Snakemake and all its jobs": ("kills", lambda line: line["all"]),
        "SIGKILL, Snakemake alone": ("kills", lambda line: line["alone"]),
        "SIGINT or SIGTERM": ("interruption", lambda line: int(line["hit"])),
        "a file truncated": ("corruption", damaged("truncated")),
        "a file emptied": ("corruption", damaged("emptied")),
        "a bit flipped": ("corruption", damaged("a bit flipped")),
        "a file overwritten": ("corruption", damaged("garbage")),
        "two runs at once in one folder": ("pair", lambda line: line["projects"] == 1),
        "two projects, one results folder": ("pair", lambda line: line["projects"] == 2),
        "the results' disk full": ("full_disk", lambda line: not line["whole"] and line["failed"]),
        "the project's disk full": ("full_disk", lambda line: line["whole"] and line["failed"]),
        "read-only from the start": (
            "read_only",
            lambda line: not line["begun"] and line["failed"],
        ),
        "read-only all at once": ("read_only", lambda line: line["begun"] and line["failed"]),
    }
    out = [
        "Faults done to the sweeps of `config/smoke.yaml`, and what a plain re-run made of it,"
        " by `benchmarks/faults.py`.\n",
        "| fault | times | findings |",
        "|---|---|---|",
    ]
    for name, (kind, count) in rows.items():
        of_kind = [line for line in lines if line["kind"] == kind]
        hit = [line for line in of_kind if count(line)]
        if kind in NEEDS_ROOT and not rooted and not of_kind:
            out.append(f"| {name} | skipped: mounting a disk takes root | |")
            continue
        findings = sum(len(line["findings"]) for line in hit)
        out.append(f"| {name} | {sum(int(count(line)) for line in hit)} | {findings or 'none'} |")

    def total(key):
        return sum(line.get(key, 0) for line in lines)

    found = [finding for line in lines for finding in line["findings"]]
    verdict = "**Nothing lost, nothing stale, equal bits.**"
    out += [
        f"\nAfter each of {len(lines)} rounds all files were compared with those of an undisturbed"
        " run by their SHA-256: "
        + ", ".join(f"{count} {group.replace('_', '-')}" for group, count in compared.items())
        + ".",
        "",
        f"- {total('unlocks')} times a lock of Snakemake's was left by a run that was killed; it"
        " says so, and that `--unlock` removes it.",
        f"- {total('aside')} damaged or half replaced files were noticed, set aside and made"
        " again.",
        f"- {total('halves')} half written files were left by kills; the {total('cleared')} of them"
        " that were made to look old were cleared by the next run.",
        "- Points and single runs stored before a kill: "
        + (f"{lost} lost, " if (lost := sum("lost: " in one for one in found)) else "none lost, ")
        + (f"{total('twice')} written by two jobs at once" if total("twice") else "none written")
        + (", one of them left over from a killed run." if total("twice") else " again."),
        "",
        verdict
        if not found
        else "**Findings:**\n\n" + "\n".join(f"- {one.splitlines()[0]}" for one in found),
    ]
    return "\n".join(out) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--corruptions", type=int, default=40)
    parser.add_argument("--others", type=int, default=8, help="rounds of each other kind")
    parser.add_argument("--quick", action="store_true", help="a few of each")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--output", type=Path, default=Path("results/faults.jsonl"))
    tables.add_markdown(parser)
    options = parser.parse_args()
    wanted = dict.fromkeys(ROUNDS, options.others)
    wanted |= {"kills": options.kills, "corruption": options.corruptions}
    if options.quick:
        wanted = {kind: min(2, count) for kind, count in wanted.items()}
    rooted = hasattr(os, "geteuid") and os.geteuid() == 0
    if not rooted:
        print("full and read-only disks are left out: mounting one takes root")
        wanted = {kind: n for kind, n in wanted.items() if kind not in NEEDS_ROOT}
    options.output.parent.mkdir(parents=True, exist_ok=True)
    lines = tables.parsed(options.output)
    if not complete(wanted, lines) or not any(line["kind"] == "compared" for line in lines):
        with tempfile.TemporaryDirectory(prefix="faults-") as folder:
            try:
                bench = prepared(Path(folder))
                with options.output.open("a", encoding="utf-8") as out:
                    counts = Counter(map(group_of, bench.reference))
                    lines.append({"kind": "compared", "files": counts})
                    out.write(("\n" if len(lines) > 1 else "") + json.dumps(lines[-1]) + "\n")
                    campaign(bench, wanted, options.seed, lines, out)
            finally:
                Run.end()
    tables.publish(summary(lines, rooted), options)
    return int(any(line.get("findings") for line in lines))


if __name__ == "__main__":
    sys.exit(main())
