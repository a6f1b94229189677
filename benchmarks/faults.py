"""Test sweeps with kills, signals and damaged files at random moments, and re-run them.

    python benchmarks/faults.py [--rounds N] [--seed S] [--only FAULT] [--markdown FILE]

The project is copied to a temporary folder, and the sweeps of config/smoke.yaml are run once
without a fault. Every round removes a random part of the results. Then Snakemake is killed (alone
or with its jobs) or receives SIGINT or SIGTERM, or files are damaged. The sweeps are run once more
without special options; the folder is unlocked first if Snakemake asks for it. If Snakemake alone
is killed, its jobs go on. In every other round, they end before the next run; in the others, they
run at the same time. The table counts the signals sent while a job was running. Afterwards all
datasets, figures and pages must be equal to those of the first run, bit for bit. Points stored
before a signal must not be lost or written again. If a run refuses a damaged dataset by name, the
dataset is removed before the next run. The search for processes works on Linux. Full and read-only
disks are tested in tests/sweeps and tests/app.
"""

from __future__ import annotations

import hashlib
import os
import random
import re
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
UNLOCK_MESSAGE = "can be removed with the --unlock argument"
IGNORED = "logs"
"""Folder of results that is not compared."""
SIGNALS = {
    "SIGKILL, Snakemake and all its jobs": (signal.SIGKILL, True),
    "SIGKILL, Snakemake alone": (signal.SIGKILL, False),
    "SIGINT, as Ctrl-C": (signal.SIGINT, True),
    "SIGTERM": (signal.SIGTERM, False),
}
DAMAGE = "a few files damaged"
REMOVE = "remove it and run again"
DATASET = re.compile(r"cannot read the dataset (\S+):")


class Project:
    """A copy of the project, and the results of its runs."""

    def __init__(self, folder):
        self.folder, self.results = folder, folder / "results" / "smoke"
        listed = subprocess.check_output(["git", "ls-files"], cwd=ROOT, text=True)
        for name in filter(None, listed.split("\n")):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, folder / name)

    def start(self, *arguments):
        """Start Snakemake in its own session, so that all its processes can be found."""
        command = [sys.executable, "-m", "snakemake", "-j2", "--configfile", "config/smoke.yaml"]
        with open(self.folder.parent / "output", "wb") as out:
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
        """Run Snakemake to its end, after --unlock if necessary.

        Returns its output if it failed, else an empty string.
        """
        running = self.start(*arguments)
        wait_for_all(running)
        output = (self.folder.parent / "output").read_text("utf-8", "replace")
        if running.returncode and UNLOCK_MESSAGE in " ".join(output.split()) and not arguments:
            return self.run("--unlock") or self.run()
        return output if running.returncode else ""

    def files(self):
        """Return all results by name, except logs, damaged files and incomplete files."""
        return {
            path.relative_to(self.results).as_posix(): path
            for path in sorted(self.results.rglob("*"))
            if path.is_file() and path.suffix not in (".damaged", ".part")
            if path.relative_to(self.results).parts[0] != IGNORED
        }

    def digests(self):
        """Return the SHA-256 of the datasets, figures and pages, keyed by plain name."""
        links = {name: path for name, path in self.files().items() if path.is_symlink()}
        return {name: hashlib.sha256(path.read_bytes()).hexdigest() for name, path in links.items()}

    def stored(self):
        """Return inode and modification time of each stored point and single run, keyed by name."""
        stats = {n: path.stat() for n, path in self.files().items() if is_batch(n)}
        return {name: (stat.st_ino, stat.st_mtime_ns) for name, stat in stats.items()}


def is_batch(name):
    """Return True for the name of a file of solved points or of single runs."""
    return name.startswith("batches/") and name.endswith(".jsonl")


def processes(running):
    """Yield the ids of the running processes in the session of a process."""
    for process in psutil.process_iter():
        with suppress(ProcessLookupError, psutil.NoSuchProcess):
            same = os.getsid(process.pid) == running.pid
            if same and process.status() != psutil.STATUS_ZOMBIE:
                yield process.pid


