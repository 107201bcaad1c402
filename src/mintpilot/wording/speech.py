"""Messages in the mission's language: each sentence by its catalogue, each thing by the tables of nouns."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from importlib import resources
from typing import Any, Final

from mintpilot.core.errors import UnknownNameError
from mintpilot.core.message import Message, MessageFormatter, Named
from mintpilot.wording.tongues import TONGUES
from mintpilot.wording.translating import noun_phrase


@cache
def catalogue(lang: str) -> Mapping[str, str]:
    """Sentences in English, and the same in that language; empty for English, which needs none.

    Raises:
        UnknownNameError: another language than `TONGUES` has.
    """
    if lang == "en":
        return {}
    if lang not in TONGUES:
        raise UnknownNameError("language", lang, ("en", *TONGUES))
    text = resources.files("mintpilot.wording").joinpath(f"catalogues/{lang}.json").read_text("utf-8")
    loaded: dict[str, str] = json.loads(text)
    return loaded


@dataclass(frozen=True, slots=True)
class Speech:
    """Says messages in one language. What a plug-in says that no catalogue has is said in English."""

    lang: str = "en"
    names: Mapping[str, str] = field(default_factory=dict)
    """What the mission itself calls things there, by their English words."""

    def __call__(self, message: Message) -> str:
        """The message as text."""
        if self.lang == "en":
            return str(message)
        template = catalogue(self.lang).get(message.template, message.template)
        return _Local(self).vformat(template, (), dict(message.values))

    def label(self, template: str) -> str:
        """A fixed text without values: a heading, a label."""
        return catalogue(self.lang).get(template, template)

    def number(self, value: float | None, unit: str = "", digits: int = 1) -> str:
        """A figure with its unit, or a dash where there is none; a space that does not break keeps them together."""
        if value is None:
            return "–"
        figure = f"{value:.{digits}f}" if self.lang == "en" else f"{value:.{digits}f}".replace(".", ",")
        return f"{figure}\N{NO-BREAK SPACE}{unit}" if unit else figure

    def thing(self, english: str) -> str:
        """A thing as map and questions call it; in quotation marks and English where a word of it is not known."""
        tongue = TONGUES.get(self.lang)
        if tongue is None or not english:
            return english
        return noun_phrase(english, replace(tongue, names=self.names))


IN_ENGLISH: Final = Speech()


class _Local(MessageFormatter):
    """Formats as English does, with the language's decimal mark."""

    def __init__(self, speech: Speech) -> None:
        self._speech = speech

    def word(self, value: Named | Message) -> str:
        return self._speech(value) if isinstance(value, Message) else self._speech.thing(value.words)

    def format_field(self, value: Any, format_spec: str) -> str:
        text = str(super().format_field(value, format_spec))
        if not isinstance(value, int | float):
            return text
        return re.sub(r"(?<=\d)%", "\N{NO-BREAK SPACE}%", text.replace(".", ","))
