"""The language of a mission: who is chosen, what is told, and what a model under guard cannot do."""

from __future__ import annotations

import threading
import time
from pathlib import Path

import pytest
from tests.language import questions
from tests.mission.scenes import hall

from mintpilot.assembly.api import plan_mission, run_mission
from mintpilot.assembly.guarded_model import MOST_FAILURES, REST_S, GuardedModel
from mintpilot.assembly.talk import Talk, talk_for
from mintpilot.assembly.validation import check_mission
from mintpilot.cli.demos import demo_mission
from mintpilot.core.errors import DeviceError, InputError, UnknownNameError
from mintpilot.core.mission import Outcome
from mintpilot.core.ports import Completion, LanguageModel
from mintpilot.core.query import Order, Reply
from mintpilot.core.reading import AnsweredBy
from mintpilot.mission_file.schema import LanguageSpec, MissionFile
from mintpilot.models.doubles import FunctionModel


class Clock:
    """Time as the test says."""

    now_s = 0.0

    def __call__(self) -> float:
        return self.now_s


class Sulking(LanguageModel):
    """Fails as long as it is told to."""

    def __init__(self) -> None:
        self.fails, self.calls, self.closed = True, 0, 0

    def complete(self, prompt: str, *, schema: type | None, timeout_s: float) -> Completion:
        self.calls += 1
        if self.fails:
            raise DeviceError("the server is gone: going on without it")
        return Completion(text="hello", model="sulking", seconds=0.0)

    def close(self) -> None:
        self.closed += 1


def test_a_failing_model_is_told_once_and_left_alone_for_a_while() -> None:
    clock, model = Clock(), Sulking()
    guarded = GuardedModel(model, "sulking", clock=clock)
    for _ in range(MOST_FAILURES + 4):
        with pytest.raises(DeviceError):
            guarded.complete("?", schema=None, timeout_s=1.0)
    assert model.calls == MOST_FAILURES
    (remark,) = guarded.take_remarks()
    assert str(remark) == ("No help from the language model: the server is gone. The mission goes on with templates.")
    assert guarded.take_remarks() == ()
    model.fails, clock.now_s = False, REST_S + 1
    assert guarded.complete("?", schema=None, timeout_s=1.0).text == "hello"
    assert guarded.take_remarks() == ()


def test_a_closed_model_is_not_started_again() -> None:
    model = Sulking()
    model.fails = False
    guarded = GuardedModel(model, "sulking")
    guarded.close()
    with pytest.raises(DeviceError, match="closed"):
        guarded.complete("?", schema=None, timeout_s=1.0)
    assert (model.calls, model.closed) == (0, 1)


def test_a_model_that_cannot_be_closed_does_not_end_the_mission_badly() -> None:
    model = Sulking()
    model.close = lambda: 1 / 0  # type: ignore[method-assign]
    assert run_mission(hall(), vehicle="kinematic", llm=model).outcome is Outcome.SUCCESS


class Odd:
    """Something that is no completion."""


@pytest.mark.parametrize("answer", [None, "text", Odd(), 3])
def test_what_is_no_completion_is_a_failure(answer: object) -> None:
    model = FunctionModel(lambda _: "")
    model.complete = lambda prompt, *, schema, timeout_s: answer  # type: ignore[assignment,method-assign]
    with pytest.raises(DeviceError, match="no completion"):
        GuardedModel(model, "odd").complete("?", schema=None, timeout_s=1.0)


def test_a_model_that_hangs_is_not_waited_for() -> None:
    stay = threading.Event()
    guarded = GuardedModel(FunctionModel(lambda _: str(stay.wait(60))), "hanging")
    begun_s = time.monotonic()
    with pytest.raises(DeviceError, match="did not answer"):
        guarded.complete("?", schema=None, timeout_s=0.05)
    assert time.monotonic() - begun_s < 30
    stay.set()


def test_endless_answers_are_cut() -> None:
    guarded = GuardedModel(FunctionModel(lambda _: "yes " * 500_000), "chatty")
    assert len(guarded.complete("?", schema=None, timeout_s=20.0).text) == 20_000


@pytest.mark.parametrize(
    ("llm", "lang", "words"),
    [
        ("endpiont", None, "unknown language model 'endpiont'. Did you mean 'endpoint'"),
        (None, "dee", "unknown language 'dee'. Did you mean 'de'"),
        ("endpoint", None, "MINTPILOT_LLM_URL"),
    ],
)
def test_what_cannot_be_chosen_says_why(llm, lang, words, monkeypatch) -> None:
    monkeypatch.delenv("MINTPILOT_LLM_URL", raising=False)
    with pytest.raises(InputError, match=words):
        talk_for(LanguageSpec(), llm=llm, lang=lang)


def test_the_callers_choice_goes_before_the_files() -> None:
    spec = LanguageSpec(model="endpoint", lang="de")
    talk = talk_for(spec, llm="template", lang="fr")
    assert (talk.lang, talk.model_name, talk.improve) == ("fr", "template", None)
    assert talk_for(LanguageSpec(lang="de")).lang == "de"


def in_language(**language: str) -> MissionFile:
    return hall().model_copy(update={"language": LanguageSpec(**language)})


