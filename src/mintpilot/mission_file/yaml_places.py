"""YAML with the place of everything in it, read without trust.

A small subset is enough for a mission: mappings with text keys, lists, and plain values as YAML 1.2 (core schema)
understands them, so that ``1e-3`` is a number and ``no`` is a word. Anchors, tags, repeated keys, deep nesting and
large files are refused.
"""

from __future__ import annotations

import re
import stat
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

import yaml

MAX_BYTES = 1_000_000
MAX_DEPTH = 20
MAX_VALUES = 50_000

Path_: TypeAlias = tuple[str | int, ...]
Value: TypeAlias = "bool | int | float | str | list[Value] | dict[str, Value] | None"


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault:
    """A mistake at a place inside a document."""

    path: Path_
    """Keys and indices that lead there; empty for the document as a whole."""
    line: int | None
    """Line in the file, from 1, where it is known already."""
    message: str
    """The offending value, the rule that it breaks, and what to write instead."""


@dataclass(slots=True, kw_only=True)
class Document:
    """What a file says, and where it says it."""

    value: Value = None
    lines: dict[Path_, int] = field(default_factory=dict)
    """Line, from 1, of each key and list item."""
    faults: list[Fault] = field(default_factory=list)
    """What makes it unreadable, or was refused."""

    def line_of(self, path: Path_) -> int:
        """The line of that place, or of the nearest one around it that is written down."""
        while path and path not in self.lines:
            path = path[:-1]
        return self.lines.get(path, 1)


class _RefusedError(Exception):
    """Reading cannot go on."""

    def __init__(self, line: int, message: str) -> None:
        super().__init__(message)
        self.line = line


def read_document(path: Path) -> Document:
    """Reads one YAML file. Mistakes of form are in `Document.faults`, never raised."""
    document = Document()
    try:
        document.value = _Builder(document, _text_of(path)).document()
    except _RefusedError as refusal:
        document.faults.append(Fault(path=(), line=refusal.line, message=str(refusal)))
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        message = f"not YAML: {error.problem or error.context}; mend the indentation, quotes or brackets here"
        document.faults.append(Fault(path=(), line=mark.line + 1 if mark else 1, message=message))
    except yaml.YAMLError as error:
        first = str(error).splitlines()[0]
        document.faults.append(Fault(path=(), line=1, message=f"not YAML: {first}; save the file as plain UTF-8 text"))
    return document


def _text_of(path: Path) -> str:
    try:
        if not stat.S_ISREG(path.stat().st_mode):
            raise _RefusedError(1, f"'{path}' is no regular file; give a file, not a folder, device or pipe")
        with path.open("rb") as file:
            data = file.read(MAX_BYTES + 1)
    except FileNotFoundError:
        raise _RefusedError(1, f"there is no file '{path}'; check the name, or give the full path") from None
    except OSError as error:
        reason = error.strerror or str(error)
        raise _RefusedError(1, f"'{path}' cannot be read ({reason}); give a mission file that you may read") from None
    if len(data) > MAX_BYTES:
        raise _RefusedError(
            1, f"the file has more than {MAX_BYTES} bytes, the most that is read; is it a mission file?"
        )
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        raise _RefusedError(line, f"byte 0x{data[error.start]:02x} is not UTF-8; save the file as UTF-8 text") from None


