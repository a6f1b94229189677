"""Canonical strings of values, and hashes of these strings.  Equal values have equal strings and
hashes.

The module imports only the standard library, since every start of the workflow imports it.
"""

import hashlib
import json
import math
from typing import Any


def number(value: float) -> str:
    """Return the canonical decimal string of a finite number, such as 1 (for 1.0), 0.001 or 1e-8.

    The number is rounded to 12 significant digits, so that the coordinates 0.1 + 0.2 and 0.3 have
    the same string. Raises ValueError unless the value is a finite number.
    """
    if isinstance(value, bool | str) or not math.isfinite(value):
        raise ValueError(f"{value!r} is not a finite number")
    rounded = float(f"{value:.12g}")
    if rounded == 0:
        return "0"  # also for -0.0
    text = repr(rounded)
    if "e" in text:
        mantissa, _, exponent = text.partition("e")
        return f"{mantissa.removesuffix('.0')}e{int(exponent)}"
    return text.removesuffix(".0")


def plain(value: object) -> Any:
    """Convert NumPy values, also in dicts and lists, to values for JSON.  NaN is converted to
    None."""
    if isinstance(value, dict):
        return {str(name): plain(item) for name, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    return None if isinstance(value, float) and not math.isfinite(value) else value


def canonical_json(value: object) -> str:
    """Return a JSON string with sorted keys and no white space.  Raises ValueError for NaN and
    infinities."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False)


def sha256(text: str) -> str:
    """Return the SHA-256 of a string, in hexadecimal."""
    return hashlib.sha256(text.encode()).hexdigest()


def fingerprint(*parts: object) -> str:
    """Return the first 32 digits of the SHA-256 of `parts`.  The parts must be convertible to
    JSON."""
    return sha256(canonical_json(parts))[:32]
