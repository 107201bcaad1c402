"""An answer as classes of words: contractions opened, slips of typing and hearing mended, the longest phrase first."""

from __future__ import annotations

import re
from collections import defaultdict
from functools import cache

from mintpilot.core.gap import GapKind
from mintpilot.language.answer_kinds import Atom, Kind
from mintpilot.language.answer_words import ATTITUDES
from mintpilot.language.answer_world import PRODUCTS, STATES
from mintpilot.language.slips import is_slip, key_word

_ABOUT_WAYS = frozenset((Kind.THROUGH, Kind.AROUND, Kind.SAFE, Kind.DANGER, Kind.HAZARD, Kind.BENIGN))
_ABOUT_PEOPLE = frozenset(
    (
        *(Kind.PERSON, Kind.ONE, Kind.EVERYBODY, Kind.SOME, Kind.INSIDE, Kind.OUT, Kind.LEFT, Kind.TRAPPED),
        *(Kind.BYSTANDING, Kind.THING, Kind.EMPTY, Kind.OCCUPIED, Kind.TRACE, Kind.PERCEIVE, Kind.NUMBER, Kind.EXIST),
    )
)
_UNHEARD: dict[GapKind, frozenset[Kind]] = {
    GapKind.OBSTACLE: _ABOUT_PEOPLE,
    GapKind.PRESENCE: _ABOUT_WAYS | {Kind.AGREE, Kind.RISK},
    GapKind.TARGET: _ABOUT_WAYS | _ABOUT_PEOPLE | {Kind.ELSEWHERE, Kind.CLEAR, Kind.PAST},
    GapKind.VALUE: _ABOUT_WAYS | _ABOUT_PEOPLE | {Kind.ELSEWHERE, Kind.CLEAR, Kind.PAST},
}
"""Classes that say nothing about the kind of thing that was asked."""
_FOREIGN = frozenset(
    (
        Kind.DANGER,
        Kind.HAZARD,
        Kind.BENIGN,
        Kind.PERSON,
        Kind.ONE,
        Kind.EVERYBODY,
        Kind.TRACE,
        Kind.THING,
        Kind.BYSTANDING,
    )
)
"""Of these, the ones that make an answer one about something else."""

