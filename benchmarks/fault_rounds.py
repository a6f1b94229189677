"""Faults, one function a kind: do it, run again, say what was found.

A round gets a Bench and a random.Random of its own and returns a dict: what it did, counted, and
`findings`, a list of sentences, empty if nothing was lost, stale or unequal.
"""

from __future__ import annotations

import re
import shutil
import signal
import time
from dataclasses import dataclass

from fault_project import GROUPS, SAYS_UNLOCK, UNREAD, Project, age, damage, disk, group_of, used

# What is removed before a round, and how much of a whole run is then left to do.
WIPES = {
    "all": (lambda name, rng: True, 1.0),
    "half of the points": (
        lambda name, rng: group_of(name) != "points" or rng.random() < 0.5,
        1.0,
    ),
    "batches and datasets": (lambda name, rng: group_of(name) in ("batches", "datasets"), 0.8),
    "datasets": (lambda name, rng: group_of(name) == "datasets", 0.5),
    "some figures": (lambda name, rng: group_of(name) == "figures" and rng.random() < 0.5, 0.4),
}
ADVICE = re.compile(r"cannot (write|write to|read|use) \S+: [^;\n]+; make room or set permissions")
SYSTEM = re.compile(r"(No space left on device|Read-only file system)[^\n]*\S*/\S+")
"""What the package says when it cannot write, and what Snakemake says itself: it names the file."""
BARE = re.compile(r'^(  File "|Traceback|\w*(Error|Exception)\b.*\[Errno)')


@dataclass
class Bench:
    """The project that faults are done to, and what an undisturbed run makes of it."""

    project: Project
    reference: dict
    seconds: float
    """An undisturbed run takes that long."""

    def compare(self, findings, but=()):
        """Add to findings what differs from the reference; but: groups that may."""
        found = self.project.digests()
        for name in sorted(found.keys() | self.reference.keys()):
            if group_of(name) in but or found.get(name) == self.reference.get(name):
                continue
            how = "missing" if name not in found else "unequal" if name in self.reference else "new"
            findings.append(f"{how} after a plain re-run: {name}")

    def rerun(self, findings, unlocks):
        """A plain re-run; it has to succeed."""
        run = self.project.rerun(unlocks)
        if run.process.returncode:
            findings.append(f"the plain re-run failed:\n{run.said[-2000:]}")
        return run


def wipe(project, rng):
    """Remove something at random; what, and the part of a whole run that is left to do."""
    what = rng.choice(list(WIPES))
    chosen, part = WIPES[what]
    for name, path in project.files().items():
        if chosen(name, rng):
            path.unlink()
    return what, part


def kills(bench, rng, most=12):
    """Kill -9 a few times in a row at random moments, then run again."""
    project, findings, unlocks = bench.project, [], []
    what, part = wipe(project, rng)
    done = {"wiped": what, "alone": 0, "all": 0, "twice": 0}
    before, shared, runs = project.stored(), False, []
    for _ in range(rng.randint(2, most)):
        if project.locked():  # the last re-run of a round waits until it is told
            project.unlock(unlocks)
        runs.append(run := project.start())
        if run.ended_within(rng.uniform(0.0, part * bench.seconds)):
            if run.process.returncode:
                findings.append(f"a run that was to be killed failed:\n{run.said[-2000:]}")
                break
            _, part = wipe(project, rng)  # it was done before; there has to be more to do
            before = project.stored()
            continue
        everybody = rng.random() < 0.5
        run.kill(everybody)
        done["all" if everybody else "alone"] += 1
        survived(before, project.stored(), shared, findings, done)
        # What the main process left at work goes on, now and then beside the next run.
        if rng.random() < 0.5:
            run.wait_for_all()
        shared = any(one.alive() for one in runs)
        before = project.stored()
    halves = [] if any(one.alive() for one in runs) else project.halves()
    aged = halves if rng.random() < 0.5 else []
    age(aged)
    again = bench.rerun(findings, unlocks)
    for one in runs:
        one.wait_for_all()
    survived(before, project.stored(), shared, findings, done)
    if "Nothing to be done" not in again.said:
        findings += [f"left half written: {path.name}" for path in aged if path.exists()]
    bench.compare(findings)
    done |= {"unlocks": len(unlocks), "halves": len(halves), "cleared": len(aged)}
    for path in project.halves():
        path.unlink()
    return done | {"aside": project.take_aside(), "findings": findings}


def survived(before, after, shared, findings, done):
    """What was stored before is there, and nobody wrote it again.

    shared: processes of an earlier run were at work beside a later one, and a point that both had
    begun is computed by both: that is counted, and no finding.
    """
    for name, identity in before.items():
        if name not in after:
            findings.append(f"lost: {name}")
        elif after[name] != identity:
            done["twice"] += 1
            if not shared:
                findings.append(f"computed again: {name}")


def interruption(bench, rng):
    """SIGINT to all or SIGTERM to the main process at a random moment, then run again."""
    project, findings, unlocks = bench.project, [], []
    what, part = wipe(project, rng)
    before = project.stored()
    number = rng.choice([signal.SIGINT, signal.SIGTERM])
    run = project.start()
    ended = run.ended_within(rng.uniform(0.0, part * bench.seconds))
    if not ended:
        run.signal(number, everybody=number == signal.SIGINT)
    run.wait_for_all()
    survived(before, project.stored(), False, findings, {"twice": 0})
    before = project.stored()
    bench.rerun(findings, unlocks)
    survived(before, project.stored(), False, findings, {"twice": 0})
    bench.compare(findings)
    done = {"wiped": what, "signal": number.name, "hit": not ended, "unlocks": len(unlocks)}
    return done | {"aside": project.take_aside(), "findings": findings}


