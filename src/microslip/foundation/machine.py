"""Description of the computer, stored with measured times."""

from __future__ import annotations

import functools
import os
import platform
import subprocess
from pathlib import Path

CPU_LIST = Path("/proc/cpuinfo")
"""File in which Linux describes the processors."""


@functools.cache
def cpu_model() -> str:
    """Model name of the processor, such as "AMD EPYC 7B13", or the architecture if the model is
    unknown."""
    named = _from_linux() or _from_macos() or platform.processor() or platform.machine()
    return " ".join(named.split()) or "unknown"


def describe() -> dict[str, str | int]:
    """Processor (cpu), name of the computer (host), and number of threads that a linear algebra
    call may use (threads)."""
    return {"cpu": cpu_model(), "host": platform.node(), "threads": _threads()}


def _from_linux() -> str:
    try:
        lines = CPU_LIST.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return ""
    return next((line.partition(":")[2] for line in lines if line.startswith("model name")), "")


def _from_macos() -> str:
    if platform.system() != "Darwin":
        return ""
    command = ["sysctl", "-n", "machdep.cpu.brand_string"]
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout


def _threads() -> int:
    for name in (
        "OPENBLAS_NUM_THREADS",
        "OMP_NUM_THREADS",
    ):  # the first variable that is set determines the number
        value = os.environ.get(name, "")
        if value.isdigit() and int(value) > 0:
            return int(value)
    return os.cpu_count() or 1