_OPEN = (
    (r"\b(is|are|was|were|do|does|did|have|has|would|could|should)(?:n'|'n|'nt|nt')(?: ?t)?\b", r"\1 not"),
    (r"^(?:yeah|yes|ok|okay|right|well|oh|and) so (?!far\b)|^so (?:yeah|yes) (?=\w+ \w)", ""),
    (r"(?<!is)(?<!re)(?<!be)(?<!yeah)(?<!yes)(?<!oh)(?<!looks)(?<!seems)(?<!it)(?<!all)(?<!the)(?<!on)(?<!to)"
     r"(?<=\w) (?:ok|okay|right)$", ""),
    (r"\bcan ?n[o']t\b|\bcant\b|\bcannot\b|\bcan't\b", "can not"), (r"\bwon'?t\b", "will not"),
    (r"\b(?:visibility|temperatures?|heat)(?=(?: and (?:the )?\w+)? (?:is|are|looks) (?:all |very |perfectly )?"
     r"(?:fine|good|ok|great|normal|perfect)\b)", "measurement"),
    (r"^(yes|yeah|yep|no|nope|nah|negative|affirmative)[ ,]+(?:my (?:dear|love|darling|friend|boy|girl|lad)|sweetheart"
     r"|honey|hon|darling|sugar|pet|doctor|nurse|officer|captain|bro|bruv|guys|madam|ma'am)(?=\s*[,.!])", r"\1"),
    (r"^(?:ja|jawohl|oui|s[i\N{LATIN SMALL LETTER I WITH ACUTE}]|da)"
     r"(?= *$|[,.! ]+(?:yes|is|it|that|this|the|you|go|please)\b)", "yes"),
    (r"^yes,? hello", "yes hello"),
    (r"\bcould not (?=(?:get|find|reach|leave|make it)\b)", "can not "),
    (r"\bshan'?t\b", "shall not"), (r"\bain'?t\b", "is not"), (r"\b(\w+)n't\b", r"\1 not"),
    (r"\b(do|does|did|is|are|was|were|has|have|had|would|could|should|must|need)nt\b", r"\1 not"),
    (r"\b(isn|don|doesn|didn|wasn|wouldn|shouldn|couldn) t\b", r"\1't"), (r"\b(\w+)n't\b", r"\1 not"),
    (r"\blet'?s\b", "let us"), (r"\b(\w+)'s\b", r"\1 is"), (r"\b(\w+)'m\b", r"\1 am"), (r"\b(\w+)'re\b", r"\1 are"),
    (r"\b(\w+)'ve\b", r"\1 have"), (r"\b(\w+)'ll\b", r"\1 will"), (r"\b(\w+)'d\b", r"\1 would"),
    (r"\b(it|that|there|he|she|what|who|nobody|somebody|someone|everyone|everybody|noone)s\b", r"\1 is"),
    (r"\bim\b(?! pass)", "i am"), (r"\bive\b", "i have"), (r"\bid\b", "i would"),
    (r"\b(they|you|we)(?:re)\b", r"\1 are"), (r"\bidk\b|\bdunno\b|\bdunnno\b", "do not know"),
    (r"\bgonna\b", "going to"), (r"\bgotta\b", "got to"), (r"\blemme\b", "let me"), (r"\bgimme\b", "give me"),
    (r"\bthru\b|\bthrew\b", "through"), (r"\b(?:tho|thou)\b", "though"),
    (r"\b(?:cuz|cos|coz|bc|cause)\b", "because"), (r"\bprolly\b|\bprobs\b", "probably"),
    (r"\bdef(?:o|initly)?\b", "definitely"), (r"\b(?:k|kk|okay|okey|okie|oki|oke|o k)\b", "ok"), (r"\bu\b", "you"),
    (r"\bur\b", "your"), (r"\by'?all\b", "you"), (r"\b(?:im|in|um) ?passable\b|\bimpassible\b", "impassable"),
    (r"\b(?:on|un|an) ?(?:safe|save)\b", "unsafe"), (r"\b(is|not|be|are|all) save\b", r"\1 safe"),
    (r"\bon ?(?:certain|sure|clear)\b", "unsure"), (r"\ba void\b", "avoid"), (r"\bneg\b", "negative"),
    (r"\bdo not (?:no|now)\b$", "do not know"), (r"^right (?=(?:go|fly|ok|yes|then|so|proceed)\b)", ""),
    (r"^(?:know|knows)\b(?= *$| *[,.;!]| it | do )", "no"), (r"\bknow way\b", "no way"),
    (r"\bnot (?:all )?(?:that|so|too) (?=bad|dangerous|toxic|risky|hot|thick|safe|harmful|severe"
     r"|dense|hazardous|poison)", "not particularly "),
    (r"^(?:ok|all ?right|right|well|oh)[ ,]+(?=no\b(?: *$| *[,.;!]| (?:it|that|not)\b))", ""),
    (r"\bnone other than\b", ""), (r"\b(?:stopp|sttop|stpo|sotp)\b", "stop"),
    (r"\bsafe to (?:(?:fly|go|pass|move|travel) (?:through|across|into|in(?= *$| *[,.;!]))|enter|cross)\b", "safe"),
    (r"\bno ?where\b", "nowhere"), (r"\bany ?(body|one)\b", r"any\1"), (r"\bsome ?(body|one)\b(?! of)", r"some\1"),
    (r"\bevery ?(body|one)\b(?! of)", r"every\1"), (r"\bno body\b", "nobody"), (r"\bnot? idea\b", "no idea"),
)  # fmt: skip
_SIGNS = {"\N{THUMBS UP SIGN}": " yes ", "\N{THUMBS DOWN SIGN}": " no ", "\N{CROSS MARK}": " no ", "%": " percent ",
          "\N{RIGHT SINGLE QUOTATION MARK}": "'", "\N{EM DASH}": " , ", "\N{EN DASH}": " , ", " - ": " , ", "--": " , ",
          "...": " , ", "\N{HORIZONTAL ELLIPSIS}": " , ", "-": " ", ":": " , "}  # fmt: skip
