"""Mistakes of form, in plain words: what pydantic found, said as value, rule and what to write instead."""

from __future__ import annotations

import difflib
import json
from collections.abc import Iterable, Mapping
from functools import cache
from typing import Any

from pydantic_core import ErrorDetails

from mintpilot.mission_file.schema import MissionFile
from mintpilot.mission_file.schema_base import WAYS_TO_DESCRIBE
from mintpilot.mission_file.yaml_places import Path_, Value

_KINDS = {
    "object": "a mapping (key: value)",
    "array": "a list ([…] or lines that begin with -)",
    "string": "text",
    "number": "a number",
    "integer": "a whole number",
    "boolean": "true or false",
    "null": "nothing",
}
_RULES = {
    "greater_than": "must be above {gt}",
    "greater_than_equal": "must be at least {ge}",
    "less_than": "must be below {lt}",
    "less_than_equal": "must be at most {le}",
    "finite_number": "must be a finite number",
    "string_too_short": "must not be empty",
    "string_too_long": "must be at most {max_length} characters long",
    "string_pattern_mismatch": "must be a name of letters, digits, '-', '_' and '.', beginning with a letter or digit",
    "too_short": "needs at least {min_length} items, it has {actual_length}",
    "too_long": "may have at most {max_length} items, it has {actual_length}",
}


def show(value: object) -> str:
    """The value as it would be written in the file, shortened."""
    if isinstance(value, float) and value != value:
        return ".nan"
    text = value if isinstance(value, str) else json.dumps(value, ensure_ascii=False, default=str)
    text = text if len(text) <= 60 else text[:57] + "…"
    text = "".join(c if c.isprintable() else repr(c)[1:-1] for c in text)  # what steers a terminal is spelt out
    return f"'{text}'" if isinstance(value, str) else text


def nearest(name: str, known: Iterable[str]) -> str:
    """A hint with the nearest known name, and all of them."""
    names = sorted(known)
    near = difflib.get_close_matches(name, names, n=1, cutoff=0.5)
    hint = f"did you mean '{near[0]}'? " if near else ""
    return f"{hint}known: {', '.join(names) or '(none)'}"


@cache
def _schema() -> dict[str, Any]:
    return MissionFile.model_json_schema()


class FormWords:
    """Translates pydantic's findings about one document."""

    def __init__(self, value: Value) -> None:
        self._value = value
        self._schema = _schema()

    def path(self, loc: tuple[str | int, ...]) -> Path_:
        """The place in the file: pydantic's location without the names of its own union members."""
        path: list[str | int] = []
        value: Any = self._value
        for step in loc:
            if step in self._schema["$defs"]:
                continue
            if step in WAYS_TO_DESCRIBE and not (isinstance(value, Mapping) and step in value):
                continue
            if isinstance(value, Mapping):
                value = value.get(str(step))
            elif isinstance(value, list) and isinstance(step, int) and step < len(value):
                value = value[step]
            else:
                break
            path.append(step)
        return tuple(path)

    def message(self, error: ErrorDetails) -> str:
        """The offending value, the rule and what to write instead."""
        kind, given = error["type"], error["input"]
        context = error.get("ctx", {})
        loc = error["loc"]
        schema = self._schema_at(loc) if loc[-1:] != ("[key]",) else self._schema_at(loc[:-2]).get("propertyNames", {})
        if kind == "missing" and isinstance(error["loc"][-1], int):
            count = len(self._schema_at(error["loc"][:-1]).get("prefixItems", ()))
            return f"{show(given)} has {len(given)} numbers, {count} are wanted{_advice(schema)}"
        if kind == "missing":
            return f"'{error['loc'][-1]}' is missing{_advice(schema)}"
        if kind == "extra_forbidden":
            known = self._schema_at(error["loc"][:-1]).get("properties", {})
            return f"unknown key '{error['loc'][-1]}'; {nearest(str(error['loc'][-1]), known)}"
        if kind in ("union_tag_not_found", "union_tag_invalid"):
            return (
                "must have one of the keys 'scenario' (a built-in world), 'scene' (solid by solid), 'map' (your own) "
                "or 'seen' (made by mintpilot see)"
            )
        if kind in ("literal_error", "enum"):
            known = [str(x) for x in schema.get("enum", [schema.get("const", "")])]
            return f"{show(given)} is not allowed; {nearest(str(given), known)}"
        if kind in _RULES:
            return f"{show(given)} {_RULES[kind].format(**context)}{_advice(schema)}"
        wanted = _KINDS.get(schema.get("type", ""), error["msg"].removeprefix("Input should be "))
        return f"{show(given)} must be {wanted}{_quotes(schema, given)}{_advice(schema)}"

    def _schema_at(self, loc: Iterable[str | int]) -> dict[str, Any]:
        """The part of the JSON Schema that describes that place; empty when there is none."""
        schema: dict[str, Any] = self._schema
        for step in loc:
            if step in self._schema["$defs"]:
                schema = self._schema["$defs"][step]
                continue
            if step in WAYS_TO_DESCRIBE and "oneOf" in schema:
                schema = {**schema, **schema["oneOf"][WAYS_TO_DESCRIBE.index(step)]}
                continue
            if isinstance(step, int):
                prefix = schema.get("prefixItems", [])
                found = prefix[step] if step < len(prefix) else schema.get("items", {})
            else:
                found = schema.get("properties", {}).get(step) or schema.get("additionalProperties") or {}
            schema = self._resolved(found if isinstance(found, dict) else {})
        return schema

    def _resolved(self, schema: dict[str, Any]) -> dict[str, Any]:
        """The schema with its reference followed and a mere 'or nothing' removed."""
        options = [x for x in schema.get("anyOf", []) if x.get("type") != "null"]
        if len(options) == 1:
            schema = {**{k: v for k, v in schema.items() if k != "anyOf"}, **options[0]}
        if "$ref" in schema:
            target = self._schema["$defs"][schema["$ref"].rsplit("/", 1)[1]]
            schema = {**target, **{k: v for k, v in schema.items() if k == "description"}}
        return schema


def _advice(schema: Mapping[str, Any]) -> str:
    text = str(schema.get("description", "")).strip().replace("\n", " ").rstrip(".")
    return f"; expected: {text[0].lower()}{text[1:]}" if text else ""


def _quotes(schema: Mapping[str, Any], given: object) -> str:
    plain = isinstance(given, bool | int | float)
    return f' (put it in quotes: "{json.dumps(given)}")' if schema.get("type") == "string" and plain else ""
