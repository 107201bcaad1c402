"""Real-sounding answers with what they say, into data/answers.tsv. `python -m bench.answer_list`.

Phrases were written down, and this list was generated and committed, before the rules that read it were written.
Each phrase appears as it is and in variants: with a word before or after it, other marks, capitals, a slip of typing.
None of the variants changes what is said.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

DATA = Path(__file__).resolve().parent / "data"
PHRASES = DATA / "answer_phrases.txt"
ANSWERS = DATA / "answers.tsv"
KINDS = ("obstacle", "presence", "target")
HEADER = "# text\tkind of question\tlanguage\twhat it says\tstyle"
_SEED = 20261128
_VARIANTS = 2
"""Beside the phrase as it is."""
_BEFORE = {
    "en": ("uh, ", "well, ", "okay, ", "listen, ", "hey drone, ", "sorry, ", "um ", "so ", "right, ", "hi, "),
    "de": ("äh, ", "also ", "okay, ", "hör zu, ", "Drohne, ", "Entschuldigung, ", "hm, ", "tja, ", "gut, "),
    "fr": ("euh, ", "bon, ", "ok, ", "écoute, ", "drone, ", "désolé, ", "alors ", "eh bien, ", "bonjour, "),
    "es": ("eh, ", "bueno, ", "vale, ", "oye, ", "dron, ", "perdón, ", "pues ", "mira, ", "hola, "),
}
_AFTER = {
    "en": (
        ", over",
        ", thanks",
        ", sorry",
        ", mate",
        " okay",
        ", bye",
        ", all right",
        " I'm telling you",
        "!",
        "...",
        ".",
    ),
    "de": (", danke", ", sorry", ", tschüss", ", okay", ", Ende", "!", "...", ".", ", ehrlich"),
    "fr": (", merci", ", désolé", ", salut", ", ok", ", terminé", " !", "...", ".", ", d'accord"),
    "es": (", gracias", ", perdón", ", adiós", ", vale", ", cambio", "!", "...", ".", ", de verdad"),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Said:
    """One answer of the list."""

    text: str
    kind: str
    lang: str
    says: str
    """``yes``, ``no``, ``unsure``, ``order:…``, ``evidence:…``, a question back, or ``none``: it settles nothing."""
    style: str


def read(path: Path = ANSWERS) -> list[Said]:
    """The answers of a list."""
    rows = (line.split("\t") for line in path.read_text("utf-8").splitlines() if line and not line.startswith("#"))
    return [Said(text=text, kind=kind, lang=lang, says=says, style=style) for text, kind, lang, says, style in rows]


def generate(rng: random.Random) -> Iterator[Said]:
    """Every phrase for every kind of question that it may answer, with its variants."""
    seen = set()
    for phrase in _phrases():
        texts = [phrase.text, *(_variant(phrase.text, phrase.lang, rng) for _ in range(_VARIANTS))]
        for kind in KINDS if phrase.kind == "*" else (phrase.kind,):
            for text in texts if kind == KINDS[0] or phrase.kind != "*" else (phrase.text, _variant(*_of(phrase), rng)):
                if (text, kind, phrase.lang) not in seen:
                    seen.add((text, kind, phrase.lang))
                    yield Said(text=text, kind=kind, lang=phrase.lang, says=phrase.says, style=phrase.style)


def _of(phrase: Said) -> tuple[str, str]:
    return phrase.text, phrase.lang


def _phrases() -> Iterator[Said]:
    for line in PHRASES.read_text("utf-8").splitlines():
        if line.startswith("["):
            kind, lang, says, style = line.strip("[]").split()
        elif line and not line.startswith("#"):
            yield Said(text=line, kind=kind, lang=lang, says=says, style=style)


def _variant(text: str, lang: str, rng: random.Random) -> str:
    way = rng.randrange(5)
    asks = text.endswith("?")
    if way == 0:
        return rng.choice(_BEFORE[lang]) + text
    if way == 1 and not asks:
        return text + rng.choice(_AFTER[lang])
    if way == 2 and not asks:
        return rng.choice(_BEFORE[lang]) + text + rng.choice(_AFTER[lang])
    if way == 3:
        return rng.choice((text.upper(), text.capitalize(), text.lower()))
    return _slip(text, rng)


def _slip(text: str, rng: random.Random) -> str:
    """Two letters swapped, one left out, or one doubled, in a word of four letters and more."""
    words = text.split(" ")
    long = [i for i, word in enumerate(words) if len(word) >= 4 and word.isalpha()]
    if not long:
        return text.upper()
    at = rng.choice(long)
    word, i = words[at], rng.randrange(1, len(words[at]) - 1)
    slips = word[:i] + word[i + 1] + word[i] + word[i + 2 :], word[:i] + word[i + 1 :], word[:i] + word[i] + word[i:]
    words[at] = rng.choice(slips)
    return " ".join(words)


def main() -> None:
    rows = [f"{s.text}\t{s.kind}\t{s.lang}\t{s.says}\t{s.style}" for s in generate(random.Random(_SEED))]
    ANSWERS.write_text("\n".join((HEADER, *rows, "")), "utf-8")
    print(f"{len(rows)} answers in {ANSWERS}")


if __name__ == "__main__":
    main()
