"""Formulas as motions write them, "v0 / (omega u_lim)", in mathtext."""

from __future__ import annotations

import re

GREEK = {
    name: rf"\{name}" for name in ("alpha", "beta", "delta", "kappa", "mu", "nu", "omega", "Omega")
} | {"phi": r"\varphi", "theta": r"\vartheta"}
"""Names of Greek letters, and how matplotlib writes those that have two shapes."""

LETTERS = {
    **{"mu": "\N{GREEK SMALL LETTER MU}", "phi": "\N{GREEK SMALL LETTER PHI}"},
    **{"omega": "\N{GREEK SMALL LETTER OMEGA}", "Omega": "\N{GREEK CAPITAL LETTER OMEGA}"},
}
"""Names of Greek letters, and their Unicode characters."""

_WORD = re.compile(r"([A-Za-z]+)(\d*)(?:_([A-Za-z0-9]+))?")


def mathtext(formula: str) -> str:
    """A formula set as one; of one with words in it, only the symbols.

    A symbol is a letter, or the name of a Greek one, that a number or an index may follow: x, v0,
    u_lim, phi_lk. All other letters are words.
    """
    if any(not _symbol(found) for found in _WORD.finditer(formula)):
        return _WORD.sub(_in_words, formula)
    text = re.sub(r"\s*([/()])\s*", r"\1", _WORD.sub(_symbol, formula).strip())
    text = re.sub(r"\s+", r"\\,", text)
    return f"${text}$" if text else ""


def html(formula: str) -> str:
    """A formula in HTML: letters in italics, indices below."""

    def symbol(found: re.Match[str]) -> str:
        letters, number, index = found.groups()
        below = number + (index or "")
        letter = LETTERS.get(letters, letters)
        return f"<i>{letter}</i>" + (f"<sub>{below}</sub>" if below else "")

    text = re.sub(r"\s*([/()])\s*", r"\1", _WORD.sub(symbol, formula))
    return text.replace("</sub> <i>", "</sub><i>").replace("</i> <i>", " ")


def _symbol(found: re.Match[str]) -> str:
    """The symbol that a match of _WORD is, "" if it is a word."""
    letters, number, index = found.groups()
    if letters not in GREEK and len(letters) > 1:
        return ""
    base = GREEK.get(letters, letters)
    below = number + (rf"\mathrm{{{index}}}" if index else "")
    return f"{base}_{{{below}}}" if below else base


def _in_words(found: re.Match[str]) -> str:
    # A letter alone may be a word as well, such as an article.
    plain = len(found[0]) == 1 or not _symbol(found)
    return found[0] if plain else f"${_symbol(found)}$"
