"""Orders that an operator may give instead of an answer. They are obeyed at once."""

from __future__ import annotations

import re

from mintpilot.core.query import Command

_HOME = r"(?:come|go|fly|get|head)(?: straight| right)? (?:back|home)"
_ORDERS: tuple[tuple[re.Pattern[str], Command], ...] = tuple(
    (re.compile(pattern), command)
    for pattern, command in (
        (
            r"\b(?:abort(?:ing)?|(?:cancel|end|scrub|quit) (?:the |this )?(?:mission|flight|task)|call "
            r"(?:it|the mission) off|call off the mission|mayday)\b",
            Command.ABORT,
        ),
        (
            rf"\b{_HOME}\b|\breturn\b(?: to (?:base|home|me|start|the pad|launch))?|\brtl\b|\brtb\b|\bretreat\b",
            Command.RETURN,
        ),
        (
            r"\b(?:stop|halt|freeze|pause)\b|\bemergency stop\b|^emergency$"
            r"|\b(?:hold|keep) (?:position|it there|there|still"
            r"|your position)\b|^hold(?: it)?$|\bstay (?:put|there|right there|where you are)\b|\bdo not move\b",
            Command.HOLD,
        ),
    )
)
"""The strongest first."""
_TAKEN_BACK = re.compile(r"\b(?:(?:do |will |does |did )?not|never|no need to|without)(?: \w+)?\s*$")
_OF_OTHERS = re.compile(r"\b(?:i|we|they|he|she|who|everyone|everybody|people|nobody|let me)(?: \w+)?\s*$")
"""Where people come back it is no order: ``I will come back to you``."""
_NO_ORDER = re.compile(r"\b(?:bus|full|non|pit) $")


def order_in(words: str) -> tuple[Command | None, str]:
    """The order in the words, if any; else the words without orders that are taken back (``do not stop``)."""
    for pattern, command in _ORDERS:
        for found in reversed(list(pattern.finditer(words))):
            before = words[: found.start()]
            taken_back = _TAKEN_BACK.search(before)
            if taken_back is not None:
                words = f"{before[: taken_back.start()]} {words[found.end() :]}"
            elif not _is_told(before, command):
                return command, words
    return None, words.strip(" ,.;!")


def _is_told(before: str, command: Command) -> bool:
    """Whether the words tell of something instead of ordering it."""
    told = _OF_OTHERS if command is Command.RETURN else _NO_ORDER
    return told.search(before) is not None
