"""Convert formulas in plain text, such as "v0 / (omega u_lim)", to mathtext and HTML."""

from __future__ import annotations

import re

GREEK = {
    name: rf"\{name}" for name in ("alpha", "beta", "delta", "kappa", "mu", "nu", "omega", "Omega")
} | {"phi": r"\varphi", "theta": r"\vartheta"}
"""Names of Greek letters and their LaTeX commands."""

LETTERS = {
    **{"mu": "\N{GREEK SMALL LETTER MU}", "phi": "\N{GREEK SMALL LETTER PHI}"},
    **{"omega": "\N{GREEK SMALL LETTER OMEGA}", "Omega": "\N{GREEK CAPITAL LETTER OMEGA}"},
}
"""Names of Greek letters and their Unicode characters."""

_WORD = re.compile(r"([A-Za-z]+)(\d*)(?:_([A-Za-z0-9]+))?")


def mathtext(formula: str) -> str:
    """Convert a formula to mathtext. If it contains words, only its symbols are mathtext.

    A symbol is a letter or the name of a Greek letter, with an optional number or index: x, v0,
    u_lim, phi_lk. Other sequences of letters are words.
    """
    if any(not _symbol(match) for match in _WORD.finditer(formula)):
        return _WORD.sub(_in_words, formula)
    text = re.sub(r"\s*([/()])\s*", r"\1", _WORD.sub(_symbol, formula).strip())
    text = re.sub(r"\s+", r"\\,", text)
    return f"${text}$" if text else ""


def html(formula: str) -> str:
    """Convert a formula to HTML with italic letters and subscripts."""

    def symbol(match: re.Match[str]) -> str:
        letters, number, index = match.groups()
        below = number + (index or "")
        letter = LETTERS.get(letters, letters)
        return f"<i>{letter}</i>" + (f"<sub>{below}</sub>" if below else "")

    text = re.sub(r"\s*([/()])\s*", r"\1", _WORD.sub(symbol, formula))
    return text.replace("</sub> <i>", "</sub><i>").replace("</i> <i>", " ")


def _symbol(match: re.Match[str]) -> str:
    """Return the LaTeX symbol of a match of _WORD, or "" for a word."""
    letters, number, index = match.groups()
    if letters not in GREEK and len(letters) > 1:
        return ""
    base = GREEK.get(letters, letters)
    below = number + (rf"\mathrm{{{index}}}" if index else "")
    return f"{base}_{{{below}}}" if below else base


def _in_words(match: re.Match[str]) -> str:
    # A single letter can be a word, such as an article.
    plain = len(match[0]) == 1 or not _symbol(match)
    return match[0] if plain else f"${_symbol(match)}$"
