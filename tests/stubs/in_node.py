"""Functions of the explorer's scripts, called without a browser."""

import json
import shutil
import subprocess
from html.parser import HTMLParser
from pathlib import Path

import pytest

from microslip.report.explorer import explorer
from microslip.report.explorer.page import FOLDER

NODE = shutil.which("node")
needs_node = pytest.mark.skipif(NODE is None, reason="node is not installed: apt install nodejs")
"""Mark for tests that run scripts of the page."""


class _Ids(HTMLParser):
    """Ids of a page, with their visibility and the ids around each."""

    EMPTY = ("meta", "input", "br")

    def __init__(self):
        super().__init__()
        self.hidden, self.parents, self._open = {}, {}, []

    def handle_starttag(self, tag, attrs):
        found = dict(attrs)
        name = found.get("id")
        if name:
            self.hidden[name] = "hidden" in found
            self.parents[name] = [one for one in self._open if one]
        if tag not in self.EMPTY:
            self._open.append(name)

    def handle_endtag(self, tag):
        self._open.pop()


def page_says(content, *steps):
    """Values of expressions on the whole page, without a browser and with a document that draws
    nothing.

    content: output of page.build. steps: JavaScript expressions, evaluated in order.
    """
    markup = (FOLDER / "page.html").read_text(encoding="utf-8")
    ids = _Ids()
    ids.feed(markup)
    stub = Path(__file__).with_name("page_in_node.js").read_text(encoding="utf-8")
    scripts = [name for name in explorer.ASSETS if name.endswith(".js")]
    code = ["'use strict';", stub, *((FOLDER / name).read_text("utf-8") for name in scripts)]
    code.append("process.stdout.write(JSON.stringify(steps.map((step) => eval(step) ?? null)));")
    inputs = {"ids": ids.hidden, "parents": ids.parents, "numbers": content, "steps": steps}
    process = subprocess.run(
        [NODE, "-e", "\n".join(code)],
        input=json.dumps(inputs, allow_nan=False),
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert process.returncode == 0, process.stderr[-2000:]
    return json.loads(process.stdout)
