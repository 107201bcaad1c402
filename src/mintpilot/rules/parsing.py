"""Text → formula: ``!touches(smoke-1) U looked(room-2)``.

From the loosest to the tightest: ``->``, ``|``, ``&``, ``U`` and ``R`` (these and ``->`` group to the right), then
``!``, ``G`` and ``F``.
"""

from __future__ import annotations

import re

from mintpilot.core.errors import MissionError, UnknownNameError
from mintpilot.core.rule import About, Proposition
from mintpilot.rules.formula import (
    FALSE,
    TRUE,
    And,
    Atom,
    Formula,
    Or,
    Release,
    Until,
    always,
    eventually,
    negated,
)

MAX_CHARACTERS = 2000
"""Longer formulas are refused."""
MAX_DEPTH = 64
"""So are those with more operators inside one another."""
_TOKEN = re.compile(
    r"\s*(?:(?P<atom>(?P<name>(?![GFURX]\b)[A-Za-z_]+)\s*\((?P<inside>[^()]*)\))|(?P<word>[A-Za-z_]+)|(?P<sign>->|&&|\|\||=>|==|[^\s\w]))"
)
_MEANT = {
    "&&": "&", "||": "|", "=>": "->", "and": "&", "or": "|", "not": "!", "~": "!", "-": "->", "=": "->", "==": "->",
    "implies": "->", "until": "U", "release": "R", "always": "G", "globally": "G", "never": "G !", "eventually": "F",
    "finally": "F", "u": "U", "r": "R", "g": "G", "f": "F", "W": "p W q as (q R (p | q))", "[": "(", "]": ")",
}  # fmt: skip
"""What somebody who writes this means."""
_LEVELS = ("->", "|", "&", "UR")


def parse(text: str) -> Formula:
    """The formula that a text means.

    Raises:
        MissionError: it is no formula; the message names the column, what stands there and what was likely meant.
        UnknownNameError: it names a proposition that does not exist.
    """
    if len(text) > MAX_CHARACTERS:
        raise MissionError(
            f"a formula of {len(text)} characters; at most {MAX_CHARACTERS}: split it into several rules"
        )
    reader = _Reader(text)
    formula = reader.binary(0, 0)
    if reader.token:
        raise reader.fault("the end, or one of -> | & U R")
    return formula


def proposition(text: str) -> Proposition:
    """The one proposition that a text names, as the patterns of mission files take it. Raises as `parse`."""
    formula = parse(text)
    if isinstance(formula, Atom) and formula.holds:
        return formula.proposition
    raise MissionError(f"'{text}' is a formula; one proposition such as touches(smoke-1) is wanted here")


class _Reader:
    def __init__(self, text: str) -> None:
        self._text = text
        self._at = self._next = 0
        self.token = ""
        self._match: re.Match[str] | None = None
        self.advance()

    def advance(self) -> None:
        self._at = self._next
        self._match = _TOKEN.match(self._text, self._next)
        if self._match is None:
            self.token, self._at = "", len(self._text)
            return
        self._next = self._match.end()
        self.token = self._match.group("atom") or self._match.group("word") or self._match.group("sign")
        self._at = self._match.end() - len(self.token)

    def fault(self, wanted: str) -> MissionError:
        """What stands here, where, and what was likely meant."""
        found = f"'{self.token}'" if self.token else "the end"
        hint = f"; write '{_MEANT[self.token]}'" if self.token in _MEANT else ""
        if self.token == "X":
            hint = "; there is no X: rules count no steps. Say what is to hold with U, R, G or F"
        elif self.token in {a.value for a in About}:
            hint = f"; write {self.token}(NAME)"
        return MissionError(f"formula '{self._text}', column {self._at + 1}: {found} where {wanted} is wanted{hint}")

    def binary(self, level: int, depth: int) -> Formula:
        if depth > MAX_DEPTH:
            raise MissionError(f"formula '{self._text[:40]}…' is nested deeper than {MAX_DEPTH}: split it into rules")
        if level == len(_LEVELS):
            return self.unary(depth)
        left = self.binary(level + 1, depth)
        while self.token and (self.token == _LEVELS[level] or (level == 3 and self.token in "UR")):
            sign = self.token
            self.advance()
            groups_right = level in (0, 3)
            right = self.binary(level, depth + 1) if groups_right else self.binary(level + 1, depth)
            left = _joined(sign, left, right)
        return left

    def unary(self, depth: int) -> Formula:
        token, match = self.token, self._match
        if token in ("!", "G", "F"):
            self.advance()
            self._deeper(depth)
            inner = self.unary(depth + 1)
            if token == "!":
                return negated(inner)
            return always(inner) if token == "G" else eventually(inner)
        if token == "(":
            self.advance()
            inner = self.binary(0, depth + 1)
            if self.token != ")":
                raise self.fault("')'")
            self.advance()
            return inner
        if token in ("true", "false"):
            self.advance()
            return TRUE if token == "true" else FALSE
        if match is None or match.group("atom") is None:
            raise self.fault("a proposition, '(', '!', 'G' or 'F'")
        if match.group("name") in _MEANT:
            self.token = match.group("name")
            raise self.fault("a proposition, '(', '!', 'G' or 'F'")
        atom = self._atom(match)
        self.advance()
        return atom

    def _deeper(self, depth: int) -> None:
        if depth > MAX_DEPTH:
            raise MissionError(f"formula '{self._text[:40]}…' is nested deeper than {MAX_DEPTH}: split it into rules")

    def _atom(self, match: re.Match[str]) -> Formula:
        name, inside = match.group("name"), [part.strip() for part in match.group("inside").split(",")]
        if name not in {a.value for a in About}:
            raise UnknownNameError("proposition", name, [a.value for a in About])
        about = About(name)
        wanted = 2 if about is About.WITHIN else 1
        if len(inside) != wanted or not all(inside):
            form = "within(NAME, METRES)" if about is About.WITHIN else f"{name}(NAME)"
            raise MissionError(f"'{match.group('atom')}', column {self._at + 1}: write {form}")
        return Atom(Proposition(about=about, subject=inside[0], metres=_metres(inside[1]) if wanted == 2 else 0.0))


def _joined(sign: str, left: Formula, right: Formula) -> Formula:
    match sign:
        case "->":
            return Or(negated(left), right)
        case "&":
            return And(left, right)
        case "|":
            return Or(left, right)
        case "U":
            return Until(left, right)
        case _:
            return Release(left, right)


def _metres(text: str) -> float:
    try:
        value = float(text.removesuffix("m").strip())
    except ValueError:
        value = -1.0
    if not 0 < value <= 100:
        raise MissionError(f"within(…, {text}): a number of metres above 0 and at most 100 is wanted")
    return value
