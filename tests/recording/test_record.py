"""The record's figures, its short form, and what is refused when it is read."""

from __future__ import annotations

import dataclasses
import io
import json

import pytest
from rich.console import Console

from mintpilot.core import events as ev
from mintpilot.core.errors import RecordError
from mintpilot.core.query import (
    YES_PART,
    Evidence,
    Literal,
    Option,
    Query,
    Reply,
    Saying,
    SayingKind,
    answer_for,
    choice,
)
from mintpilot.recording.build import build_record, flight_record
from mintpilot.recording.history import History
from mintpilot.recording.in_memory import HistoryRecorder
from mintpilot.recording.record import MissionRecord, read_record
from mintpilot.recording.report import report_html
from mintpilot.recording.run_summary import RunSummary, summary
from mintpilot.recording.terminal_report import print_report

from .conftest import flight, way

KEYS = {
    "outcome",
    "reason",
    "achieved",
    "looks",
    "left",
    "people",
    "rules",
    "questions",
    "gaps",
    "waiting",
    "flight",
    "timings_s",
    "seed",
    "run_dir",
    "schema_version",
}


def record_of(events) -> MissionRecord:
    recorder = HistoryRecorder()
    for event in events:
        recorder.record(event)
    return recorder.close()


def test_the_summary_has_the_promised_form(make_events):
    short = json.loads(summary(record_of(make_events())).model_dump_json())
    assert set(short) == KEYS
    assert short["outcome"] == "success"
    assert short["reason"] == "Every goal was reached."
    assert short["schema_version"] == 2
    assert short["seed"] == 7
    question = short["questions"][0]
    assert question == {
        "text": "Can I fly through the grey smoke near the gate?", "gap": "obstacle:smoke-1", "gain_bits": 1.0,
        "reply": "no", "latency_s": 4.2,
    }  # fmt: skip
    assert [gap["asked"] for gap in short["gaps"]] == [True, False]
    assert all(gap["why"] for gap in short["gaps"])
    assert short["timings_s"] == pytest.approx({"survey": 2.5, "mapping": 0.25, "deliberation": 0.15, "flight": 1.1})
    assert RunSummary.model_validate(short).model_dump_json() == json.dumps(short, separators=(",", ":"))


def test_flight_figures_leave_the_survey_out(make_events):
    record = record_of(make_events())
    plan_m = way([(10, 2), (18, 4), (18, 9), (10.5, 10.6)]).length_m
    assert record.flight.planned_m == pytest.approx(plan_m)
    assert record.flight.flown_m == pytest.approx(plan_m)
    assert record.flight.rms_error_m == pytest.approx(0.03)
    assert record.flight.max_error_m == pytest.approx(0.03)
    assert record.survey is not None
    assert record.survey.flown_m == pytest.approx(22.0)


def test_a_leg_that_was_broken_off_counts_as_far_as_it_was_commanded():
    plan = way([(0, 0), (10, 0)])
    whole, half = flight(plan), flight(plan, share=0.5, start_s=50.0)
    legs = [ev.LegFlown(phase="mission", stop_id="a", trajectory=t, log=log) for t, log in (whole, half)]
    figures = flight_record(legs)
    assert figures.planned_m == pytest.approx(10 + 9 / 19 * 10)
    assert figures.seconds == pytest.approx(50 + 9 / 19 * 10), "on one clock the wait in between counts"
    assert flight_record(list(reversed(legs))).seconds == pytest.approx(10 + 9 / 19 * 10), "on two clocks it cannot"
    assert flight_record([]).flown_m is None


def test_what_is_not_finite_becomes_null(make_events):
    record = record_of(make_events(reply=Reply.TIMEOUT, words=""))
    text = record.model_dump_json()
    assert "Infinity" not in text
    assert "NaN" not in text
    assert record.certificate is not None
    assert record.certificate.bound_s is None
    assert record.settings["limits"]["endurance_s"] is None
    assert record.gaps[1].cost_if_unfavourable_s is None
    assert MissionRecord.model_validate_json(text) == record


def test_gaps_without_an_account_say_so(make_events):
    story = [e for e in make_events(ended=False) if not isinstance(e, ev.PlanChosen)]
    record = record_of(story)
    assert [gap.id for gap in record.gaps] == ["obstacle:smoke-1", "target:1"]
    assert record.gaps[0].asked
    assert record.gaps[1].relevant is None
    assert "ended before" in record.gaps[1].why


def test_an_account_of_asking_outlives_later_rounds(make_events):
    story = list(make_events())
    chosen = next(e for e in story if isinstance(e, ev.PlanChosen))
    later = tuple(dataclasses.replace(a, asked=False, why="Settled.") for a in chosen.explanations)
    record = record_of([*story, dataclasses.replace(chosen, explanations=later)])
    assert record.gaps[0].asked
    assert "14.9 s more" in record.gaps[0].why
    assert record.gaps[1].why == "Settled."


def test_nothing_told_is_a_record_too():
    record = build_record(History())
    assert record.outcome.value == "aborted"
    assert record.tree is None
    assert {"python", "mintpilot", "numpy"} <= set(record.versions)


def test_things_seen_are_placed(make_events):
    seen = {s.id: s for s in record_of(make_events()).seen}
    assert seen["smoke-1"].state == "no"
    assert seen["smoke-1"].position_m == pytest.approx((9.875, 7.125, 1.5), abs=0.3)
    assert seen["box-1"].description == "colour red, size small"
    assert seen["room-1"].view == (3, 20, 20, 60, 100)


