"""Display of the progress of a calculation on a terminal."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

FIRST, BETWEEN = 2.0, 1.0
"""Time, in seconds, until the progress is first shown, and time between two updates.  Most
calculations end earlier."""


@contextmanager
def progress(title: str, total: int | None = None) -> Iterator[Callable[[str], None]]:
    """Context manager that shows a title, the number of finished steps and the elapsed time.

    The context manager yields a function that counts a step and shows a string about this step.
    Nothing is shown if standard error is not a terminal.
    """
    if not sys.stderr.isatty():
        yield lambda text: None
        return
    from tqdm import tqdm

    form = None if total else "{desc} {elapsed}"
    ended = threading.Event()
    with tqdm(
        desc=title, total=total, bar_format=form, leave=False, delay=FIRST, miniters=0
    ) as bar:

        def step(text: str) -> None:
            bar.set_description_str(" ".join([title, text]).strip(), refresh=False)
            bar.update()

        def tick() -> None:  # updates the elapsed time between two steps
            while not ended.wait(BETWEEN):
                bar.update(0)

        thread = threading.Thread(target=tick, daemon=True)
        thread.start()
        try:
            yield step
        finally:
            ended.set()
            thread.join()
