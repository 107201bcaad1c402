"""What is said to people, as a value: which sentence it is and what is filled in. `mintpilot.wording` speaks it.

A sentence is known by its English form. That is the key under which the catalogues of the other languages have it, so
every call of `message` has it as a literal; a test looks through the source for those that no catalogue has.
"""

from __future__ import annotations

import string
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

import numpy as np


@dataclass(frozen=True, slots=True)
class Named:
    """A thing as map and questions call it, with its article: ``the grey smoke near the gate``."""

    words: str

    def __str__(self) -> str:
        return self.words


@dataclass(frozen=True, slots=True)
class Message:
    """A sentence or a clause. An empty one is false; as text it is in English."""

    template: str = ""
    """In English, with a field in braces for each value, as `str.format` has them: ``it takes {time_s:.1f} s``."""
    values: tuple[tuple[str, Filling], ...] = ()

    def __bool__(self) -> bool:
        return bool(self.template)

    def __str__(self) -> str:
        return _ENGLISH.vformat(self.template, (), dict(self.values))

    @property
    def has_words(self) -> bool:
        """False where it only puts other messages or names together, in any language alike."""
        return any(any(c.isalpha() for c in text) for text, *_ in string.Formatter().parse(self.template))


NOTHING: Final = Message()
"""Says nothing, and is false."""
Filling: TypeAlias = "str | int | float | Named | Message"
"""Text (a name, somebody's own words) and numbers are the same in every language, but for a number's decimal mark."""


class MessageFormatter(string.Formatter):
    """Formats fields by name; what is no number is written by `word`, and then padded or cut as its field says."""

    def word(self, value: Named | Message) -> str:
        """A thing or a nested message, in this formatter's language."""
        return str(value)

    def get_value(self, key: int | str, args: Sequence[Any], kwargs: Mapping[str, Any]) -> Any:
        """The value of a field; see `string.Formatter`."""
        del args
        value = kwargs[str(key)]
        return self.word(value) if isinstance(value, Named | Message) else value


_ENGLISH = MessageFormatter()


def message(template: str, /, **values: Filling | np.floating[Any] | np.integer[Any]) -> Message:
    """A message with its values by the names of their fields.

    Raises:
        KeyError: the template has a field without a value.
    """
    plain = tuple((name, v.item() if isinstance(v, np.generic) else v) for name, v in values.items())
    made = Message(template, plain)
    str(made)  # what cannot be said fails where it is made
    return made


def verbatim(text: str) -> Message:
    """Somebody's own words, or a technical detail: the same in every language."""
    return Message("{text}", (("text", text),)) if text else Message()


def joined(parts: Sequence[Filling], separator: str = " ") -> Message:
    """Messages one after the other; the separator has no words."""
    said = [(f"p{i}", part) for i, part in enumerate(part for part in parts if part)]
    return Message(separator.join(f"{{{name}}}" for name, _ in said), tuple(said))