def wait_for_all(running):
    running.wait()
    while any(processes(running)):
        time.sleep(0.1)


def job_runs(running):
    """Return True if a script of a job is running in the session of a process."""
    for pid in processes(running):
        with suppress(psutil.Error):
            if any("/.snakemake/scripts/" in word for word in psutil.Process(pid).cmdline()):
                return True
    return False


def damage(path, rng):
    """Truncate a file, empty it, flip one bit, or replace its content."""
    whole = path.read_bytes()
    flipped = bytearray(whole or b"\0")
    flipped[rng.randrange(len(flipped))] ^= 1 << rng.randrange(8)
    short = whole[: rng.randrange(max(1, len(whole)))]
    path.write_bytes(rng.choice([short, b"", bytes(flipped), rng.randbytes(5000)]))


def round_of(project, fault, reference, seconds, rng, jobs_end_first):
    """Cause one fault, and run again.

    Returns a list of sentences, which is empty if no result has changed, and a bool: whether a job
    was running when the signal came.
    """
    chosen = rng.choice([1.0, 0.5, 0.2])
    for path in project.files().values():
        if rng.random() < chosen:
            path.unlink()
    before, findings, during = project.stored(), [], False
    if fault == DAMAGE:
        files = list(project.files().values())
        for path in rng.sample(files, min(3, len(files))):
            damage(path, rng)
    else:
        number, everybody = SIGNALS[fault]
        running = project.start()
        time.sleep(rng.uniform(0.0, chosen * seconds))
        during = running.poll() is None and job_runs(running)
        for pid in list(processes(running)) if everybody else [running.pid]:
            with suppress(ProcessLookupError):
                os.kill(pid, number)
        running.wait()
        if jobs_end_first or number != signal.SIGKILL:
            wait_for_all(running)
        after = project.stored()
        findings += [f"lost or written again: {n}" for n in before if after.get(n) != before[n]]
    output = project.run()
    if fault != DAMAGE:
        wait_for_all(running)
    elif REMOVE in output:  # the message names a dataset with a changed bit
        (project.folder / DATASET.search(output)[1]).unlink()
        output = project.run()
    findings += [f"the plain re-run failed: {output[-2000:]}"] if output else []
    digests = project.digests()
    names = sorted(digests.keys() | reference.keys())
    findings += [f"changed: {n}" for n in names if digests.get(n) != reference.get(n)]
    return findings, during


def main():
    parser = tables.parser_of(__doc__)
    parser.add_argument(
        "--rounds", type=int, default=20, help="number of rounds for each kind of fault"
    )
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", choices=[*SIGNALS, DAMAGE], help="one kind of fault")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="faults-") as folder:
        project = Project(Path(folder, "project"))
        for _ in range(2):  # the first run compiles
            shutil.rmtree(project.results, ignore_errors=True)
            started = time.perf_counter()
            if output := project.run():
                sys.exit(f"the run without a fault failed:\n{output}")
        seconds, reference = time.perf_counter() - started, project.digests()
        rows, all_findings = [], []
        for fault in [options.only] if options.only else (*SIGNALS, DAMAGE):
            findings, while_a_job_ran = [], 0
            for index in tqdm(range(options.rounds), desc=fault):
                rng = random.Random(f"{options.seed} {fault} {index}")
                round_findings, during = round_of(
                    project, fault, reference, seconds, rng, jobs_end_first=index % 2 == 0
                )
                findings += round_findings
                while_a_job_ran += during
            rows.append(
                {
                    "fault": fault,
                    "times": options.rounds,
                    "while a job ran": "-" if fault == DAMAGE else while_a_job_ran,
                    "findings": len(findings) or "none",
                }
            )
            all_findings += [f"- {fault}: {one}" for one in findings]
    tables.publish("\n".join([tables.markdown(rows), "", *all_findings]), options)
    return int(bool(all_findings))


if __name__ == "__main__":
    sys.exit(main())
