"""``mintpilot understand answer``: what answers are read as, and what they would allow."""

from __future__ import annotations

import json as jsons
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, TypeAlias

from cyclopts import Parameter

from mintpilot.cli.exits import ExitCode, guarded

if TYPE_CHECKING:
    from mintpilot.assembly.understood_answers import UnderstoodAnswer

_Flag: TypeAlias = Annotated[bool, Parameter(negative="")]
_LARGEST_FILE = 10_000_000
"""Bytes."""


def answer(
    text: str | None = None,
    /,
    *,
    kind: Literal["obstacle", "presence", "target"] = "obstacle",
    candidates: Path | None = None,
    by: Literal["key", "typed", "voice"] = "typed",
    lang: str = "en",
    file: Path | None = None,
    json: Annotated[bool, Parameter(name="--json", negative="")] = False,
    debug: _Flag = False,
) -> ExitCode:
    """Read an answer to a question of the drone: what it is read as, and what it would allow once confirmed.

    Args:
        text: The answer.
        kind: What was asked: is the smoke safe, is somebody in the room, which thing is meant.
        candidates: What is asked about: a YAML list of things (id, description, attributes), or a mission file.
            Default: grey smoke near a gate, a closed room, or three boxes.
        by: How the answer comes: a key, typed words, or spoken ones.
        lang: Language of the question: en, de, fr or es.
        file: Answers to read, one a line.
        json: Print a list with the text, reading and permissions of each answer, and nothing else, on standard output.
        debug: Show the traceback of an error.
    """

    def work() -> ExitCode:
        from mintpilot.assembly.sample_question import sample_question
        from mintpilot.assembly.understood_answers import question_from, understand_answers
        from mintpilot.core.errors import InputError
        from mintpilot.core.gap import GapKind
        from mintpilot.core.reading import AnsweredBy

        if (text is None) == (file is None):
            raise InputError("what is to be read? Give either an answer, or --file with one a line")
        asked = GapKind(kind)
        question = (
            question_from(candidates, asked, lang=lang) if candidates is not None else sample_question(asked, lang=lang)
        )
        texts = _lines(file) if file is not None else [text or ""]
        read = understand_answers(texts, question, lang=lang, by=AnsweredBy(by))
        if json:
            rows = [{"text": r.text, "reading": r.reading.label, "permissions": list(r.permissions)} for r in read]
            print(jsons.dumps(rows, ensure_ascii=False))
        else:
            print(_printable(question.text))
            print("\n".join(_told(one) for one in read))
        return ExitCode.SUCCESS

    return guarded(work, as_json=json, debug=debug)


def _lines(file: Path) -> list[str]:
    from mintpilot.core.errors import InputError

    try:
        if not file.is_file() or file.stat().st_size > _LARGEST_FILE:
            raise OSError(f"not a regular file of at most {_LARGEST_FILE} bytes")
        lines = file.read_text("utf-8").split("\n")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"answers {file} cannot be read ({error}): give a text file with one a line") from error
    return [line.removesuffix("\r") for line in lines if line.strip()]


def _told(one: UnderstoodAnswer) -> str:
    vetoes = f"  because of: {', '.join(one.reading.vetoes)}" if one.reading.vetoes else ""
    allows = f"  allows: {', '.join(one.permissions)}" if one.permissions else ""
    after = " (once confirmed)" if one.permissions and one.needs_read_back else ""
    return _printable(f"{one.text}: {one.reading.label}{allows}{after}{vetoes}")


def _printable(text: str) -> str:
    return "".join(character if character.isprintable() else " " for character in text)