@pytest.mark.parametrize(("lang", "words"), [("en", "safe"), ("de", "Ist"), ("fr", "fumée"), ("es", "humo")])
def test_a_mission_is_flown_and_planned_in_each_language(lang: str, words: str) -> None:
    record = run_mission(in_language(lang=lang), vehicle="kinematic")
    assert record.outcome is Outcome.SUCCESS
    assert record.language == lang
    assert words in record.questions[0].text
    query = plan_mission(hall(), lang=lang).query
    assert query is not None
    assert query.text == record.questions[0].text


def test_an_unknown_model_in_a_file_is_found_with_its_line(tmp_path: Path) -> None:
    path = tmp_path / "mission.yaml"
    file = hall().model_copy(update={"language": LanguageSpec(model="embeded")})
    path.write_text(file.model_dump_json(exclude_none=True, exclude_defaults=False))
    problems = [str(p) for p in check_mission(path)]
    assert any("language.model" in p and "Did you mean 'embedded'" in p for p in problems), problems


def test_the_model_is_closed_in_the_end() -> None:
    model = Sulking()
    run_mission(hall(), vehicle="kinematic", llm=model)
    assert model.closed == 1
    with pytest.raises(UnknownNameError):
        run_mission(hall(), vehicle="kinematic", llm=model, strategy="mintt")
    assert model.closed == 2


@pytest.mark.parametrize(
    ("lang", "text", "reply"),
    [
        ("de", "Ja.", Reply.YES),
        ("de", "nein", Reply.NO),
        ("de", "keine Ahnung", Reply.UNSURE),
        ("fr", "C’est ça !", Reply.YES),
        ("fr", "je ne sais pas", Reply.UNSURE),
        ("es", "¡Sí!", Reply.YES),
        ("es", "no lo sé", Reply.UNSURE),
        ("es", "no", Reply.NO),
        ("es", "no estoy aquí", None),
        ("de", "it is toxic", None),
        ("en", "?", Reply.UNSURE),
        ("en", "it is toxic", Reply.NO),
    ],
)
def test_short_answers_are_understood_in_the_operators_language(lang, text, reply) -> None:
    reading = Talk(lang=lang).understand(text, questions.SMOKE, 5.0)
    assert reading.label == (reply.value if reply is not None else "again")


@pytest.mark.parametrize("text", ["halt", "Stopp!", "stop", "komm zurück", "zurück"])
def test_orders_are_heard(text: str) -> None:
    reading = Talk(lang="de").understand(text, questions.SMOKE, 5.0)
    assert reading.order in (Order.HOLD, Order.RETURN)


def says(reading: str, opposite: str) -> FunctionModel:
    return FunctionModel(lambda p: f'{{"reading": "{opposite if "opposite" in p else reading}"}}')


def test_what_a_model_reads_is_read_back() -> None:
    strange = "the crimson fellow over yonder"
    read = Talk(model=says("yes", "no"), name="f").understand(strange, questions.BOX, 5.0)
    assert (read.label, read.by) == ("read-back:yes", "model")
    assert Talk().understand(strange, questions.BOX, 5.0).label == "again"


def test_the_way_the_words_came_and_the_read_back_are_passed_on() -> None:
    talk = Talk()
    assert talk.understand("yes", questions.SMOKE, 5.0, by=AnsweredBy.VOICE).label == "read-back:yes"
    assert talk.understand("yes", questions.SMOKE, 5.0, pending=Reply.YES).label == "yes"
    assert talk.understand("it is safe", questions.SMOKE, 5.0, guarded=()).label == "yes"


SLANG = "There is a poor chap, the injured person; go to him"


def test_a_model_reads_an_instruction_that_the_rules_refuse() -> None:
    steps = FunctionModel(lambda _: '{"steps": [{"action": "go", "target": "the injured person"}]}')
    file = hall().model_copy(update={"instruction": SLANG})
    with pytest.raises(InputError, match="not understood"):
        run_mission(file, vehicle="kinematic")
    record = run_mission(file, vehicle="kinematic", llm=steps)
    assert (record.outcome, record.instruction) == (Outcome.SUCCESS, SLANG)
    liar = FunctionModel(lambda _: '{"steps": [{"action": "go", "target": "the exit"}]}')
    with pytest.raises(InputError, match="not understood"):
        run_mission(file, vehicle="kinematic", llm=liar)


def test_thinking_ahead_costs_one_proposal_only(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every history of answers is thought through; only what would be asked now is worth a model's time."""
    monkeypatch.setattr("mintpilot.strategies.mint.gain_bound_bits", lambda *_: 2.0)
    prompts: list[str] = []
    report = plan_mission(demo_mission("medicine"), llm=FunctionModel(lambda prompt: prompts.append(prompt) or "{}"))
    assert report.expected_questions > 1
    assert sum("Propose up to" in prompt for prompt in prompts) == 1
    assert report.query is not None


def test_words_too_long_to_be_an_answer_are_none() -> None:
    assert Talk().understand("y" * 4000, questions.SMOKE, 5.0).label == "again"
    assert Talk().understand("yes " * 200, questions.SMOKE, 5.0).label == "again"
