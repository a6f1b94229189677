"""The JSON schema of a configuration, and what is wrong with one in a line.

The schema, config.schema.yaml, lies beside this module, so that an installed package has it; the
workflow's folder of schemas links to it. It is closed: a key that it does not know is an error.
"""

import difflib
import json
import math
import re
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any

import jsonschema
import yaml

PATH = Path(__file__).parent / "config.schema.yaml"


@cache
def schema() -> dict:
    """Return the schema as a dict, shared by all callers: do not change it."""
    # Every job reads it; libyaml, where PyYAML has it, takes a fifth of the time.
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    return yaml.load(PATH.read_text(encoding="utf-8"), loader)


def problem(mapping: object) -> str | None:
    """Say in one line what is wrong with a configuration: key, value, what is allowed.

    mapping: parsed YAML. Returns None if it fits the schema.
    """
    not_finite = _not_finite(mapping, ())
    if not_finite:
        return not_finite
    errors = jsonschema.Draft202012Validator(schema()).iter_errors(mapping)
    # A mistyped key is both unknown and missing; the first of the two helps more.
    first = min(
        errors, key=lambda e: (e.validator != "additionalProperties", _key(e)), default=None
    )
    return None if first is None else _explain(first)


def filled(mapping: object) -> dict:
    """Copy a configuration that fits the schema, with all defaults filled in."""
    return _filled(mapping, schema())


# Defaults


def _filled(value: Any, rule: dict) -> Any:
    """Copy `value` with the defaults of the schema `rule` filled in, and whole floats as int."""
    rule = _resolved(rule)
    if isinstance(value, dict):
        rules = rule.get("properties", {})
        whole = {k: _resolved(r)["default"] for k, r in rules.items() if "default" in _resolved(r)}
        # Where the keys are free, all their values follow one rule.
        free = rule.get("additionalProperties")
        return {k: _filled(v, rules.get(k, free)) for k, v in {**whole, **value}.items()}
    if isinstance(value, list):
        return list(value)
    if "integer" in rule.get("type", ()) and value is not None:
        return int(value)
    return value


def _resolved(rule: dict) -> dict:
    if "$ref" not in rule:
        return rule
    return {**schema()["$defs"][rule["$ref"].rpartition("/")[2]], **rule}


# Messages


def _not_finite(value: object, path: tuple) -> str | None:
    # JSON has no such numbers, so the schema does not see them.
    if isinstance(value, float) and not math.isfinite(value):
        return f"{_dotted(path)}: {value} is not allowed; allowed: a finite number"
    items: Iterable[tuple[object, object]] = ()
    if isinstance(value, dict):
        items = value.items()
    elif isinstance(value, list):
        items = enumerate(value)
    return next(filter(None, (_not_finite(item, (*path, key)) for key, item in items)), None)


def _explain(error: jsonschema.ValidationError) -> str:
    """One line for a jsonschema error: key, value, what is allowed."""
    rule, value = error.schema, error.instance
    if error.validator == "additionalProperties":
        return _unknown_key(error)
    if error.validator == "required":
        missing = next(name for name in error.validator_value if name not in value)
        path = _dotted((*error.absolute_path, missing))
        return f"{path}: missing; required: {', '.join(error.validator_value)}"
    where = _key(error)
    kinds = set(_types(rule))
    if isinstance(value, str) and {"number", "integer"} & kinds and "string" not in kinds:
        return f"{where}: {shown(value)} is text; {_as_number(value)}"
    hint = near_miss(value, rule.get("enum", ()))
    return f"{where}: {shown(value)} is not allowed; {hint}allowed: {_allowed(rule)}"


def near_miss(given: object, known: Iterable[str]) -> str:
    """'did you mean this? ' if one of the known names is like what is given, else ''."""
    near = difflib.get_close_matches(str(given), known, n=1)
    return f"did you mean {near[0]}? " if near else ""


def _unknown_key(error: jsonschema.ValidationError) -> str:
    known = list(error.schema.get("properties", {}))
    unknown = next(key for key in error.instance if key not in known)
    path = _dotted((*error.absolute_path, str(unknown)))
    return f"{path}: unknown key; {near_miss(unknown, known)}allowed: {', '.join(known)}"


def _as_number(text: str) -> str:
    try:
        value = float(text)
    except ValueError:
        return "allowed: a number"
    if not math.isfinite(value):
        return "allowed: a finite number"
    mantissa, _, exponent = text.lower().partition("e")
    if not exponent:
        # YAML takes +.5 for text, and 010 for another number.
        plain = re.fullmatch(r"-?(0|[1-9][0-9]*)?(\.[0-9]*)?", text)
        return f"write the number without quotes: {text if plain else f'{value:.17g}'}"
    # YAML 1.1 takes it for a number only with a point before and a sign after the e.
    mantissa = mantissa if "." in mantissa else f"{mantissa}.0"
    return f"write {mantissa}e{int(exponent):+d}"


def _allowed(rule: dict) -> str:
    if "enum" in rule:
        return ", ".join(rule["enum"])
    kinds = _types(rule)
    if "array" in kinds and "object" in kinds:
        return f"a list of {_allowed(_resolved(rule['items']))}, or linear or log spacing"
    if kinds[:1] == ["array"]:
        one = _allowed(_resolved(rule["items"]))
        return " ".join([f"a list of {one}", *(["or null"] if "null" in kinds else [])])
    if kinds == ["object"] and "properties" not in rule:
        return "a mapping of names" + (", one at least" if rule.get("minProperties") else "")
    if kinds == ["object"]:
        return f"a mapping with the keys {', '.join(rule['properties'])}"
    words = {"number": "a number", "integer": "a whole number", "array": "or a list of them"}
    words |= {"string": rule.get("title", "text"), "null": "or null"}
    limits = {"minimum": ">=", "exclusiveMinimum": ">", "maximum": "<="}
    ranges = [f"{sign} {rule[key]:g}" for key, sign in limits.items() if key in rule]
    if rule.get("multipleOf") == 2:
        words["integer"] = "an even number"
    if kinds[:1] == ["string"] and "number" in kinds:
        words["number"] = "or a number"
    first, *others = [words[kind] for kind in kinds]
    return " ".join([first, " and ".join(ranges), *others]).replace("  ", " ").strip()


def _types(rule: dict) -> list[str]:
    kinds = rule.get("type", [])
    return [kinds] if isinstance(kinds, str) else kinds


def _key(error: jsonschema.ValidationError) -> str:
    return _dotted(error.absolute_path) or "(top level)"


def _dotted(path: Iterable) -> str:
    text = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in path)
    return text.removeprefix(".")


def shown(value: object) -> str:
    """Write a value as in JSON, cut to 60 characters."""
    text = json.dumps(value, default=str, ensure_ascii=False)
    text = text.encode("utf-8", "backslashreplace").decode()  # halves of a character, too
    return text if len(text) <= 60 else f"{text[:57]}..."
