"""Do sweeps survive?  Kills, signals and damage at random moments, each followed by a re-run.

    python benchmarks/faults.py [--rounds N] [--seed S] [--markdown FILE]

The project is copied to a temporary folder, and the sweeps of config/smoke.yaml are run there once
undisturbed.  In every round a random part of the results is removed; then Snakemake is killed, with
its jobs or alone, or gets SIGINT or SIGTERM, or files are damaged.  After one plain re-run (where
Snakemake says to unlock, that is done first) all files of the results but logs have to be those of
the undisturbed run, bit for bit, and no point that had been stored before a signal may be lost or
written again.  Processes are told apart as on Linux.  What a full or read-only disk does is tested
in tests/sweeps and tests/app.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from contextlib import suppress
from pathlib import Path

import psutil
import tables
from tqdm import tqdm

ROOT = Path(__file__).parent.parent
SAYS_UNLOCK = "can be removed with the --unlock argument"
UNREAD = ("warm_up", "logs")
"""Folders of results whose content nothing depends on."""
SIGNALS = {
    "SIGKILL, Snakemake and all its jobs": (signal.SIGKILL, True),
    "SIGKILL, Snakemake alone": (signal.SIGKILL, False),
    "SIGINT, as Ctrl-C": (signal.SIGINT, True),
    "SIGTERM": (signal.SIGTERM, False),
}
DAMAGE = "a few files damaged"


class Project:
    """A copy of the project, and the results of its runs."""

    def __init__(self, folder):
        self.folder, self.results = folder, folder / "results" / "smoke"
        listed = subprocess.check_output(["git", "ls-files"], cwd=ROOT, text=True)
        for name in filter(None, listed.split("\n")):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, folder / name)

    def start(self, *arguments):
        """Snakemake at work, in a session of its own so that all its processes can be told."""
        command = [sys.executable, "-m", "snakemake", "-j2", "--configfile", "config/smoke.yaml"]
        with open(self.folder.parent / "said", "wb") as out:
            return subprocess.Popen(
                [*command, *arguments],
                cwd=self.folder,
                env={"PATH": "/usr/bin:/bin", "HOME": os.environ.get("HOME", "/")},
                stdin=subprocess.DEVNULL,
                stdout=out,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )

    def run(self, *arguments):
        """Run Snakemake to its end, after --unlock where it asks for that; what it said if it
        failed, else empty."""
        running = self.start(*arguments)
        wait_for_all(running)
        said = (self.folder.parent / "said").read_text("utf-8", "replace")
        if running.returncode and SAYS_UNLOCK in " ".join(said.split()) and not arguments:
            return self.run("--unlock") or self.run()
        return said if running.returncode else ""

    def files(self):
        """All results by name; not logs, files that were set aside and halves of files."""
        return {
            path.relative_to(self.results).as_posix(): path
            for path in sorted(self.results.rglob("*"))
            if path.is_file() and path.suffix not in (".damaged", ".part")
            if path.name != ".again"  # which is another one after each run
            if path.relative_to(self.results).parts[0] not in UNREAD
        }

    def digests(self):
        """SHA-256 of all results by name."""
        found = self.files().items()
        return {name: hashlib.sha256(path.read_bytes()).hexdigest() for name, path in found}

    def stored(self):
        """Points and single runs that are there, each with what changes when it is rewritten."""
        found = self.files().items()
        kept = {n: path.stat() for n, path in found if n.startswith(("points/", "histories/"))}
        return {name: (about.st_ino, about.st_mtime_ns) for name, about in kept.items()}


def processes(running):
    """Numbers of the processes of its session that still run."""
    for process in psutil.process_iter():
        with suppress(ProcessLookupError, psutil.NoSuchProcess):
            same = os.getsid(process.pid) == running.pid
            if same and process.status() != psutil.STATUS_ZOMBIE:
                yield process.pid


def wait_for_all(running):
    running.wait()
    while any(processes(running)):
        time.sleep(0.1)


def damage(path, rng):
    """Truncate or empty a file, flip a bit of it, or write something else into it."""
    whole = path.read_bytes()
    flipped = bytearray(whole or b"\0")
    flipped[rng.randrange(len(flipped))] ^= 1 << rng.randrange(8)
    short = whole[: rng.randrange(max(1, len(whole)))]
    path.write_bytes(rng.choice([short, b"", bytes(flipped), rng.randbytes(5000)]))


def round_of(project, fault, reference, seconds, rng):
    """Findings after one fault: a list of sentences, empty if all is as it was."""
    chosen = rng.choice([1.0, 0.5, 0.2])
    for path in project.files().values():
        if rng.random() < chosen:
            path.unlink()
    before, findings = project.stored(), []
    if fault == DAMAGE:
        files = list(project.files().values())
        for path in rng.sample(files, min(3, len(files))):
            damage(path, rng)
    else:
        number, everybody = SIGNALS[fault]
        running = project.start()
        time.sleep(rng.uniform(0.0, chosen * seconds))
        for pid in list(processes(running)) if everybody else [running.pid]:
            with suppress(ProcessLookupError):
                os.kill(pid, number)
        wait_for_all(running)
        after = project.stored()
        findings += [f"lost or written again: {n}" for n in before if after.get(n) != before[n]]
    said = project.run()
    findings += [f"the plain re-run failed: {said[-2000:]}"] if said else []
    found = project.digests()
    names = sorted(found.keys() | reference.keys())
    return findings + [f"not as it was: {n}" for n in names if found.get(n) != reference.get(n)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--rounds", type=int, default=20, help="of each kind of fault")
    parser.add_argument("--seed", type=int, default=1)
    tables.add_markdown(parser)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="faults-") as folder:
        project = Project(Path(folder, "project"))
        for _ in range(2):  # the first one compiles
            shutil.rmtree(project.results, ignore_errors=True)
            started = time.perf_counter()
            if said := project.run():
                sys.exit(f"the undisturbed run failed:\n{said}")
        seconds, reference = time.perf_counter() - started, project.digests()
        rows, all_found = [], []
        for fault in (*SIGNALS, DAMAGE):
            found = []
            for index in tqdm(range(options.rounds), desc=fault):
                rng = random.Random(f"{options.seed} {fault} {index}")
                found += round_of(project, fault, reference, seconds, rng)
            rows.append({"fault": fault, "times": options.rounds, "findings": len(found) or "none"})
            all_found += [f"- {fault}: {one}" for one in found]
    tables.publish("\n".join([tables.markdown(rows), "", *all_found]), options)
    return int(bool(all_found))


if __name__ == "__main__":
    sys.exit(main())
