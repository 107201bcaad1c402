"""Whole missions with a language model behind a real server on this machine."""

from __future__ import annotations

import io
import os
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from rich.console import Console
from tests.assembly.llm_server import LlmServer, friendly

from mintpilot.assembly import api
from mintpilot.assembly.api import run_mission
from mintpilot.cli.demos import demo_path
from mintpilot.core.events import Asked, Event
from mintpilot.core.mission import Outcome
from mintpilot.core.ports import Understand
from mintpilot.core.query import Answer, Question
from mintpilot.interaction.answers import answer_of
from mintpilot.interaction.scripted import FunctionOperator, ScriptedOperator
from mintpilot.interaction.terminal import TerminalOperator
from mintpilot.recording.record import read_record

KEY = "key-that-must-not-leak-1f7a"
MEDICINE = demo_path("medicine")


@pytest.fixture
def server(monkeypatch: pytest.MonkeyPatch) -> Iterator[LlmServer]:
    """A server that knows other words. Nobody loses patience with it here, however busy this machine is."""
    pytest.importorskip("pydantic_ai")
    monkeypatch.setattr("mintpilot.mission.shell.SPEAKING_S", 60.0)
    monkeypatch.setattr("mintpilot.assembly.talk.SCREEN_S", 60.0)
    running = LlmServer(lambda prompt: friendly(prompt) or f"{{}} {KEY}")
    monkeypatch.setenv("MINTPILOT_LLM_URL", running.url)
    monkeypatch.setenv("MINTPILOT_LLM_MODEL", "tiny")
    monkeypatch.setenv("MINTPILOT_LLM_KEY", KEY)
    yield running
    running.shut_down()


class Listener(FunctionOperator):
    """Knows what the scripted operator knows, and keeps what it was told."""

    def __init__(self, knows: ScriptedOperator) -> None:
        super().__init__(self.ask)
        self._knows = knows
        self.told: list[str] = []

    def ask(self, question: Question, patience_s: float) -> Answer:
        return self._knows.answer(question, patience_s)

    def tell(self, text: str) -> None:
        self.told.append(text)


@pytest.mark.long
def test_better_words_are_asked_and_told_apart_from_the_first_ones(server: LlmServer, tmp_path: Path) -> None:
    events: list[Event] = []
    record = run_mission(MEDICINE, vehicle="kinematic", llm="endpoint", out=tmp_path / "run", progress=events.append)
    assert record.outcome is Outcome.SUCCESS
    assert record.language_model == "endpoint"
    first = record.questions[0]
    assert (first.text, first.worded_by) == ("Is the box that you mean cylindrical?", "tiny")
    assert first.first_text == "Is it one of the cylindrical boxes?"
    assert first.wording_s is not None
    assert first.better_s is not None
    assert first.wording_s < first.better_s
    assert not [n for n in record.notices if n.kind == "language"]
    template = run_mission(MEDICINE, vehicle="kinematic")
    assert [(q.query, q.yes_means, q.no_means) for q in template.questions] == [
        (q.query, q.yes_means, q.no_means) for q in record.questions
    ]
    assert template.flight == record.flight


@pytest.mark.long
def test_the_key_is_sent_but_kept_nowhere(server: LlmServer, tmp_path: Path) -> None:
    record = run_mission(MEDICINE, vehicle="kinematic", seed=1, llm="endpoint", out=tmp_path / "run")
    assert record.outcome is Outcome.SUCCESS
    assert f"Bearer {KEY}" in server.keys
    files = [path for path in (tmp_path / "run").rglob("*") if path.is_file()]
    assert len(files) > 3
    assert not [path for path in files if KEY.encode() in path.read_bytes()]
    assert read_record(tmp_path / "run").questions == record.questions