def corruption(bench, rng):
    """Damage a file or a few, remove the datasets or not, run again once."""
    project, findings, unlocks, done = bench.project, [], [], []
    for _ in range(rng.randint(1, 3)):
        group = rng.choices(GROUPS, [1 if group in UNREAD else 3 for group in GROUPS])[0]
        where = project.results
        if group in UNREAD:
            files = [p for p in sorted((where / group).rglob("*")) if p.is_file()]
        else:
            files = [path for name, path in project.files().items() if group_of(name) == group]
        path = rng.choice(files)
        done.append([str(path.relative_to(where)), group, damage(path, rng)])
    removed = rng.random() < 0.5
    if removed:
        project.remove("datasets")
    bench.rerun(findings, unlocks)
    # Nobody has read a point that no dataset was made from since. Where it is needed its damage is
    # seen. An index file only has to be there; its content is the same again when it is made again.
    groups = {group for _, group, _ in done}
    kept = groups & ({"batches"} if removed else {"batches", "points", "histories"})
    bench.compare(findings, but=kept)
    if kept:
        project.remove("datasets", *(groups & {"batches"}))
        bench.rerun(findings, unlocks)
        bench.compare(findings)
    if unlocks:
        findings.append("locked, though nothing was killed")
    done = {"damage": done, "removed": removed, "unlocks": len(unlocks)}
    return done | {"aside": project.take_aside(), "findings": findings}


def pair(bench, rng):
    """Two runs at once from nothing: in one folder, or of two projects with one results folder."""
    project, findings, unlocks = bench.project, [], []
    shutil.rmtree(project.results)
    other, apart = project, rng.random() < 0.5
    if apart:
        other = Project(project.folder.with_name("other"), like=project)
        (other.folder / "results").symlink_to(project.folder / "results")
        project.results.mkdir()
    one = project.start()
    offset = 0.0 if rng.random() < 0.5 else rng.uniform(0.0, 0.8 * bench.seconds)
    one.ended_within(offset)
    two = other.start()
    codes = [run.wait_for_all().process.returncode for run in (one, two)]
    for run in (one, two):
        clear = SAYS_UNLOCK in " ".join(run.said.split()) or not run.process.returncode
        if not clear and not (apart and told(run.said)):
            findings.append(f"one of two runs said nothing useful:\n{run.said[-2000:]}")
    bench.rerun(findings, unlocks)
    bench.compare(findings)
    if unlocks:
        findings.append("locked after both had ended")
    if apart:
        shutil.rmtree(other.folder)
    done = {"projects": 1 + apart, "failed": sum(map(bool, codes)), "unlocks": len(unlocks)}
    return done | {"aside": project.take_aside(), "findings": findings}


def told(said):
    """Whether the last words say what is wrong, and not where in the source it was noticed."""
    lines = re.split(r"[\r\n]+", said)
    lines = [line for line in lines if line.strip() and not line.startswith("points:")]
    return bool(lines) and not BARE.search(lines[-1])


def full_disk(bench, rng):
    """The disk fills while a run goes on: that of the results, or of the whole project."""
    findings, unlocks, whole = [], [], rng.random() < 0.5
    need = used(bench.project.results)
    folder = bench.project.folder.with_name("small")
    room = int(rng.uniform(0.02, 0.95) * need)
    with disk(folder if whole else folder / "results", 10**6 if whole else room) as change:
        project = Project(folder, like=bench.project)
        if whole:
            change(f"size={used(folder) + room}k")
        done = {"whole": whole, "failed": failed_well(project.start(), findings)}
        change("size=4g")
        done["aside"] = settled(bench, project, findings, unlocks)
    shutil.rmtree(folder)
    return done | {"unlocks": len(unlocks), "findings": findings}


def read_only(bench, rng):
    """The results become read-only before a run or at some moment of it."""
    findings, unlocks = [], []
    folder = bench.project.folder.with_name("small")
    with disk(folder / "results", 10**6) as change:
        project = Project(folder, like=bench.project)
        begun = rng.random() < 0.6
        if begun:
            run = project.start()
            run.ended_within(rng.uniform(0.1, 0.8) * bench.seconds)
            # The system waits until nobody has a file open for writing.
            while change("ro").returncode:
                time.sleep(0.002)
        else:
            change("ro")
            run = project.start()
        done = {"begun": begun, "failed": failed_well(run, findings)}
        change("rw")
        done["aside"] = settled(bench, project, findings, unlocks)
    shutil.rmtree(folder)
    return done | {"unlocks": len(unlocks), "findings": findings}


def failed_well(run, findings):
    """Whether a run failed; if it did, the last words have to help."""
    run.wait_for_all()
    if not run.process.returncode:
        return False
    if not (ADVICE.search(run.said) or SYSTEM.search(run.said)):
        findings.append(f"no message that names a file:\n{run.said[-2000:]}")
    elif not told(run.said):
        findings.append(f"the last word is a traceback:\n{run.said[-2000:]}")
    return True


def settled(bench, project, findings, unlocks):
    """A plain re-run in another project leads to the same; the number of files set aside."""
    elsewhere = Bench(project, bench.reference, bench.seconds)
    elsewhere.rerun(findings, unlocks)
    elsewhere.compare(findings)
    return project.take_aside()
