"""Answers to a choice: by number, by words, by attributes; and nothing else (method, sections 12 and 13)."""

from __future__ import annotations

from dataclasses import replace

import pytest

from mintpilot.assembly.sample_question import BOXES, target_gap
from mintpilot.core.gap import BLOCKED, PASSABLE, GapKind, KnowledgeGap
from mintpilot.core.query import Answer, Question, Reply, Standing
from mintpilot.core.reading import AnsweredBy, guarded_replies
from mintpilot.elicitation.choices import choices_about
from mintpilot.elicitation.wording import word_question
from mintpilot.interaction.answers import answer_of
from mintpilot.language.answers import read_answer

GAP = target_gap(BOXES)


def asked(*gaps: KnowledgeGap) -> Question:
    query = next(iter(choices_about(gaps)))
    return word_question(query, gaps, None)


def cloud(name: str) -> KnowledgeGap:
    return KnowledgeGap(
        id=f"obstacle:{name}", kind=GapKind.OBSTACLE, subject=name, description=f"the {name} smoke",
        values=(PASSABLE, BLOCKED), prior=(0.5, 0.5), position_m=(0.0, 0.0, 0.0),
    )  # fmt: skip


BOX, CLOUDS = asked(GAP), asked(cloud("grey"), cloud("white"))


def read(text: str, question: Question = BOX, lang: str = "en", by: str = "typed", pending: Reply | None = None):
    return read_answer(text, question, guarded=guarded_replies(question), lang=lang, by=AnsweredBy(by), pending=pending)


def test_the_options_are_in_the_question_with_their_numbers() -> None:
    wanted = "Which one do you mean: 1 the small red box, 2 the large blue box or 3 the small blue box?"
    assert BOX.text == wanted
    assert CLOUDS.text == (
        "Which is safe to fly through: 1 both, 2 only the grey smoke, 3 only the white smoke or 4 neither?"
    )


@pytest.mark.parametrize(
    ("text", "lang", "label"),
    [("2", "en", "option:2"), ("two", "en", "option:2"), ("Option 3, please.", "en", "option:3"),
     ("the second one", "en", "option:2"), ("first", "en", "option:1"), ("number one", "en", "option:1"),
     ("die zweite", "de", "option:2"), ("Nummer drei", "de", "option:3"), ("le premier", "fr", "option:1"),
     ("deux", "fr", "option:2"), ("la tercera", "es", "option:3"), ("opción dos", "es", "option:2"),
     ("I don't know", "en", "unsure"), ("?", "en", "unsure"), ("stop", "en", "order:hold"), ("why", "en", "why"),
     ("the red one", "en", "evidence:colour=red"), ("the small red box", "en", "evidence:size=small,colour=red")],
)  # fmt: skip
def test_what_names_an_option(text: str, lang: str, label: str) -> None:
    assert read(text, lang=lang).label == label


@pytest.mark.parametrize(
    "text",
    ["yes", "no", "4", "2?", "not 2", "2 or 3", "maybe 2", "the one", "twenty", "2 🙂", "2 if it is red",
     "I said 2 not 3", "2 ...", "two three", "box", "1.5", "none of these"],
)  # fmt: skip
def test_what_names_none_is_asked_again(text: str) -> None:
    assert read(text).label == "again"


@pytest.mark.parametrize(
    ("text", "label"),
    [("4", "option:4"), ("both", "read-back:option:1"), ("only the grey smoke", "read-back:option:2"),
     ("neither", "option:4"), ("none of them", "option:4"), ("both?", "again"), ("the grey smoke", "again"),
     ("safe", "again"), ("both are burning", "again")],
)  # fmt: skip
def test_what_is_safe_of_two(text: str, label: str) -> None:
    assert read(text, CLOUDS).label == label


@pytest.mark.parametrize(("key", "label"), [("1", "option:1"), ("4", "again"), ("y", "again"), ("?", "unsure")])
def test_keys(key: str, label: str) -> None:
    assert read(key, by="key").label == label


def test_an_answer_names_the_part_and_how_far_it_may_be_relied_on() -> None:
    def answer(text: str, question: Question = BOX, by: str = "typed") -> Answer:
        return answer_of(read(text, question, by=by), text, question, by=AnsweredBy(by))

    assert (answer("2").option, answer("2").standing) == (1, Standing.PLAIN)
    red = answer("the red one")
    assert (red.reply, red.option, red.standing) == (Reply.OPTION, 0, Standing.UNCONFIRMED)
    assert red.also[0].query.gap_ids == (GAP.id,)
    blue = answer("the blue one")
    assert (blue.reply, blue.part) == (Reply.UNSURE, None)
    assert answer("both", CLOUDS).standing is Standing.UNCONFIRMED
    assert answer("yes").part is None


@pytest.mark.parametrize(("by", "word"), [("typed", "yes"), ("voice", "confirm")])
def test_what_was_read_back_is_confirmed_or_dropped(by: str, word: str) -> None:
    pending = Answer(reply=Reply.OPTION, option=0, latency_s=1.0, standing=Standing.UNCONFIRMED)
    put = replace(CLOUDS, read_back=pending)
    said = answer_of(read(word, put, by=by, pending=Reply.OPTION), word, put, by=AnsweredBy(by))
    assert (said.option, said.standing) == (0, Standing.CONFIRMED)
    for other in ("no", "2", "maybe", "the grey one", "yes" if by == "voice" else "confirm it"):
        assert read(other, put, by=by, pending=Reply.OPTION).label == "again"


def test_no_language_model_has_a_say_in_a_choice() -> None:
    from mintpilot.language.answer_model import read_with_model
    from mintpilot.models.doubles import NoModel

    class Eager(NoModel):
        def complete(self, *_: object, **__: object):
            raise AssertionError("it was asked")

    reading = read_with_model("big fat affirmative", BOX, Eager(), guarded=guarded_replies(BOX))
    assert reading.label == "again"
