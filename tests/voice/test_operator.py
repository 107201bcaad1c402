"""What may and may not be answered or ordered by voice (method, section 12), with doubles for speech and hearing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.language.test_options import BOX as CHOICE

from mintpilot.assembly.sample_question import sample_question
from mintpilot.assembly.talk import Talk
from mintpilot.conformance.operator import check_operator
from mintpilot.core.errors import DeviceError
from mintpilot.core.gap import GapKind
from mintpilot.core.geometry import Floats
from mintpilot.core.inputs import Answered, MoreTimeWanted, OperatorInput, Ordered, QuestionShown
from mintpilot.core.query import Answer, Order, Question, Reply, Standing
from mintpilot.voice.doubles import ActivityDouble, RecogniserDouble, SpeechDouble
from mintpilot.voice.hearing import Ear
from mintpilot.voice.operator import VoiceOperator, VoiceParts
from mintpilot.voice.ports import RATE_HZ, SoundLink

WORDS = (
    "yes", "no", "confirm", "stop", "land", "come back", "continue", "stand by", "I don't know", "maybe", "say again",
    "why", "banana", "affirmative", "okay", "two",
)  # fmt: skip


class Room(SoundLink):
    """Somebody says words; what the drone plays takes as long as it is."""

    def __init__(self) -> None:
        self.until_s = -1.0
        self.waiting: list[Floats] = []
        self.stops = self.plays = 0
        self.is_gone = False

    def play(self, samples: Floats, time_s: float) -> None:
        self.plays += 1
        self.until_s = time_s + len(samples) / RATE_HZ

    def stop(self) -> None:
        self.stops += 1
        self.until_s = -1.0

    def is_playing(self, time_s: float) -> bool:
        return time_s < self.until_s

    def listen(self, time_s: float) -> Sequence[Floats]:
        if self.is_gone:
            raise DeviceError("unplugged")
        found, self.waiting = self.waiting, []
        return found

    def close(self) -> None: ...


class Scene:
    """A voice operator in a room, with a clock."""

    def __init__(self, *, taken: dict[str, str] | None = None, lang: str = "en") -> None:
        self.room, self.talk, self.captions = Room(), Talk(lang=lang), list[str]()
        parts = VoiceParts(
            speech=SpeechDouble(),
            ear=Ear(first=RecogniserDouble(WORDS), second=RecogniserDouble(WORDS, taken)),
            activity=ActivityDouble(),
            link=self.room,
        )
        self.operator = VoiceOperator(
            parts, understand=self.talk.understand, order_of=self.talk.order_of, caption=self.captions.append,
            lang=lang, is_patient=True,
        )  # fmt: skip
        self.time_s = 0.0

    def passes(self, seconds: float = 2.0) -> list[OperatorInput]:
        events: list[OperatorInput] = []
        for _ in range(int(seconds / 0.25)):
            self.time_s += 0.25
            events += self.operator.poll(self.time_s)
        return events

    def says(self, words: str) -> list[OperatorInput]:
        self.room.waiting.append(np.concatenate([SpeechDouble().say(words), np.zeros(RATE_HZ)]))
        return self.passes()

    def asks(self, kind: GapKind = GapKind.OBSTACLE) -> Question:
        return self.shows(sample_question(kind))

    def shows(self, question: Question) -> Question:
        put = replace(question, id="q1")
        self.operator.show(put, 30.0)
        assert QuestionShown in [type(e) for e in self.passes(8.0)]
        return put

    def reads_back(self, question: Question, reply: Reply = Reply.YES) -> None:
        pending = Answer(reply=reply, latency_s=1.0, by="voice", standing=Standing.UNCONFIRMED)
        self.operator.show(replace(question, read_back=pending), 30.0)
        assert self.passes() == []


@pytest.fixture
def scene() -> Iterator[Scene]:
    made = Scene()
    yield made
    made.operator.close()


def _answers(events: list[OperatorInput]) -> list[Answer]:
    return [event.answer for event in events if isinstance(event, Answered)]


def _orders(events: list[OperatorInput]) -> list[Order]:
    return [event.order for event in events if isinstance(event, Ordered)]


def test_a_guarded_yes_is_unconfirmed_and_a_second_yes_never_confirms_it(scene: Scene) -> None:
    question = scene.asks()
    (answer,) = _answers(scene.says("yes"))
    assert (answer.reply, answer.standing, answer.by) == (Reply.YES, Standing.UNCONFIRMED, "voice")
    scene.reads_back(question)
    assert _answers(scene.says("yes")) == []


def test_confirm_confirms_what_was_read_back_and_nothing_before_that(scene: Scene) -> None:
    question = scene.asks()
    assert not any(answer.part is not None for answer in _answers(scene.says("confirm")))
    scene.reads_back(question)
    (answer,) = _answers(scene.says("confirm"))
    assert (answer.reply, answer.standing) == (Reply.YES, Standing.CONFIRMED)


def test_an_option_is_read_back_with_its_number_and_needs_the_word_confirm(scene: Scene) -> None:
    scene.shows(CHOICE)
    (answer,) = _answers(scene.says("two"))
    assert (answer.option, answer.by) == (1, "voice")
    scene.operator.show(replace(CHOICE, id="q1", read_back=answer), 30.0)
    assert _answers(scene.passes(6.0)) == []
    assert scene.captions[-1].startswith("I understood 2, the large blue box")
    assert _answers(scene.says("yes")) == []
    scene.passes(6.0)
    (confirmed,) = _answers(scene.says("confirm"))
    assert (confirmed.option, confirmed.standing) == (1, Standing.CONFIRMED)


def test_a_no_that_adds_caution_counts_at_once(scene: Scene) -> None:
    scene.asks()
    (answer,) = _answers(scene.says("no"))
    assert (answer.reply, answer.standing) == (Reply.NO, Standing.PLAIN)


@pytest.mark.parametrize(("first", "second"), [("yes", "no"), ("yes", "banana"), ("confirm", "continue")])
def test_what_the_recognisers_do_not_read_alike_is_asked_again_once_and_then_unsure(first: str, second: str) -> None:
    scene = Scene(taken={first: second})
    question = scene.asks()
    scene.reads_back(question)
    assert scene.says(first) == []
    (answer,) = _answers(scene.says(first))
    assert answer.reply is Reply.UNSURE
    scene.operator.close()


def test_stop_counts_at_once_even_into_the_drones_own_speech_and_if_one_recogniser_hears_it() -> None:
    for taken in ({}, {"stop": "banana"}, {"banana": "stop"}):
        scene = Scene(taken=taken)
        scene.operator.tell("I fly to the blue box.")
        scene.operator.poll(scene.time_s)
        assert scene.room.is_playing(scene.time_s)
        said = "banana" if "banana" in taken else "stop"
        scene.room.waiting.append(np.concatenate([SpeechDouble().say(said), np.zeros(RATE_HZ)]))
        assert _orders(list(scene.operator.poll(scene.time_s))) == [Order.HOLD]
        assert not scene.room.is_playing(scene.time_s)
        scene.operator.close()


@pytest.mark.parametrize(("words", "order"), [("come back", Order.RETURN), ("land", Order.LAND)])
def test_come_back_and_land_hold_first_and_wait_for_confirm(scene: Scene, words: str, order: Order) -> None:
    assert _orders(scene.says(words)) == [Order.HOLD]
    assert _orders(scene.says("yes")) == []
    assert _orders(scene.says("confirm")) == [order]


def test_an_order_that_is_denied_or_not_confirmed_in_time_is_forgotten(scene: Scene) -> None:
    scene.says("land")
    scene.says("no")
    assert _orders(scene.says("confirm")) == []
    scene.says("land")
    scene.passes(20.0)
    assert _orders(scene.says("confirm")) == []


def test_stand_by_asks_for_time(scene: Scene) -> None:
    scene.asks()
    assert [type(event) for event in scene.says("stand by")] == [MoreTimeWanted]


def test_speaking_into_the_question_stops_it_answers_nothing_and_it_is_asked_again(scene: Scene) -> None:
    scene.operator.show(replace(sample_question(GapKind.OBSTACLE), id="q1"), 30.0)
    scene.operator.poll(0.0)
    assert scene.room.is_playing(0.0)
    events = scene.says("no")
    assert scene.room.stops >= 1
    assert _answers(events) == []
    assert scene.room.plays >= 2
    assert len(_answers(scene.says("no"))) == 1


def test_an_answer_over_a_notice_after_the_question_counts(scene: Scene) -> None:
    scene.asks()
    scene.operator.tell("I hold.")
    scene.passes(0.25)
    assert scene.room.is_playing(scene.time_s)
    assert len(_answers(scene.says("no"))) == 1


def test_the_question_and_its_read_back_are_each_asked_once_more(scene: Scene) -> None:
    question = scene.asks()
    assert scene.says("banana") == []
    assert len(_answers(scene.says("yes"))) == 1
    scene.reads_back(question)
    assert scene.says("banana") == []
    assert len(_answers(scene.says("confirm"))) == 1


def test_a_noise_into_the_question_does_not_leave_it_unasked(scene: Scene) -> None:
    scene.operator.show(replace(sample_question(GapKind.OBSTACLE), id="q1"), 30.0)
    scene.operator.poll(0.0)
    assert [type(event) for event in scene.says("a sound that nobody knows")] == [QuestionShown]
    assert scene.room.plays == 2


def test_a_microphone_that_is_unplugged_is_said_once_and_survived(scene: Scene) -> None:
    scene.asks()
    scene.room.is_gone = True
    assert scene.passes() == []
    assert sum("cannot hear you" in caption for caption in scene.captions) == 1


def test_muted_a_question_takes_as_long_as_reading_it_and_what_is_said_meanwhile_answers_nothing() -> None:
    scene = Scene()
    scene.operator.settings.muted = True
    scene.operator.show(replace(sample_question(GapKind.OBSTACLE), id="q1"), 30.0)
    scene.operator.poll(0.0)
    assert scene.room.is_playing(0.0)
    assert _answers(scene.says("no")) == []
    assert len(_answers(scene.says("no"))) == 1
    scene.operator.close()


def test_beside_a_screen_what_is_not_understood_twice_is_left_to_it(scene: Scene) -> None:
    scene.operator._has_screen = True
    scene.asks()
    assert scene.says("banana") == []
    assert scene.says("banana") == []
    assert "on the screen" in scene.captions[-1]
    assert scene.says("no") == []
    assert _orders(scene.says("stop")) == [Order.HOLD]


def test_in_other_languages_only_keys_answer() -> None:
    scene = Scene(lang="de")
    scene.asks()
    assert scene.says("yes") == scene.says("no") == []
    assert _orders(scene.says("stop")) == [Order.HOLD]
    scene.operator.close()


def test_it_keeps_the_contract_of_operators() -> None:
    made: list[Scene] = []

    def make() -> VoiceOperator:
        made.append(Scene())
        return made[-1].operator

    check_operator(make)
    for scene in made:
        scene.operator.close()


@settings(max_examples=6, deadline=None)
@given(st.lists(st.sampled_from([w for w in WORDS if w != "confirm"]), max_size=3))
def test_nothing_but_confirm_ever_confirms(said: list[str]) -> None:
    scene = Scene()
    question = scene.asks()
    scene.reads_back(question)
    found = [answer for words in said for answer in _answers(scene.says(words))]
    assert all(answer.standing is not Standing.CONFIRMED for answer in found)
    scene.operator.close()