@pytest.mark.parametrize("version", [0, 1, 3, None, "2"])
def test_other_versions_are_refused_with_a_next_step(tmp_path, version):
    (tmp_path / "record.json").write_text(json.dumps({"schema_version": version}))
    with pytest.raises(RecordError, match=r"schema_version is .*this program reads 2; read it with"):
        read_record(tmp_path)


def test_damaged_records_are_refused(tmp_path, make_events):
    file = tmp_path / "record.json"
    with pytest.raises(RecordError, match="cannot read"):
        read_record(file)
    for content in ("{", "[]", "\x00"):
        file.write_text(content)
        with pytest.raises(RecordError):
            read_record(file)
    data = json.loads(record_of(make_events()).model_dump_json())
    data["flight"]["flown_m"] = "far"
    file.write_text(json.dumps(data))
    with pytest.raises(RecordError, match=r"flight\.flown_m: .*restore it"):
        read_record(file)


def _worded(story):
    """The same mission with a language model at work: better words, a proposed cut, an answer that says more."""
    target = next(e for e in story if isinstance(e, ev.Deliberated)).gaps[1]
    said = Saying(kind=SayingKind.VALUE, value=target.values[0])
    other = Query(literals=(Literal(gap=target.id, values=frozenset({target.values[0]}), saying=said),))
    for event in story:
        if isinstance(event, ev.Asked):
            answer = dataclasses.replace(
                event.answer, also=(Evidence(query=other, part=YES_PART),), understood_by="model"
            )
            better = dataclasses.replace(event.question, text="Is the <b>smoke</b> safe?", worded_by="tiny")
            first = event.question.text
            event = dataclasses.replace(event, question=better, answer=answer, first_text=first, better_s=0.8)
        elif isinstance(event, ev.Deliberated) and event.chosen is not None:
            poor = dataclasses.replace(event.chosen, query=other, gain_bits=0.25, score=0.25, proposed_by="tiny")
            event = dataclasses.replace(event, proposed=(poor,), bound_bits=1.0)
        elif isinstance(event, ev.MissionStarted):
            event = dataclasses.replace(event, language="en", language_model="endpoint")
        yield event


def test_what_a_language_model_did_is_in_the_record_and_in_the_report(make_events, tmp_path):
    record = record_of(_worded(make_events()))
    (question,) = record.questions
    assert question.text == "Is the <b>smoke</b> safe?"
    assert question.first_text == "Can I fly through the grey smoke near the gate?"
    assert (question.worded_by, question.better_s, question.understood_by) == ("tiny", 0.8, "model")
    assert question.also == ("“the medicine box” means the box-1",)
    (cut,) = record.rounds[0].proposals
    assert (cut.proposed_by, cut.gain_bits, cut.asked) == ("tiny", 0.25, False)
    assert (record.rounds[0].best_gain_bits, record.rounds[0].bound_bits) == (1.0, 1.0)
    assert record.language_model == "endpoint"
    assert MissionRecord.model_validate_json(record.model_dump_json()) == record
    report = " ".join(report_html(record, tmp_path).split())
    assert "Is the &lt;b&gt;smoke&lt;/b&gt; safe?" in report
    for words in ("Shown first as", "these words came from tiny", "also said: ", "proposed to ask"):
        assert words in report
    printed = io.StringIO()
    print_report(record, Console(file=printed, width=100))
    assert "also said: “the medicine box” means the box-1" in printed.getvalue()


def test_without_a_model_the_report_says_nothing_of_one(make_events, tmp_path):
    report = report_html(record_of(make_events()), tmp_path)
    assert "Shown first as" not in report
    assert "proposed to ask" not in report


def test_a_choice_is_in_the_record_with_all_its_replies(make_events, tmp_path):
    story = list(make_events())
    target = next(e for e in story if isinstance(e, ev.Deliberated)).gaps[1]
    options = [
        Option(
            label=f"the {value}",
            literals=(
                Literal(gap=target.id, values=frozenset({value}), saying=Saying(kind=SayingKind.VALUE, value=value)),
            ),
        )
        for value in target.values[:2]
    ]
    query = choice(options, (target,))
    means = tuple(f"I fly to {query.part_words(part)}" for part in range(query.part_count))
    even = (1 / query.part_count,) * query.part_count

    def told(event, part):
        if isinstance(event, ev.Asked):
            question = dataclasses.replace(event.question, query=query, option_means=means)
            scored = dataclasses.replace(event.scored, query=query, reply_probabilities=even)
            return dataclasses.replace(event, question=question, scored=scored, answer=answer_for(query, part))
        return event

    for part in range(query.part_count):
        record = record_of([told(event, part) for event in story])
        (question,) = record.questions
        assert (question.reply, question.option) == (Reply.OPTION, part)
        assert question.replies == tuple(query.part_words(i) for i in range(query.part_count))
        assert question.reply_probabilities == pytest.approx(even)
        assert MissionRecord.model_validate_json(record.model_dump_json()) == record
        page = report_html(record, tmp_path)
        assert query.part_words(part) in page
        assert means[part] in page


def test_a_record_of_before_there_were_choices_is_read(make_events):
    data = json.loads(record_of(make_events()).model_dump_json())
    (question,) = data["questions"]
    for name in ("reply_probabilities", "replies", "option_means", "option"):
        del question[name]
    question["yes_probability"] = 0.5
    (old,) = MissionRecord.model_validate(data).questions
    assert (old.replies, old.option, old.yes_probability) == (("yes", "no"), None, 0.5)
