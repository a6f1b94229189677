"""The page about the dataset claims: verdicts, the numbers behind them, and the runs to repeat.

One HTML file that needs nothing beside it. All that it says is in the dataset.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from html import escape

import numpy as np
import xarray as xr
import yaml

from microslip.foundation.files import writing_beside
from microslip.studies.claims.static_limits import FORMULAS, SPLIT
from microslip.studies.claims.verdicts import OUTCOMES, WORDS
from microslip.theory.catalogue import FORMS

STYLE = """
body { font: 15px/1.45 sans-serif; max-width: 76em; margin: 2em auto; padding: 0 1em; }
table { border-collapse: collapse; margin: .6em 0 1.2em; }
th, td { border: 1px solid #bbb; padding: .2em .5em; text-align: left; vertical-align: top; }
td.n { text-align: right; white-space: nowrap; }
code { font-size: 12px; overflow-wrap: anywhere; }
.v1 { background: #d7e9f7; } .v2 { background: #fbf0cf; } .v3 { background: #f7d9cc; }
.v0, .aside { color: #555; } h2 { margin-top: 1.8em; }
"""
COUNTED = {"holds": "for it", "fails": "against", "open": "open"}
PARTS_OF_SHIFT = ("from_velocity", "from_resolution")
MOTIONS = {"transverse": "Transverse oscillation", "bore": "Oscillating bore"}


def write(path: str | os.PathLike, dataset: xr.Dataset, lines: list[str]) -> None:
    """Write the page of the xarray.Dataset; lines: list of what its report says.

    Raises CacheError as `files.writing_beside` does.
    """
    with writing_beside(path) as beside:
        beside.write_text(page(dataset, lines), encoding="utf-8", newline="\n")


def page(dataset: xr.Dataset, lines: list[str]) -> str:
    """The page as text; it depends on its arguments alone."""
    data = {name: dataset[name].values for name in dataset.variables}
    title = escape(dataset.attrs.get("title", ""))
    parts = [
        '<!DOCTYPE html>\n<html lang="en"><meta charset="utf-8">',
        f"<title>{title}</title><style>{STYLE}</style>",
        f"<h1>{title}</h1>",
        f"<p>{escape(dataset.attrs.get('comment', ''))} All quantities are dimensionless.</p>",
        _summary(data),
        *(_claim(data, i) for i in range(len(data["claim"]))),
        "<h2 id='static'>The static limit, and what hid it</h2>",
        *(_static(data, motion) for motion in MOTIONS if f"{motion}_limit" in data),
        "<h2 id='runs'>Runs</h2>",
        _runs(data),
        "<h2>Made by</h2>",
        f"<pre>{escape(_made_by(dataset, lines))}</pre></html>\n",
    ]
    return "\n".join(parts)


def _table(head: Iterable[str], rows: Iterable[Iterable[tuple[str, str]]]) -> str:
    """An HTML table; cells: (text that is HTML already, class)."""
    cells = "".join(f"<th>{name}</th>" for name in head)
    body = "".join(
        "<tr>" + "".join(f'<td class="{kind}">{text}</td>' for text, kind in row) + "</tr>\n"
        for row in rows
    )
    return f"<table><tr>{cells}</tr>\n{body}</table>"


def _verdict(index: int) -> tuple[str, str]:
    return WORDS[int(index)], f"v{int(index)}"


def _number(value: float, digits: int = 4) -> str:
    return "" if not np.isfinite(value) else f"{value:.{digits}g}"


def _with_error(value: float, error: float) -> str:
    """A number and its error, written to the digits that the error leaves."""
    if not np.isfinite(value):
        return "none"
    if not np.isfinite(error):
        return f"{_number(value)}, no error known"
    decimals = int(np.clip(1 - np.floor(np.log10(max(error, 1e-12))), 1, 6))
    rounded = f"{value:.{decimals}f}"
    return f"{rounded if float(rounded) else _number(value)} &plusmn; {error:.2g}"


def _summary(data: dict[str, np.ndarray]) -> str:
    rows = []
    for i, claim in enumerate(data["claim"]):
        words, kind = _verdict(data["verdict"][i])
        link = f'<a href="#claim{claim}">{claim}</a>'
        shown = [
            _link(_row_of(data, data["check_run"][chosen]))
            for k in np.flatnonzero((data["part_claim"] == claim) & data["part_counts"])
            if (chosen := _decisive(data, int(k))) is not None
        ]
        runs = ", ".join(dict.fromkeys(shown))
        statement = escape(str(data["statement"][i]))
        rows.append([(link, "n"), (statement, ""), (words, kind), (runs, "")])
    return _table(("", "what the paper says", "verdict", "shown by"), rows)


def _claim(data: dict[str, np.ndarray], index: int) -> str:
    number = data["claim"][index]
    words, kind = _verdict(data["verdict"][index])
    rows, listed = [], []
    for k in np.flatnonzero(data["part_claim"] == number):
        verdict, its_kind = _verdict(data["part_verdict"][k])
        counts = ", ".join(f"{data[f'part_{o}'][k]} {word}" for o, word in COUNTED.items())
        text = escape(str(data["part_text"][k]))
        if not data["part_counts"][k]:
            text = f'<span class="aside">Beside the verdict: {text}</span>'
        rows.append(
            [
                (text, ""),
                (verdict, its_kind),
                (counts, ""),
                (escape(str(data["part_where"][k])), ""),
                (_shown(data, int(k)), ""),
            ]
        )
        listed.append(_checks(data, int(k)))
    head = ("what is asked", "outcome", "checks", "where", "shown by")
    return (
        f'<h2 id="claim{number}">{number}. <span class="{kind}">{words}</span></h2>\n'
        f"<p>{escape(str(data['statement'][index]))}</p>\n{_table(head, rows)}"
        f"<details><summary>All checks</summary>{''.join(listed)}</details>"
    )


def _shown(data: dict[str, np.ndarray], part: int) -> str:
    """The check that shows a part best, with its run and how to repeat it."""
    chosen = _decisive(data, part)
    if chosen is None:
        return "no check decides"
    value, against = (float(data[f"check_{n}"][chosen]) for n in ("value", "against"))
    margin = _with_error(data["check_margin"][chosen], data["check_error"][chosen])
    numbers = (
        f"{_number(value, 5)} against {_number(against, 5)} (difference "
        f"{_number(value - against, 3)}), margin {margin}"
    )
    run = _row_of(data, data["check_run"][chosen])
    return f"{_place(data, run)}: {numbers}; {_link(run)}<br><code>{_command(data, run)}</code>"


def _decisive(data: dict[str, np.ndarray], part: int) -> int | None:
    """Index of the check: the clearest against the part, else the closest for it."""
    own = data["check_part"] == data["part"][part]
    margin = np.asarray(data["check_margin"], float)
    fails = np.flatnonzero(own & (data["check_outcome"] == OUTCOMES.index("fails")))
    holds = np.flatnonzero(own & (data["check_outcome"] == OUTCOMES.index("holds")))
    if fails.size:
        return int(fails[np.argmin(margin[fails])])
    return int(holds[np.argmin(margin[holds])]) if holds.size else None


def _checks(data: dict[str, np.ndarray], part: int) -> str:
    rows = []
    for k in np.flatnonzero(data["check_part"] == data["part"][part]):
        runs = [data["check_run"][k], data["check_other_run"][k]]
        links = ", ".join(_link(_row_of(data, key)) for key in runs if str(key))
        rows.append(
            [
                *((_number(data[f"check_{n}"][k]), "n") for n in ("amplitude", "velocity")),
                *((_number(data[f"check_{n}"][k], 6), "n") for n in ("value", "against")),
                (_with_error(data["check_margin"][k], data["check_error"][k]), "n"),
                (OUTCOMES[int(data["check_outcome"][k])], ""),
                (links, ""),
            ]
        )
    head = ("amplitude", "velocity", "computed", "against", "margin", "", "runs")
    return f"<p>{escape(str(data['part_text'][part]))}</p>{_table(head, rows)}"


def _static(data: dict[str, np.ndarray], motion: str) -> str:
    """A table over the amplitudes, and where the paper's formulas are off most."""
    names = {name: FORMS[motion][form].equation for name, (form, _) in FORMULAS[motion].items()}
    slow, slowest = (float(data[f"claims_{n}"]) for n in ("paper_velocity", "slowest"))
    head = ["amplitude", "limit", f"at velocity {slowest:g}"]
    head += [f"{name} (less limit)" for name in names.values()]
    head += [f"of the bound inside, {names['zone']} less limit"]
    head += [f"paper's run at {slow:g} (less limit)", "of it from velocity"]
    head += ["of it from resolution", "squares alone, velocity to 0"]
    of = {name: data[f"{motion}_{name}"] for name in (*SPLIT, *names, "lost", "amplitude")}
    rows = []
    for k, limit in enumerate(of["limit"]):
        both = [f"{of[name][k]:.4f} ({of[name][k] - limit:+.4f})" for name in (*names, "paper")]
        lost = of["lost"][k]
        texts = [
            _number(of["amplitude"][k]),
            *(_with_error(of[n][k], of[f"{n}_error"][k]) for n in ("limit", "march")),
            *both[:-1],
            f"{100 * lost:.1f} %" if np.isfinite(lost) else "",
            both[-1],
            *(_with_error(of[n][k], of[f"{n}_error"][k]) for n in PARTS_OF_SHIFT),
            f"{of['squares_shift'][k]:+.4f}",
        ]
        rows.append([(text, "n") for text in texts])
    most = "; ".join(
        f"{name} by {float(data[f'{motion}_gap_{key}']):.4f} at amplitude "
        f"{float(data[f'{motion}_gap_{key}_at']):.3g}"
        for key, name in names.items()
    )
    text = f"<h3>{MOTIONS[motion]}</h3>{_table(head, rows)}<p>Most above the limit: {most}."
    if motion == "bore":
        share = 100 * float(data["static_asymptote_excess"])
        text += f" At large amplitudes Eq 33 tends to {share:.1f} % more than the limit."
    return text + "</p>"


# Runs


def _row_of(data: dict[str, np.ndarray], key: str) -> int:
    return int(np.flatnonzero(data["run"] == key)[0])


def _link(row: int) -> str:
    return f'<a href="#run{row + 1}">run {row + 1}</a>'


def _command(data: dict[str, np.ndarray], row: int) -> str:
    return escape(str(data["run_command"][row]))


def _place(data: dict[str, np.ndarray], row: int) -> str:
    """Motion, velocity, amplitude, nu, model and resolution of a run, as text."""
    words = [str(data["run_motion"][row]), f"v {data['run_velocity'][row]:g}"]
    if np.isfinite(data["run_amplitude"][row]):
        words.append(f"A {data['run_amplitude'][row]:g}")
    words += [f"nu {data['run_poisson'][row]:g}", str(data["run_model"][row]), _size(data, row)]
    return escape(", ".join(word for word in words if word))


def _size(data: dict[str, np.ndarray], row: int) -> str:
    cells, angles, steps = (int(data[f"run_{n}"][row]) for n in ("cells", "angles", "steps"))
    text = f"{cells} cells" if cells else ""
    text += f" x {angles} angles" if angles > 1 else ""
    return text + (f", {steps} steps" if steps else "")


def _runs(data: dict[str, np.ndarray]) -> str:
    rows = []
    for k, key in enumerate(data["run"]):
        tolerance = _number(data["run_tolerance"][k])
        force = _with_error(data["run_mu_macro"][k], data["run_error"][k])
        if not np.isfinite(data["run_error"][k]):
            force = _number(data["run_mu_macro"][k], 6)
        if not data["run_converged"][k]:
            force += ", not converged"
        texts = [str(k + 1), escape(str(data["run_what"][k])), _place(data, k), tolerance, force]
        cells = [(f'<span id="run{k + 1}">{texts[0]}</span>', "n"), *((t, "") for t in texts[1:])]
        shown = f"<code>{_command(data, k)}</code><br><code>{escape(str(key))}</code>"
        rows.append([*cells, (shown, "")])
    head = ("run", "what", "where", "tolerance", "mu_macro", "command, and name of the result")
    return _table(head, rows)


def _made_by(dataset: xr.Dataset, lines: list[str]) -> str:
    attributes = dict(dataset.attrs)
    configuration = json.loads(attributes.pop("configuration", "{}"))
    left_out = ("title", "comment")
    made = [f"{name}: {value}" for name, value in attributes.items() if name not in left_out]
    settings = yaml.safe_dump(configuration, default_flow_style=None, width=100)
    return "\n".join([*made, "", *lines, "", "Configuration, with all defaults", settings])
