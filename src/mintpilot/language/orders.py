"""Orders that an operator may give instead of an answer. They are obeyed at once."""

from __future__ import annotations

import re

from mintpilot.core.query import Order

_ITSELF = r"(?:it|her|this thing|the (?:drone|thing)|yourself)"
_MOTORS = r"(?:the |your |all )?(?:motors?|engines?|rotors?|props|propellers)"
_HOME = r"(?:come|go|fly|get|head)(?: straight| right)? (?:back|home)"
_OF_OTHERS = re.compile(r"\b(?:i|we|they|he|she|who|everyone|everybody|people|nobody|let me)(?: \w+)?\s*$")
"""Where people come back it is no order: ``I will come back to you``."""
_NO_LANDING = re.compile(
    r"\b(?:i|we|they|he|she|who|(?:every|some|any)(?:one|body)|people|nobody)(?: (?!said\b|say\b)\w+)?\s*$"
    r"|\b(?:(?<!you )to|can|could|may|might|the|a|this|that|my|our|of|no|dry|open|flat|is|are|was|were|been|it)\s*$"
    r"|\bin(?: \w+)?\s*$"
)
"""``I put it down there``, ``room to land``, ``on dry land``."""
_NO_STOP = re.compile(r"\b(?:bus|full|non|pit) $")
_ORDERS: tuple[tuple[re.Pattern[str], Order, re.Pattern[str]], ...] = tuple(
    (re.compile(pattern), command, told)
    for pattern, command, told in (
        (
            r"\b(?:abort(?:ing)?|(?:cancel|end|scrub|quit) (?:the |this )?(?:mission|flight|task)|call "
            r"(?:it|the mission) off|call off the mission|mayday)\b",
            Order.ABORT,
            _NO_STOP,
        ),
        (
            rf"\b(?:put|set|bring|take) {_ITSELF} down\b|\b(?:put|set|touch) down\b(?! {_ITSELF}\b)"
            rf"|\b(?:cut|kill|stop|shut off|shut down|turn off|switch off) {_MOTORS}\b"
            rf"|\bland(?= {_ITSELF}\b| *$| *[,.;!]"
            r"| (?:now|right|immediately|at once|please|straight|safely|there|here|where|on|by)\b)",
            Order.ABORT,
            _NO_LANDING,
        ),
        (
            rf"\b{_HOME}\b|\breturn\b(?: to (?:base|home|me|start|the pad|launch))?|\brtl\b|\brtb\b|\bretreat\b",
            Order.RETURN,
            _OF_OTHERS,
        ),
        (
            r"\b(?:stop|halt|freeze|pause)\b|\bemergency stop\b|^emergency$"
            r"|\b(?:hold|keep) (?:position|it there|there|still"
            r"|your position)\b|^hold(?: it)?$|\bstay (?:put|there|right there|where you are)\b|\bdo not move\b",
            Order.HOLD,
            _NO_STOP,
        ),
    )
)
"""Words, what they order, and what before them makes them tell of something instead; the strongest first."""
_TAKEN_BACK = re.compile(r"\b(?:(?:do |will |does |did )?not|never|no need to|without)(?: \w+)?\s*$")


def order_in(words: str) -> tuple[Order | None, str]:
    """The order in the words, if any; else the words without orders that are taken back (``do not stop``)."""
    for pattern, command, told in _ORDERS:
        for found in reversed(list(pattern.finditer(words))):
            before = words[: found.start()]
            taken_back = _TAKEN_BACK.search(before)
            if taken_back is not None and command is Order.RETURN and "never" in taken_back[0]:
                continue  # ``never come back`` is mockery: it stays to be read
            if taken_back is not None:
                words = f"{before[: taken_back.start()]} {words[found.end() :]}"
            elif told.search(before) is None:
                return command, words
    return None, words.strip(" ,.;!")
