"""Measure the explorer's size, and its opening time in Chromium from a local file, offline.

Run ``python benchmarks/explorer_opening.py results/explorer.html --markdown
docs/measured/explorer.md`` on the page of config/explorer.yaml. The page is opened each time in
a new profile without a cache. It counts as open when all charts are drawn and it reacts to a
click. ``--pictures docs/images`` saves pictures of the page and of its form for a real contact.
"""

import os
import shutil
import statistics
import tempfile
import time
from pathlib import Path

import tables
from playwright.sync_api import sync_playwright

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
FLAGS = ["--disable-gpu", "--disable-background-networking", "--no-first-run"]


def open_once(playwright, path, pictures=None):
    """Return wall time and CPU time (s) of the main thread, from the request to the last chart."""
    with tempfile.TemporaryDirectory() as profile:
        context = playwright.chromium.launch_persistent_context(
            profile, executable_path=CHROMIUM, args=FLAGS, viewport={"width": 1280, "height": 800}
        )
        page = context.new_page()
        session = context.new_cdp_session(page)
        session.send("Performance.enable", {"timeDomain": "threadTicks"})
        begun = time.perf_counter()
        page.goto(path.resolve().as_uri())
        page.locator("body[data-ready]").wait_for()
        wall = time.perf_counter() - begun
        metrics = session.send("Performance.getMetrics")["metrics"]
        if pictures is not None:
            page.screenshot(path=pictures / "explorer.png")
            page.locator("#ask").click()
            page.screenshot(path=pictures / "explorer_contact.png")
        context.close()
    return wall, next(m["value"] for m in metrics if m["name"] == "TaskDuration")


def main():
    parser = tables.parser_of(__doc__)
    parser.add_argument("page", type=Path)
    parser.add_argument("--times", type=int, default=9)
    parser.add_argument("--pictures", type=Path, help="folder for two pictures of the page")
    options = parser.parse_args()
    with sync_playwright() as playwright:
        wall, cpu = zip(
            *(open_once(playwright, options.page) for _ in range(options.times)), strict=True
        )
        if options.pictures is not None:
            open_once(playwright, options.page, options.pictures)
    rows = [
        ("size (MB), at most 15", f"{options.page.stat().st_size / 1e6:.1f}"),
        ("wall time (s), at most 3: median", f"{statistics.median(wall):.2f}"),
        ("wall time (s): smallest, largest", f"{min(wall):.2f}, {max(wall):.2f}"),
        ("load average of the machine meanwhile", f"{os.getloadavg()[0]:.1f}"),
        ("cores", f"{os.cpu_count()}"),
        ("CPU time of the page's thread (s): median", f"{statistics.median(cpu):.2f}"),
    ]
    by = "`benchmarks/explorer_opening.py`"
    head = f"{by} opened the explorer {options.times} times in Chromium."
    tables.publish(f"{head}\n\n{tables.measured(rows)}", options)


if __name__ == "__main__":
    main()