class _Builder:
    """Builds the value from parser events: their number and depth are known before anything is made of them."""

    def __init__(self, document: Document, text: str) -> None:
        self._lines = document.lines
        self._faults = document.faults
        self._events: Iterator[yaml.Event] = yaml.parse(text, Loader=yaml.SafeLoader)
        self._values = 0

    def document(self) -> Value:
        next(self._events)
        start = next(self._events)
        if isinstance(start, yaml.StreamEndEvent):
            raise _RefusedError(1, "the file is empty; begin with 'mintpilot: 1'")
        value = self._value(next(self._events), ())
        next(self._events)
        end = next(self._events)
        if not isinstance(end, yaml.StreamEndEvent):
            raise _RefusedError(_line(end), "a second document begins here; keep one mission in a file, remove '---'")
        return value

    def _value(self, event: yaml.Event, path: Path_) -> Value:
        line = _line(event)
        self._lines.setdefault(path, line)
        self._values += 1
        if self._values > MAX_VALUES:
            raise _RefusedError(line, f"more than {MAX_VALUES} values, the most that is read; split the mission")
        if len(path) > MAX_DEPTH:
            raise _RefusedError(
                line, f"nested deeper than {MAX_DEPTH} levels; a mission needs far fewer, check the brackets"
            )
        if isinstance(event, yaml.AliasEvent) or getattr(event, "anchor", None):
            raise _RefusedError(line, "anchors (&) and aliases (*) are not read; write it out, or quote it")
        if getattr(event, "tag", None):
            raise _RefusedError(line, f"the tag '{getattr(event, 'tag', '')}' is not read; remove it, or quote it")
        if isinstance(event, yaml.MappingStartEvent):
            return self._mapping(path)
        if isinstance(event, yaml.SequenceStartEvent):
            return self._sequence(path)
        assert isinstance(event, yaml.ScalarEvent)
        _refuse_halves(event.value, line)
        unseen = _unseen(event.value)
        if unseen:
            self._faults.append(Fault(path=path, line=line, message=unseen))
        return scalar(event.value) if event.implicit[0] else event.value

    def _mapping(self, path: Path_) -> dict[str, Value]:
        mapping: dict[str, Value] = {}
        while not isinstance(event := next(self._events), yaml.MappingEndEvent):
            if not isinstance(event, yaml.ScalarEvent):
                raise _RefusedError(_line(event), "a key must be a word; quote it if it holds brackets or braces")
            key, line = event.value, _line(event)
            _refuse_halves(key, line)
            if unseen := _unseen(key):
                raise _RefusedError(line, unseen)
            here = (*path, key)
            if key in mapping:
                message = f"'{key}' is given again (first on line {self._lines[here]}); keep one of them"
                self._faults.append(Fault(path=here, line=line, message=message))
                self._value(next(self._events), (*path, f"{key} (again)"))
                continue
            self._lines[here] = line
            mapping[key] = self._value(next(self._events), here)
        return mapping

    def _sequence(self, path: Path_) -> list[Value]:
        items: list[Value] = []
        while not isinstance(event := next(self._events), yaml.SequenceEndEvent):
            items.append(self._value(event, (*path, len(items))))
        return items


def _line(event: yaml.Event) -> int:
    return event.start_mark.line + 1 if event.start_mark else 1


def _refuse_halves(text: str, line: int) -> None:
    r"""Half of a surrogate pair (an escape such as ``"\ud800"``) is no text: nothing could be written of it."""
    if any("\ud800" <= c <= "\udfff" for c in text):
        raise _RefusedError(
            line, "half of a surrogate pair, such as \\ud800, is no character; write the character itself"
        )


def _unseen(text: str) -> str:
    """What is wrong with a text that holds what steers a terminal or turns the reading order; empty: nothing."""
    for character in text:
        kind = unicodedata.category(character)
        if (kind == "Cc" and character not in "\n\t") or (kind == "Cf" and character not in _JOINERS):
            name = unicodedata.name(character, "a control character")
            return f"U+{ord(character):04X} ({name}) is not seen by whoever reads this; remove it"
    return ""


_JOINERS = "\u200c\u200d\u00ad"
"""Some scripts need them; they steer nothing."""
_INT = re.compile(r"[-+]?[0-9]{1,18}")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]{1,4})?")
_WORDS: dict[str, bool | float | None] = {
    "": None, "~": None, "null": None, "Null": None, "NULL": None,
    "true": True, "True": True, "TRUE": True, "false": False, "False": False, "FALSE": False,
    ".nan": float("nan"), ".NaN": float("nan"), ".NAN": float("nan"),
}  # fmt: skip


def scalar(text: str) -> bool | int | float | str | None:
    """The value of an unquoted word, as YAML 1.2's core schema has it."""
    if text in _WORDS:
        return _WORDS[text]
    if _INT.fullmatch(text):
        return int(text)
    if _FLOAT.fullmatch(text):
        return float(text)
    if text.lstrip("+-") in (".inf", ".Inf", ".INF"):
        return float("-inf") if text.startswith("-") else float("inf")
    return text