_AT_END = {"in": Kind.INSIDE, "what": Kind.UNSURE, "sorry": Kind.UNSURE, "right": Kind.YES, "again": Kind.UNSURE,
           "go": Kind.AGREE, "pass": Kind.UNSURE, "no": Kind.NO, "help": Kind.UNSURE}  # fmt: skip
"""Words that say something only where nothing follows; all but ``in`` only where nothing goes before either."""
_ENDING = frozenset(
    tuple(phrase.split())
    for phrase in (
        "it is", "it does", "i do", "you can", "you may", "you should",
        "please do", "that is", "it should", "bang on", "dead on", "absolutely not", "of course not",
    )
)  # fmt: skip
_JUDGING = frozenset((("good",), ("fine",)))
"""Consent only where they are the whole of what is said: not in ``good morning``."""
_AFTER_JUDGING = frozenset(["to", "go", "by", "with", "then", "now", "thanks", "so", "for", "we", "you", "just"])
_AUXILIARY = frozenset(["can", "may", "should", "is", "are", "do", "does", "did", "will", "would", "could", "must"])
_AFTER_ONE = frozenset(
    word
    for words in (
        "yes yeah please there right here thanks thank then now sir mate love dear i we it that you and",
        "exactly definitely for with by on in next near behind beside under of to from at such as indeed",
        "not no",
        ", . ; ! ?",
    )
    for word in words.split()
)
"""What may follow ``that one`` as consent; ``that one is full of nails`` is none."""
_BEFORE_ON_IT = frozenset(["am", "are", "is", ",", ".", ";", "!", "?"])
"""What stands before ``on it`` where it asks for time; not in ``the one with a label on it``."""
_ON_COURSE = frozenset(
    ("now", "please", "then", "slowly", "carefully", "safely", "there", "through", "in", "ahead", "on", "thanks", "sir")
)
"""What may follow ``you can go`` as consent to the way asked about; ``please go around it`` is none."""
_NOT_EVERY = frozenset(("i", "we", "you", "except", "but"))
"""What makes only some of ``everybody``: ``all the people I know``."""
_SHORTEST_MENDED = 6
_MENDED = frozenset((Kind.DANGER, Kind.HAZARD, Kind.NO, Kind.CONDITION, Kind.NOBODY))
_MENDED_LONG = _MENDED | {Kind.UNSURE, Kind.SAFE, Kind.YES, Kind.BOOST, Kind.LIKELY, Kind.EMPTY}
"""A slip in a word for consent is only mended where the word is long: a false Yes is worse than asking again."""


def plain(text: str) -> str:
    """In lower case, contractions opened, marks of punctuation apart."""
    words = text.lower()
    for sign, said in _SIGNS.items():
        words = words.replace(sign, said)
    words = re.sub(r"[^\w\s',.;!?]", " ", words)
    words = re.sub(r"([a-z])\1{2,}", r"\1", words)
    for pattern, said in _OPEN:
        words = re.sub(pattern, said, words)
    return " ".join(re.sub(r"\s*([,.;!?])\s*", r" \1 ", words.replace("'", " ")).split()).strip(" ,.;!")


def atoms(words: str, about: GapKind, known: frozenset[str] = frozenset()) -> list[Atom]:
    """The answer in classes.

    Args:
        words: as `plain` gives them.
        about: what kind of thing was asked; words about other things say nothing.
        known: words of the question, which are not strange in an answer.
    """
    tokens, found, at = words.split(), list[Atom](), 0
    index = _index(about)
    while at < len(tokens):
        token = tokens[at]
        if token in ",.;!?":
            found.append(Atom(Kind.BREAK, token))
            at += 1
            continue
        alone = at + 1 == len(tokens) or tokens[at + 1] in ",.;!?"
        if alone and token in _AT_END and (token == "in" or not found or found[-1].kind in (Kind.BREAK, Kind.YES)):
            kind = _AT_END[token]
            found.append(Atom(kind if kind not in _UNHEARD[about] else Kind.NOISE, token))
            at += 1
            continue
        phrase = next((p for p in index.get(token, ()) if _fits(p, tokens, at, _kinds(about)[p])), None)
        if phrase is not None:
            kind = _kinds(about)[phrase]
            is_asked = kind is Kind.STRANGE and known.issuperset(phrase)
            found.append(Atom(Kind.NOISE if is_asked else kind, " ".join(phrase)))
            at += len(phrase)
            continue
        mended = _mend(token, about) if token not in known else None
        kind = mended or (Kind.NOISE if token in known else Kind.STRANGE)
        found.append(Atom(kind, token, is_mended=mended is not None))
        at += 1
    return found


