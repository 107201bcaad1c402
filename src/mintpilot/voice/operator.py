"""A person who is spoken to and listened to (method, section 12)."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace

from mintpilot.core.errors import DeviceError
from mintpilot.core.inputs import Answered, MoreTimeWanted, OperatorInput, Ordered, QuestionShown
from mintpilot.core.ports import Operator, Understand
from mintpilot.core.query import Answer, Order, Question, Reply, Standing, answer_for
from mintpilot.core.reading import AnsweredBy, Reading, ReadingKind
from mintpilot.interaction.answers import answer_of
from mintpilot.language.answers import confirmation_in, order_in
from mintpilot.voice.hearing import Ear, Hearing, Segmenter, Utterance
from mintpilot.voice.mouth import Mouth, Priority, Said, VoiceSettings
from mintpilot.voice.ports import Activity, SoundLink, Speech

NAME = "voice"
HEARD = "en"
"""The only language in which answers are heard."""
CONFIRM_S = 12.0
"""An order that was read back is forgotten when it is not confirmed within this time, seconds."""
_MOST_AT_ONCE = 4
"""Utterances that wait to be recognised; of a flood the oldest are left out."""
_CALLED = {Order.RETURN: "come back", Order.LAND: "land", Order.ABORT: "abort the mission", Order.CONTINUE: "continue"}
_NOT_UNDERSTOOD = "I did not understand."
_SAY = "Say confirm, or no."
_GIVEN_UP = "I did not understand. I take it as: you do not know."
_TO_SCREEN = "I did not understand. Please answer on the screen."


@dataclass(frozen=True, slots=True, kw_only=True)
class VoiceParts:
    """What a voice operator is made of."""

    speech: Speech | None
    """None: there are captions only."""
    ear: Ear
    activity: Activity
    link: SoundLink


@dataclass(slots=True)
class _Turn:
    """One question while it is open."""

    question: Question
    patience_s: float
    version: int = 0
    """Counts what was put for an answer: the question, its read-backs."""
    is_said: bool = False
    """Whether that was heard to its end: what is said before is no answer."""
    shown_s: float | None = None
    asked_again: bool = False

    @property
    def key(self) -> tuple[str, int] | None:
        """What somebody answers who begins to speak now; None: nothing."""
        return (self.question.id, self.version) if self.is_said else None


@dataclass(frozen=True, slots=True)
class _Heard:
    """One utterance being recognised."""

    key: tuple[str, int] | None
    """What had been asked to its end when the utterance began."""
    work: Future[tuple[Hearing, tuple[Reading, Reading] | None]]


class VoiceOperator(Operator):
    """Asks aloud and hears answers and orders. Recognition and speech have threads of their own; nothing blocks.

    An answer counts only if both recognisers' texts are read alike, and only if it began after the question was said.
    "Stop" counts if either heard it, at any time. All other orders wait for "confirm".

    Args:
        parts: speech, hearing, and the way for sound.
        understand: what heard words mean as an answer.
        order_of: the order that a whole utterance is; None: it is none.
        caption: shows everything that is said.
        heard: shows what was heard.
        lang: in which questions are spoken. In others than English only "stop" is heard; answers need a key.
        settings: volume, speed, mute.
        has_screen: whether the same person sees the question on a screen: what is not understood is left to that.
        is_patient: whether `poll` waits for its own work: for simulated people, whose time stands still meanwhile.
    """

    def __init__(
        self,
        parts: VoiceParts,
        *,
        understand: Understand,
        order_of: Callable[[str], Order | None],
        caption: Callable[[str], object] = lambda _: None,
        heard: Callable[[str], object] = lambda _: None,
        lang: str = HEARD,
        settings: VoiceSettings | None = None,
        has_screen: bool = False,
        is_patient: bool = False,
    ) -> None:
        self._parts, self._understand, self._order_of = parts, understand, order_of
        self._caption, self._show_heard, self._lang = caption, heard, lang
        self._has_screen, self._is_patient = has_screen, is_patient
        self.settings = settings or VoiceSettings()
        self._mouth = Mouth(parts.speech, parts.link, self.settings, lang=lang, is_patient=is_patient)
        self._segmenter = Segmenter(parts.activity, parts.ear.settings)
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="mintpilot hearing")
        self._turn: _Turn | None = None
        self._began: tuple[str, int] | None = None
        self._heard: deque[_Heard] = deque()
        self._to_confirm: tuple[Order, float] | None = None
        self._is_deaf = False

    @property
    def attended(self) -> bool:
        """True, but for simulated people."""
        return not self._is_patient

    @property
    def hears_once(self) -> bool:
        """True: better words are waited for before a question is said."""
        return True

    def show(self, question: Question, patience_s: float) -> None:
        """Says the question, or reads back what was understood. Better words for it are shown, not said again."""
        turn = self._turn
        if turn is None or turn.question.id != question.id:
            self._turn = turn = _Turn(question, patience_s)
            self._ask(turn, question.text)
        elif question.read_back is not None:
            turn.question, turn.asked_again = question, False
            self._ask(turn, _read_back(question, question.read_back))
        else:
            turn.question = question
            self._caption(question.text)

    def withdraw(self, question: str, why: str) -> None:  # noqa: ARG002
        """Falls silent about it."""
        if self._turn is not None and self._turn.question.id == question:
            self._turn = None
            self._mouth.hush(question)

    def tell(self, text: str) -> None:
        """Says it when nothing more important is to be said."""
        self._say(text, Priority.NOTICE)

    def poll(self, time_s: float) -> tuple[OperatorInput, ...]:
        """Goes on speaking and listening.

        A microphone that is gone is said once; the mission then goes on without answers by voice, as when nobody is
        there.
        """
        events: list[OperatorInput] = []
        for said in self._mouth.speak(time_s):
            events += self._has_said(said, time_s)
        self._listen(time_s)
        while self._heard and (self._is_patient or self._heard[0].work.done()):
            heard = self._heard.popleft()
            try:
                hearing, readings = heard.work.result()
            except DeviceError as error:
                self._say(f"I cannot hear you: {error}", Priority.NOTICE)
                continue
            events += self._react(hearing, readings, heard.key, time_s)
        return tuple(events)

    def close(self) -> None:
        """Ends threads and gives the device back. Safe to call again."""
        self._mouth.close()
        self._pool.shutdown(wait=True, cancel_futures=True)
        self._parts.link.close()
        getattr(self._parts.speech, "close", lambda: None)()

    def _say(self, text: str, priority: Priority, question: str = "") -> None:
        self._caption(text)
        self._mouth.say(Said(text=text, priority=priority, question=question))

    def _ask(self, turn: _Turn, text: str) -> None:
        """Puts something for an answer; only what is said after its end answers it."""
        turn.version, turn.is_said = turn.version + 1, False
        self._mouth.hush(turn.question.id)
        self._say(text, Priority.QUESTION, turn.question.id)

    def _has_said(self, said: Said, time_s: float) -> list[OperatorInput]:
        turn = self._turn
        if turn is None or said.question != turn.question.id:
            return []
        turn.is_said = True
        if turn.shown_s is not None:
            return []
        turn.shown_s = time_s
        return [QuestionShown(time_s=time_s, question=turn.question.id)]

    def _listen(self, time_s: float) -> None:
        """Cuts what came into utterances; somebody who begins to speak stops the drone's own speech."""
        if self._is_deaf:
            return
        try:
            pieces = self._parts.link.listen(time_s)
        except DeviceError as error:
            self._is_deaf = True
            self._say(f"I cannot hear you any more: {error}", Priority.NOTICE)
            return
        for piece in pieces:
            was_speech = self._segmenter.is_speech
            ended = self._segmenter.feed(piece)
            if not was_speech and (self._segmenter.is_speech or ended):
                self._somebody_begins(time_s)
            for utterance in ended:
                self._recognise(utterance)

    def _somebody_begins(self, time_s: float) -> None:
        turn = self._turn
        self._began = turn.key if turn is not None else None  # over a notice the question is answered all the same
        if self._parts.link.is_playing(time_s):
            self._mouth.interrupt()

    def _recognise(self, utterance: Utterance) -> None:
        while len(self._heard) >= _MOST_AT_ONCE:
            self._heard.popleft().work.cancel()
        turn, key = self._turn, self._began
        question = turn.question if turn is not None and key is not None and turn.key == key else None
        patience_s = turn.patience_s if turn is not None else 0.0
        self._heard.append(_Heard(key, self._pool.submit(self._read, utterance, question, patience_s)))

    def _read(
        self, utterance: Utterance, question: Question | None, patience_s: float
    ) -> tuple[Hearing, tuple[Reading, Reading] | None]:
        """Recognises and reads an utterance, on the thread for that."""
        hearing = self._parts.ear.hear(utterance)
        if question is None or not hearing.text or self._lang != HEARD:
            return hearing, None
        pending = question.read_back.reply if question.read_back is not None else None
        first, second = (
            self._understand(text, question, patience_s, by=AnsweredBy.VOICE, pending=pending)
            for text in (hearing.text, hearing.second)
        )
        return hearing, (first, second)

    def _react(
        self, hearing: Hearing, readings: tuple[Reading, Reading] | None, key: tuple[str, int] | None, time_s: float
    ) -> list[OperatorInput]:
        texts = (hearing.text, hearing.second)
        self._show_heard(hearing.text or "…")
        orders = [self._order_of(text) for text in texts]
        written = (*texts, *hearing.written)
        if Order.HOLD in (*orders, *map(self._order_of, written), *(order_in(text, HEARD) for text in written)):
            self._mouth.hush()
            self._to_confirm = None
            return [self._ordered(Order.HOLD, hearing.text, time_s)]
        turn = self._turn
        if not hearing.text or self._lang != HEARD:
            return [] if turn is None else self._spoke_too_soon(turn)
        if orders[0] is not None and orders[0] is orders[1] and hearing.is_sure:
            return self._hold_first(orders[0], hearing.text, time_s)
        if self._to_confirm is not None:
            return self._confirmed(hearing, time_s)
        if turn is None:
            return []
        if key is None or turn.key != key or readings is None:
            return self._spoke_too_soon(turn)
        agreed = hearing.is_sure and readings[0] == readings[1]
        return self._answer(turn, readings[0] if agreed else Reading(kind=ReadingKind.AGAIN), hearing.text, time_s)

    def _hold_first(self, order: Order, text: str, time_s: float) -> list[OperatorInput]:
        """An order other than "stop" waits for its confirmation; the drone holds meanwhile."""
        self._to_confirm = (order, time_s + CONFIRM_S)
        begins = "" if order is Order.CONTINUE else "I hold. "
        self._say(f"{begins}I understood: {_CALLED[order]}. {_SAY}", Priority.ORDER)
        return [] if order is Order.CONTINUE else [self._ordered(Order.HOLD, text, time_s)]

    def _confirmed(self, hearing: Hearing, time_s: float) -> list[OperatorInput]:
        assert self._to_confirm is not None
        order, until_s = self._to_confirm
        said = [confirmation_in(text, HEARD) for text in (hearing.text, hearing.second)]
        if time_s > until_s or said == [False, False]:
            self._to_confirm = None
            self._say("I leave it at that.", Priority.ORDER)
            return []
        if said != [True, True] or not hearing.is_sure:
            self._say(f"{_NOT_UNDERSTOOD} To {_CALLED[order]}, say confirm.", Priority.ORDER)
            return []
        self._to_confirm = None
        return [self._ordered(order, hearing.text, time_s)]

    def _spoke_too_soon(self, turn: _Turn) -> list[OperatorInput]:
        """What began before the question was said answers nothing; it is asked again where speech was cut off."""
        if not turn.is_said and not self._mouth.will_say(turn.question.id):
            self._repeat(turn)
        return []

    def _repeat(self, turn: _Turn, before: str = "", after: str = "") -> None:
        read_back = turn.question.read_back
        text = turn.question.text if read_back is None else _read_back(turn.question, read_back)
        self._ask(turn, " ".join(part for part in (before, text, after) if part))

    def _answer(self, turn: _Turn, reading: Reading, text: str, time_s: float) -> list[OperatorInput]:
        question = turn.question
        waited_s = max(0.0, time_s - (turn.shown_s if turn.shown_s is not None else time_s))
        match reading.kind:
            case ReadingKind.WAIT:
                return [MoreTimeWanted(time_s=time_s, question=question.id)]
            case ReadingKind.REPEAT | ReadingKind.WHERE | ReadingKind.SHOW:
                self._repeat(turn)
                return []
            case ReadingKind.WHY:
                self._repeat(turn, after=_why(question))
                return []
            case ReadingKind.AGAIN | ReadingKind.ORDER:
                return self._again(turn, text, time_s, waited_s)
        answer = answer_of(reading, text, question, latency_s=waited_s, by=AnsweredBy.VOICE)
        turn.is_said = False  # until it is read back, or something else is asked
        return [Answered(time_s=time_s, question=question.id, answer=answer, operator=NAME)]

    def _again(self, turn: _Turn, text: str, time_s: float, waited_s: float) -> list[OperatorInput]:
        """Asks once more; the second time it is left to the screen, or counts as not knowing."""
        if not turn.asked_again:
            turn.asked_again = True
            if turn.question.read_back is None:
                self._repeat(turn, before=_NOT_UNDERSTOOD)
            else:  # what was understood has just been said, and stands in the caption
                self._ask(turn, f"{_NOT_UNDERSTOOD} {_SAY}")
            return []
        self._turn = None
        self._say(_TO_SCREEN if self._has_screen else _GIVEN_UP, Priority.NOTICE)
        if self._has_screen:
            return []
        answer = Answer(
            reply=Reply.UNSURE, latency_s=waited_s, text=text, by="voice", understood_by="rules",
            standing=Standing.PLAIN,
        )  # fmt: skip
        return [Answered(time_s=time_s, question=turn.question.id, answer=answer, operator=NAME)]

    def _ordered(self, order: Order, text: str, time_s: float) -> Ordered:
        return Ordered(time_s=time_s, order=order, operator=NAME, text=text)


def _read_back(question: Question, answer: Answer) -> str:
    """What was understood, with the word that confirms it."""
    part, query = answer.part, question.query
    said = answer.reply.value
    if part is not None:
        named = f"{part + 1}, {query.part_words(part)}" if query.is_choice else said
        means = question.means(part)
        said = f"{named}: {means}" if means else named
    return f"I understood {said}. {_SAY}"


def _why(question: Question) -> str:
    """What follows from each answer."""
    query = question.query
    said = [str(part + 1) if query.is_choice else query.part_words(part) for part in range(query.part_count)]
    return " ".join(f"{words.capitalize()} means: {question.means(part)}." for part, words in enumerate(said))


def words_of(question: Question) -> tuple[str, ...]:
    """Everything that may be said for a question: itself and its read-backs, for caches and simulated people."""
    replies = (answer_for(question.query, part) for part in range(question.query.part_count))
    return (question.text, *(_read_back(replace(question, read_back=reply), reply) for reply in replies))
