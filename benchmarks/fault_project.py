"""A copy of the project that faults are done to, and what is found in it afterwards."""

from __future__ import annotations

import hashlib
import os
import shutil
import signal
import subprocess
import sys
import time
from contextlib import contextmanager, suppress
from pathlib import Path

import psutil

ROOT = Path(__file__).parent.parent
CONFIGURATION = "config/smoke.yaml"
RESULTS = "results/smoke"
SAYS_UNLOCK = "can be removed with the --unlock argument"
GROUPS = ("points", "batches", "histories", "datasets", "summaries", "figures", "seals")
GROUPS += ("warm_up", "logs")
UNREAD = ("warm_up", "logs")
"""Groups of results, and those of them whose content nothing depends on."""
OLD = 7200.0
"""Seconds after which nobody takes a half written file for one that is being written."""


class Run:
    """Snakemake at work, in a session of its own so that all its processes can be told."""

    all = []

    def __init__(self, project, *arguments):
        self.all.append(self)
        self.said_to = project.folder.parent / f"{project.folder.name}.{time.time_ns()}.out"
        with open(self.said_to, "wb") as out:
            self.process = subprocess.Popen(
                [sys.executable, "-m", "snakemake", "--configfile", CONFIGURATION, *arguments],
                cwd=project.folder,
                # Nothing of this environment takes part, and no bytecode is written by the way.
                env={"PATH": "/usr/bin:/bin", "HOME": os.environ.get("HOME", "/")},
                stdin=subprocess.DEVNULL,
                stdout=out,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )

    def ended_within(self, seconds):
        """Wait that long at most; whether the main process is done."""
        try:
            self.process.wait(seconds)
            return True
        except subprocess.TimeoutExpired:
            return False

    def signal(self, number, everybody):
        """Send a signal to the main process alone or to all that it started."""
        for pid in self.alive() if everybody else [self.process.pid]:
            with suppress(ProcessLookupError):
                os.kill(pid, number)

    def kill(self, everybody):
        """Kill -9, of the main process alone or of all that it started too."""
        self.signal(signal.SIGKILL, everybody)
        self.process.wait()
        while everybody and self.alive():  # one may have been about to start another
            self.signal(signal.SIGKILL, True)
            time.sleep(0.01)

    def alive(self):
        """Numbers of the processes of this session that still run."""
        return [pid for pid in psutil.pids() if self._holds(pid)]

    def _holds(self, pid):
        try:
            if os.getsid(pid) != self.process.pid:
                return False
            return psutil.Process(pid).status() != psutil.STATUS_ZOMBIE
        except (ProcessLookupError, psutil.NoSuchProcess):
            return False

    def wait_for_all(self):
        """Until the main process and what it may have left behind are done."""
        self.process.wait()
        while self.alive():
            time.sleep(0.1)
        return self

    @classmethod
    def end(cls):
        """Kill whatever still runs."""
        for run in cls.all:
            run.kill(everybody=True)

    @property
    def said(self):
        return self.said_to.read_text("utf-8", "replace")


class Project:
    """The files of the project in a folder, compiled or not, and the results of its runs."""

    def __init__(self, folder, like=None):
        """folder: to be made. like: a Project to copy with what it compiled, but no results."""
        self.folder = Path(folder)
        if like is not None:
            spare = shutil.ignore_patterns("results", ".snakemake")
            shutil.copytree(like.folder, self.folder, ignore=spare, dirs_exist_ok=True)
            return
        listed = subprocess.run(
            ["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True
        )
        for name in filter(None, listed.stdout.split("\0")):
            if (ROOT / name).is_file():
                (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(ROOT / name, self.folder / name)

    @property
    def results(self):
        return self.folder / RESULTS

    def start(self):
        return Run(self, "-j2")

    def rerun(self, unlocks):
        """A plain run to its end; where it says to unlock, that is done and appended to unlocks."""
        run = self.start().wait_for_all()
        while run.process.returncode and SAYS_UNLOCK in " ".join(run.said.split()):
            self.unlock(unlocks)
            run = self.start().wait_for_all()
        return run

    def locked(self):
        return any((self.folder / ".snakemake" / "locks").glob("*"))

    def unlock(self, unlocks):
        run = Run(self, "--unlock").wait_for_all()
        if run.process.returncode:
            raise RuntimeError(f"--unlock failed:\n{run.said}")
        unlocks.append(1)

    def files(self):
        """All results: {name: Path}; not logs and marks, files set aside and halves of files."""
        return {
            str(path.relative_to(self.results)): path
            for path in sorted(self.results.rglob("*"))
            if path.is_file()
            and path.suffix not in (".damaged", ".part")
            and path.relative_to(self.results).parts[0] not in UNREAD
        }

    def digests(self):
        """SHA-256 of all results: {name: hex digits}."""
        return {
            name: hashlib.sha256(path.read_bytes()).hexdigest()
            for name, path in self.files().items()
        }

    def stored(self):
        """Points and single runs that are there, each with what changes when it is rewritten."""
        found = {}
        for name, path in self.files().items():
            if name.split("/")[0] in ("points", "histories"):
                at = path.stat()
                found[name] = (at.st_ino, at.st_mtime_ns)
        return found

    def halves(self):
        """Files that a kill left half written."""
        return list(self.results.rglob(".*.part"))

    def take_aside(self):
        """Remove the files that were set aside; their number."""
        found = list(self.results.rglob("*.damaged"))
        for path in found:
            path.unlink()
        return len(found)

    def remove(self, *groups):
        """Remove all results of some groups, such as "datasets"."""
        for name, path in self.files().items():
            if group_of(name) in groups:
                path.unlink()


def group_of(name):
    """What a file is among the results: a name of GROUPS."""
    path = Path(name)
    if path.suffix == ".sha256":
        return "seals"
    if path.suffix == ".nc":
        return "datasets"
    return path.parts[0]


def age(paths):
    """Make files look as if nobody had written to them for long."""
    then = time.time() - OLD
    for path in paths:
        os.utime(path, (then, then))


def damage(path, rng):
    """Do something to a file; what was done."""
    whole = path.read_bytes()
    how = rng.choice(["truncated", "emptied", "a bit flipped", "garbage"])
    if how == "truncated":
        content = whole[: rng.randrange(max(1, len(whole)))]
    elif how == "a bit flipped" and whole:
        at = rng.randrange(len(whole))
        content = whole[:at] + bytes([whole[at] ^ 1 << rng.randrange(8)]) + whole[at + 1 :]
    elif how == "garbage":
        content = rng.randbytes(rng.choice([7, len(whole), 5000]))
    else:
        content = b""
    at = path.stat()
    path.write_bytes(content)
    if rng.random() < 0.5:  # as a failing disk does it
        os.utime(path, ns=(at.st_atime_ns, at.st_mtime_ns))
    return how


@contextmanager
def disk(folder, kib):
    """A disk of its own in the place of a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    options = f"size={kib}k,nr_inodes=100k"
    subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", folder], check=True)
    try:
        yield lambda option: subprocess.run(
            ["mount", "-o", f"remount,{option}", folder], capture_output=True
        )
    except BaseException:
        Run.end()
        raise
    finally:
        subprocess.run(["umount", folder], check=True)


def used(folder):
    """KiB that the files of a folder take on a disk of that kind."""
    return sum(-(-p.stat().st_size // 4096) * 4 for p in folder.rglob("*") if p.is_file())
