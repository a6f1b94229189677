"""Measure time and memory of the workflow for a sweep of very many cheap points.

Run ``python benchmarks/growth.py --points 100000 --markdown docs/measured/growth.md``. The steady
bore has closed forms, so nearly all time is spent in the workflow. The table covers planning,
storing and collecting, a run with nothing to do, and a run with one more value on an axis.
"""

import re
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import tables
import xarray as xr
import yaml

ROOT = Path(__file__).resolve().parent.parent
VELOCITIES = 1000


def configuration(points, per_job, more=0):
    """Return the configuration of a steady bore, with `more` additional Poisson's ratios."""
    ratios = -(-points // VELOCITIES)
    poisson = [round(0.5 * k / ratios, 9) for k in range(ratios + more)]
    velocity = {"log": [0.01, 100, VELOCITIES]}
    sweep = {"motion": "continuous-bore", "velocity": velocity, "poisson": poisson}
    curves = {"kind": "curves", "sweep": "continuous_bore"}
    return {
        "sweeps": {"continuous_bore": sweep},
        "figures": {"curves": curves},
        "points_per_job": per_job,
    }


class Project:
    """The workflow of this repository in a separate folder."""

    def __init__(self, folder):
        self.folder = Path(folder)

    def snakemake(self, *arguments):
        """Run the workflow on two cores. Return output, seconds, and peak process memory in MB."""
        command = [sys.executable, "-m", "snakemake", "-s", ROOT / "Snakefile", "-j2"]
        command += ["--workflow-profile", ROOT / "profiles/default", "--configfile", "many.yaml"]
        began = time.perf_counter()
        process = subprocess.run(
            [*command, *arguments], cwd=self.folder, capture_output=True, text=True, check=False
        )
        seconds = time.perf_counter() - began
        output = process.stdout + process.stderr
        if process.returncode:
            sys.exit(output)
        largest = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
        return output, seconds, largest

    def computed(self):
        """Return the number of points computed in the last run, from the logs of all jobs."""
        logs = self.folder.glob("results/logs/**/*.log")
        return sum(int(n) for log in logs for n in re.findall(r"(\d+) computed", log.read_text()))


def measure(points, per_job):
    """Return the rows (quantity, value) of the table."""
    with tempfile.TemporaryDirectory() as folder:
        project = Project(folder)
        write = Path(folder, "many.yaml").write_text
        write(yaml.safe_dump(configuration(points, per_job)))
        rows = [("points", f"{points:,}"), ("points a job", f"{per_job:,}")]
        _, seconds, largest = project.snakemake("--dry-run")
        rows.append(("planning (dry run), s", f"{seconds:.1f}"))
        rows.append(("largest memory while planning, MB", f"{largest:.0f}"))
        _, seconds, largest = project.snakemake()
        rows.append(("all points, dataset and figures, s", f"{seconds:.0f}"))
        rows.append(("largest memory of a process in that run, MB", f"{largest:.0f}"))
        dataset = Path(folder, "results/continuous_bore.nc")
        with xr.open_dataset(dataset) as data:
            assert data.mu_macro.size == points and bool(data.converged.all())
        rows.append(("size of the dataset, MB", f"{dataset.stat().st_size / 1e6:.1f}"))
        output, seconds, _ = project.snakemake()
        assert "Nothing to be done" in output
        rows.append(("second run, nothing to do, s", f"{seconds:.1f}"))
        files = sum(path.is_file() for path in Path(folder, "results").rglob("*"))
        rows.append(("files in the results folder", f"{files:,}"))
        write(yaml.safe_dump(configuration(points, per_job, more=1)))
        for log in Path(folder).glob("results/logs/**/*.log"):
            log.unlink()
        _, seconds, _ = project.snakemake()
        rows.append(("one more Poisson's ratio: new points computed", f"{project.computed():,}"))
        rows.append(("this run with collecting, s", f"{seconds:.0f}"))
        return rows


def main():
    parser = tables.parser_of(__doc__)
    parser.add_argument("--points", type=int, default=100_000)
    parser.add_argument("--per-job", type=int, default=500)
    options = parser.parse_args()
    rows = measure(options.points, options.per_job)
    head = "# A sweep of many points\n\n`benchmarks/growth.py` made this table.\n\n"
    tables.publish(head + tables.measured(rows), options)


if __name__ == "__main__":
    main()
