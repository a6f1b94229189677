"""The JSON schema of a configuration, and one-line messages for invalid configurations."""

import json
import math
import re
from collections.abc import Iterable, Iterator
from functools import cache
from typing import TYPE_CHECKING, Any

from microslip.config.records import Refusal
from microslip.foundation.spec import near_miss

if TYPE_CHECKING:
    from pydantic_core import ErrorDetails

UNKNOWN = ("extra_forbidden", "invalid_key")
"""Types of pydantic errors for unknown keys."""


@cache
def schema() -> dict:
    """The JSON schema.  All callers share this dict, which must not be changed."""
    from pydantic.json_schema import GenerateJsonSchema

    from microslip.config.settings import Root

    class Generator(GenerateJsonSchema):
        """JSON schema generator that omits field titles and adds a schema for the names of keys."""

        def field_title_should_be_set(self, schema: Any) -> bool:
            return False

        def dict_schema(self, schema: Any) -> dict:
            keys, values = schema["keys_schema"], schema["values_schema"]
            names = {"propertyNames": self.generate_inner(keys)}
            rule = super().dict_schema(schema) | names
            rule.pop("patternProperties", None)
            return rule | {"additionalProperties": self.generate_inner(values)}

    dialect = "https://json-schema.org/draft/2020-12/schema"
    return {"$schema": dialect} | Root.model_json_schema(schema_generator=Generator)


def options(rule: dict) -> list[dict]:
    """Alternatives that a rule of the schema allows, with references resolved."""
    if "$ref" in rule:
        return options(schema()["$defs"][rule["$ref"].rpartition("/")[2]])
    alternatives = rule.get("anyOf") or rule.get("oneOf")
    return [o for one in alternatives for o in options(one)] if alternatives else [rule]


def error_line(errors: Iterable["ErrorDetails"]) -> str:
    """Message for one of the pydantic errors, with the key, the value and the allowed values.

    Unknown keys come first: a mistyped key is reported as unknown and not as missing.
    """
    return _line(min(errors, key=lambda e: (e["type"] not in UNKNOWN, _dotted(_keys(e["loc"])))))


def short_json(value: object) -> str:
    """Format a value as JSON, truncated to 60 characters."""
    try:
        text = json.dumps(value, default=str, ensure_ascii=False)
    except (ValueError, RecursionError):  # the value contains itself
        text = repr(value)
    text = text.encode("utf-8", "backslashreplace").decode()  # escapes lone surrogates
    return text if len(text) <= 60 else f"{text[:57]}..."


# Messages


def _line(error: "ErrorDetails") -> str:
    keys, value, kind = _keys(error["loc"]), error["input"], error["type"]
    refusal = error.get("ctx", {}).get("error")
    if isinstance(refusal, Refusal):
        return f"{_dotted([*keys, *filter(None, [refusal.key])])}: {refusal}"
    if kind in UNKNOWN:
        keys[-1] = str(keys[-1])
        names = [key for rule in _rules(keys[:-1]) for key in rule.get("properties", ())]
        hint = near_miss(keys[-1], names)
        return f"{_dotted(keys)}: unknown key; {hint}allowed: {', '.join(names)}"
    if kind == "missing":
        required = next(r["required"] for r in _rules(keys[:-1]) if "required" in r)
        return f"{_dotted(keys)}: missing; required: {', '.join(required)}"
    of_name = error["loc"][-1:] == ("[key]",)
    keys = _keys(error["loc"][:-2]) if of_name else keys
    rules = [rule["propertyNames"] if of_name else rule for rule in _rules(keys)]
    where = _dotted(keys) or "(top level)"
    if isinstance(value, float) and not math.isfinite(value):
        return f"{where}: {value} is not allowed; allowed: a finite number"
    types = {rule.get("type") for rule in rules}
    if isinstance(value, str) and {"number", "integer"} & types and "string" not in types:
        return f"{where}: {short_json(value)} is text; {_as_number(value)}"
    hint = near_miss(value, [name for rule in rules for name in rule.get("enum", ())])
    return f"{where}: {short_json(value)} is not allowed; {hint}allowed: {allowed_values(rules)}"


def _keys(location: tuple[int | str, ...]) -> list[int | str]:
    """Keys and indices in a pydantic location, without union tags and "[key]"."""
    return [key for key in location if key not in ("(list)", "(spacing)", "(number)", "[key]")]


def _rules(keys: list[int | str]) -> Iterator[dict]:
    """Alternatives that the schema allows for the value at these keys."""
    rules = options(schema())
    for key in keys:
        inner = [_inside(rule, key) for rule in rules]
        rules = [option for rule in inner if rule for option in options(rule)]
    yield from rules


def _inside(rule: dict, key: int | str) -> dict | None:
    if rule.get("type") == "array":
        return rule["items"] if isinstance(key, int) else None
    return rule.get("properties", {}).get(key) or rule.get("additionalProperties") or None


def _as_number(text: str) -> str:
    try:
        value = float(text)
    except ValueError:
        return "allowed: a number"
    if not math.isfinite(value):
        return "allowed: a finite number"
    mantissa, _, exponent = text.lower().partition("e")
    if not exponent:
        # YAML reads +.5 as text, and 010 as 8.
        plain = re.fullmatch(r"-?(0|[1-9][0-9]*)?(\.[0-9]*)?", text)
        return f"write the number without quotes: {text if plain else f'{value:.17g}'}"
    # YAML 1.1 reads a number with an e only if a point precedes the e and a sign follows it.
    mantissa = mantissa if "." in mantissa else f"{mantissa}.0"
    return f"write {mantissa}e{int(exponent):+d}"


def allowed_values(rules: list[dict]) -> str:
    """Description of the values that one of the rules allows."""
    kinds = [rule.get("type") for rule in rules]
    texts = ["or null" if rule.get("type") == "null" else _phrase(rule) for rule in rules]
    if kinds[:2] == ["number", "array"]:
        texts[1] = "or a list of them"
    if "object" in kinds and "array" in kinds:
        texts[-1] = f"or {texts[-1]}"
        texts[-2] += ","
    return " ".join(texts)


def _phrase(rule: dict) -> str:
    if "enum" in rule:
        return ", ".join(rule["enum"])
    if " " in rule.get("title", ""):
        return rule["title"]
    kind = rule["type"]
    if kind == "array":
        return f"a list of {allowed_values(options(rule['items'])).replace('a number', 'numbers')}"
    if kind == "object" and "properties" in rule:
        return f"a mapping with the keys {', '.join(rule['properties'])}"
    if kind == "object":
        return "a mapping of names" + (", one at least" if "minProperties" in rule else "")
    words = {"number": "a number", "integer": "a whole number", "string": "text"}
    word = "an even number" if rule.get("multipleOf") == 2 else words[kind]
    limits = {"minimum": ">=", "exclusiveMinimum": ">", "maximum": "<="}
    ranges = [f"{sign} {rule[key]:g}" for key, sign in limits.items() if key in rule]
    return f"{word} {' and '.join(ranges)}".strip()


def _dotted(keys: Iterable[int | str]) -> str:
    text = "".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in keys)
    return text.replace(".[", "[").removeprefix(".")
