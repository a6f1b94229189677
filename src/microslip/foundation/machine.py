"""Description of the computer, stored with measured times."""

from __future__ import annotations

import functools
import os
import platform
from contextlib import suppress
from pathlib import Path

CPU_LIST = Path("/proc/cpuinfo")
"""File in which Linux describes the processors."""


@functools.cache
def cpu_model() -> str:
    """Return the model name of the processor, such as "AMD EPYC 7B13", or the architecture if the
    model is unknown."""
    lines = []
    with suppress(OSError):
        lines = CPU_LIST.read_text(encoding="utf-8", errors="replace").splitlines()
    named = next((line.partition(":")[2] for line in lines if line.startswith("model name")), "")
    return " ".join((named or platform.processor() or platform.machine()).split()) or "unknown"


def describe() -> dict[str, str | int]:
    """Return the processor (cpu), the name of the computer (host), and the number of threads that a
    linear algebra call may use (threads)."""
    variables = (os.environ.get(f"{name}_NUM_THREADS", "") for name in ("OPENBLAS", "OMP"))
    threads = next((int(text) for text in variables if text.isdigit() and int(text)), None)
    host, count = platform.node(), threads or os.cpu_count() or 1
    return {"cpu": cpu_model(), "host": host, "threads": count}