def test_a_server_that_goes_away_in_mid_mission_is_told_once_and_the_mission_goes_on(
    server: LlmServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    listeners: list[Listener] = []

    def gone_after_one(event: Event) -> None:
        if isinstance(event, Asked):
            server.shut_down()

    scripted = api.scripted_operator
    monkeypatch.setattr(
        api, "scripted_operator", lambda *given: listeners.append(Listener(scripted(*given))) or listeners[0]
    )
    record = run_mission(MEDICINE, vehicle="kinematic", llm="endpoint", progress=gone_after_one)
    assert record.outcome is Outcome.SUCCESS
    assert [q.worded_by for q in record.questions] == ["tiny", "template", "template"]
    notices = [n.text for n in record.notices if n.kind == "language"]
    assert len(notices) == 1
    assert "goes on with templates" in notices[0]
    assert listeners[0].told == notices


@pytest.mark.long
def test_a_server_that_was_never_there_costs_words_only(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pydantic_ai")
    monkeypatch.setenv("MINTPILOT_LLM_URL", "http://127.0.0.1:9/v1")
    monkeypatch.setenv("MINTPILOT_LLM_MODEL", "tiny")
    record = run_mission(MEDICINE, vehicle="kinematic", llm="endpoint")
    assert record.outcome is Outcome.SUCCESS
    assert [q.worded_by for q in record.questions] == ["template"] * 3
    assert len([n for n in record.notices if n.kind == "language"]) == 1


class Talker(FunctionOperator):
    """Says in free words what it is told to say, one utterance a question."""

    def __init__(self, understand: Understand, *utterances: str) -> None:
        super().__init__(self.ask)
        self._understand, self._utterances = understand, iter(utterances)

    def ask(self, question: Question, patience_s: float) -> Answer:
        pending = question.read_back.reply if question.read_back is not None else None
        text = "yes" if pending is not None else next(self._utterances)
        return answer_of(self._understand(text, question, patience_s, pending=pending), text, question)

    def tell(self, text: str) -> None:
        """Nobody is there."""


@pytest.mark.long
def test_what_an_answer_says_beyond_the_question_saves_questions(tmp_path: Path) -> None:
    plain = run_mission(MEDICINE, vehicle="kinematic")
    said = "no, the small black cubic one"
    record = run_mission(
        MEDICINE, vehicle="kinematic", operator=lambda talk: Talker(talk.understand, said), out=tmp_path / "run"
    )
    assert record.outcome is Outcome.SUCCESS, record.reason
    assert len(record.questions) == 1 < len(plain.questions)
    (question,) = record.questions
    assert question.answer_text == said
    assert "small black cubic box" in question.also[0]
    assert "also said: " in (tmp_path / "run" / "report.html").read_text()


class Screen(io.StringIO):
    """A screen with somebody before it, who acts on what appears there."""

    def __init__(self, react: Callable[[str], None]) -> None:
        super().__init__()
        self._react = react

    def write(self, text: str) -> int:
        written = super().write(text)
        self._react(self.getvalue())
        return written


def test_the_first_words_are_on_the_screen_before_the_model_has_answered(server: LlmServer) -> None:
    """The server does not answer before the question is on the screen; the person not before better words are."""
    shown, (reads, writes) = threading.Event(), os.pipe()
    answers = iter((b"no\n", b"yes, the black one\n"))
    said = 0
    confirmed: list[bool] = []

    def react(screen: str) -> None:
        nonlocal said
        if "Your answer" in screen:
            shown.set()
        if screen.count("other words:") > said and "Your answer" in screen.rpartition("other words:")[2]:
            said += 1
            os.write(writes, next(answers))
        if screen.endswith("Is that right? Yes or no: \n") and not confirmed:
            confirmed.append(True)
            os.write(writes, b"yes\n")

    def answer(prompt: str) -> str:
        assert shown.wait(60)
        return friendly(prompt) or "{}"

    server.answer = answer
    screen = Screen(react)
    with os.fdopen(reads) as stdin:
        record = run_mission(
            MEDICINE,
            vehicle="kinematic",
            llm="endpoint",
            operator=lambda talk: TerminalOperator(
                Console(file=screen, width=200),
                stdin,
                understand=talk.understand,
                order_of=talk.order_of,
                lang=talk.lang,
            ),
        )
    os.close(writes)
    assert record.outcome is Outcome.SUCCESS, screen.getvalue()
    assert [(q.worded_by, q.answer_text) for q in record.questions] == [("tiny", "no"), ("tiny", "yes, the black one")]
    for question in record.questions:
        first, _, later = screen.getvalue().partition(question.text)
        assert question.first_text in first
        assert question.yes_means in later
        assert question.no_means in later
