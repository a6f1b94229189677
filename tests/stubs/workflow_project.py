"""A copy of the project in a folder of its own, for runs of Snakemake and edits."""

import json
import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest
import yaml

from microslip.foundation import compiled

ROOT = Path(__file__).parents[2]
SNAKEMAKE = Path(sys.executable).with_name("snakemake")
# Copies with the same sources use the compiled code of this process.
ENVIRONMENT = {
    "PATH": "/usr/bin:/bin",
    "HOME": os.environ.get("HOME", str(ROOT)),
    "NUMBA_CACHE_DIR": str(compiled.FOLDER.parent),
}
COMPILED = shutil.ignore_patterns("compiled-*")
RUN = ["-j2", "--configfile", "tiny.yaml"]

# Closed forms and the rigid model, whose points are cheap.
AXES = {"velocity": [0.5, 2], "amplitude": [0, 1], "model": "rigid", "tolerance": 1e-2}
TINY = {
    "sweeps": {
        "transverse": {"motion": "transverse", **AXES},
        "bore": {"motion": "bore", **AXES},
        "continuous_bore": {
            "motion": "continuous-bore",
            **{name: AXES[name] for name in ("velocity", "model", "tolerance")},
        },
    },
    "figures": {
        "fig1_force_history": {"kind": "history", "sweep": "transverse", "periods": 1}
        | {"cells": 4, "steps": 16},
        "fig2_transverse_map": {"kind": "map", "sweep": "transverse"},
        "fig3_traction_field": {"kind": "field", "sweep": "continuous_bore", "cells": 4},
        "fig4_continuous_bore": {"kind": "curves", "sweep": "continuous_bore"},
        "fig5_transients": {"kind": "transients", "sweep": "continuous_bore", "travel": 1.0}
        | {"cells": 4, "steps": 16},
        "fig6_bore_map": {"kind": "map", "sweep": "bore"},
    },
    "points_per_job": 4,  # every job takes a second or two to start
}
"""Three sweeps of 4, 4 and 2 points, with 1 + 4 single runs."""
ALL_JOBS = {"solve_batch": 5, "make_products": 1, "all": 1}


def snakemake(arguments, folder, environment=ENVIRONMENT):
    """Result of Snakemake with these arguments in a folder, as from subprocess.run.

    The virtual environment is not activated: only the path of the executable is used.
    """
    return subprocess.run(
        [SNAKEMAKE, *arguments],
        cwd=folder,
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=900,
    )


def started(folder, *command):
    """Start a command as the leader of a session."""
    return subprocess.Popen(
        command,
        cwd=folder,
        env=ENVIRONMENT,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )


def is_alive(session):
    """True if a process of the session runs, or may not be looked at."""
    try:
        os.killpg(session, 0)
    except ProcessLookupError:
        return False
    return True


def wait_until(holds):
    """Return once holds() is true; the test fails after some minutes."""
    for _ in range(1000):
        if holds():
            return
        time.sleep(0.2)
    pytest.fail("it never happens")


def jobs_in(message):
    """Number of jobs by rule, from Snakemake's table before a run; {} if there is nothing to do."""
    table = re.search(r"^-+  -+\n(.*?)^total", message, re.MULTILINE | re.DOTALL)
    rows = table[1].split("\n")[:-1] if table else []
    return {name: int(count) for name, count in map(str.split, rows)}


class Project:
    """A copy of the project for runs and edits."""

    def __init__(self, folder):
        self.folder = folder
        for name in ("config", "profiles", "src", "workflow"):
            shutil.copytree(ROOT / name, folder / name, ignore=COMPILED)
        shutil.copy(ROOT / "Snakefile", folder)
        self.configure(TINY)

    @classmethod
    def at(cls, folder):
        """The existing project in a folder."""
        project = object.__new__(cls)
        project.folder = folder
        return project

    def copied(self, folder):
        """A copy of the project, including the files of earlier runs."""
        shutil.copytree(self.folder, folder, symlinks=True)
        return self.at(folder)

    def configure(self, configuration):
        (self.folder / "tiny.yaml").write_text(yaml.safe_dump(configuration))

    def snakemake(self, *arguments):
        return snakemake(arguments, self.folder)

    def started(self, *arguments):
        return started(self.folder, SNAKEMAKE, *arguments, *RUN)

    def run(self, *targets):
        done = self.snakemake(*targets, *RUN)
        assert done.returncode == 0, done.stderr
        return done.stdout + done.stderr

    def planned(self, *targets):
        """Number of jobs of a dry run, by rule; {} if there is nothing to do."""
        done = self.snakemake(*targets, *RUN, "--dry-run")
        assert done.returncode == 0, done.stderr
        return jobs_in(done.stdout)

    def records(self):
        """Records in all batch files, by key."""
        files = self.folder.glob("results/batches/*/*.jsonl")
        lines = [json.loads(line) for path in files for line in path.read_text().splitlines()[1:-1]]
        return {record["key"]: record for record in lines}

    def append(self, path, text):
        """Append text to an existing file."""
        with open(self.folder / path, "r+") as file:
            file.seek(0, os.SEEK_END)
            file.write(text)
