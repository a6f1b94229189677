"""Functions of the explorer's scripts, called outside of a browser."""

import json
import shutil
import subprocess

import pytest

from microslip.report.explorer.page import FOLDER

NODE = shutil.which("node")
needs_node = pytest.mark.skipif(NODE is None, reason="node is not installed: apt install nodejs")
"""For every test that runs scripts of the page."""

CALLS = """
const { given, calls, call } = JSON.parse(require("fs").readFileSync(0, "utf8"));
// JSON has no numbers that are not finite.
const said = (key, value) =>
  typeof value === "number" && !Number.isFinite(value) ? String(value) : value;
process.stdout.write(JSON.stringify(calls.map((one) => {
  try {
    return eval(call)(given, ...one);
  } catch (error) {
    if (!(error instanceof Refusal)) throw error;
    return { refused: error.message };
  }
}), said));
"""


def answers(scripts, call, given, calls):
    """What a function of the page's scripts answers.

    scripts: names of files, in their order; call: JavaScript of a function of `given` and what is
    in one of `calls`. Returns a list: an answer each, or {"refused": message}.
    """
    code = ["'use strict';", *((FOLDER / name).read_text(encoding="utf-8") for name in scripts)]
    done = subprocess.run(
        [NODE, "-e", "\n".join([*code, CALLS])],
        input=json.dumps({"given": given, "calls": calls, "call": call}),
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)