def _fits(phrase: tuple[str, ...], tokens: list[str], at: int, kind: Kind) -> bool:
    """Whether the phrase stands there; consent does not where ``not`` follows it: ``you can not``."""
    end = at + len(phrase)
    if tokens[at:end] != list(phrase):
        return False
    ends = end == len(tokens) or tokens[end] in ",.;!?"
    if (phrase in _ENDING and not ends) or (phrase in _JUDGING and not (ends or tokens[end] in _AFTER_JUDGING)):
        return False
    is_denied = (
        kind in (Kind.YES, Kind.AGREE, Kind.BOOST) and tokens[end : end + 1] == ["not"] and phrase[-1] in _AUXILIARY
    )
    is_told = phrase[-1] == "one" and len(phrase) == 2 and not ends and tokens[end] not in _AFTER_ONE
    is_told &= kind is Kind.YES
    is_part = phrase == ("on", "it") and at > 0 and tokens[at - 1] not in _BEFORE_ON_IT
    is_sent_off = kind is Kind.AGREE and phrase[-1] == "go" != phrase[0] and not ends
    is_sent_off &= ends or tokens[end] not in _ON_COURSE
    is_some = kind is Kind.EVERYBODY and not ends and tokens[end] in _NOT_EVERY
    return not (is_denied or is_told or is_part or is_sent_off or is_some)


@cache
def _kinds(about: GapKind) -> dict[tuple[str, ...], Kind]:
    kinds: dict[tuple[str, ...], Kind] = {}
    unheard = _UNHEARD[about]
    for phrases, is_heard in ((_all(), True), (_all(), False)):
        for phrase, kind in phrases:
            if (kind not in unheard) is is_heard:
                kinds.setdefault(phrase, kind if is_heard else Kind.STRANGE if kind in _FOREIGN else Kind.NOISE)
    return kinds


@cache
def _all() -> tuple[tuple[tuple[str, ...], Kind], ...]:
    tables = (*STATES.items(), *ATTITUDES.items())
    made = tuple(
        ((*first.split(), *second.split()), kind)
        for kind, firsts, seconds in PRODUCTS
        for first in firsts.split("|")
        for second in seconds.split("|")
    )
    return made + tuple((tuple(p.split()), kind) for kind, text in tables for p in text.split("|") if p.strip())


@cache
def _index(about: GapKind) -> dict[str, list[tuple[str, ...]]]:
    index: dict[str, list[tuple[str, ...]]] = defaultdict(list)
    for phrase in sorted(_kinds(about), key=lambda p: (-len(p), p)):
        index[phrase[0]].append(phrase)
    return index


@cache
def _mend(token: str, about: GapKind) -> Kind | None:
    """The class of the one word that is a slip away, if all such words are of one class that may be mended."""
    if (key := key_word(token)) is not None:
        return _kinds(about).get((key,))
    if len(token) < _SHORTEST_MENDED or not token.isalpha():
        return None
    near = {
        Kind.DANGER if kind is Kind.HAZARD else kind
        for phrase, kind in _kinds(about).items()
        if len(phrase) == 1
        and len(phrase[0]) >= _SHORTEST_MENDED
        and token[0] == phrase[0][0]
        and is_slip(token, phrase[0])
    }
    allowed = _MENDED_LONG if len(token) > _SHORTEST_MENDED + 1 else _MENDED
    return near.pop() if len(near) == 1 and near <= allowed else None
