"""From what a mission told to its record."""

from __future__ import annotations

import dataclasses
import math
import platform
from collections.abc import Iterable, Sequence
from enum import Enum
from functools import cache
from importlib import metadata
from itertools import pairwise

import numpy as np
from pydantic import JsonValue

from mintpilot.core.events import Asked, Deliberated, LegFlown, MissionStarted, PlanChosen
from mintpilot.core.gap import GapKind, KnowledgeGap
from mintpilot.core.message import message, verbatim
from mintpilot.core.mission import Outcome, Verdict
from mintpilot.core.rule import Rule
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.trajectory import FlightEnd
from mintpilot.core.tree import Certificate, GapExplanation
from mintpilot.recording.frames import FRAMES, frame_name
from mintpilot.recording.history import History
from mintpilot.recording.record import (
    AchievedRecord,
    CertificateRecord,
    CutRecord,
    FlightRecord,
    GapRecord,
    LeftRecord,
    LookRecord,
    MissionRecord,
    NoticeRecord,
    OrderRecord,
    QuestionRecord,
    RoundRecord,
    RuleRecord,
    SeenRecord,
    ValueRecord,
    WaitingRecord,
)
from mintpilot.recording.tree_data import Told, class_records, tree_record
from mintpilot.recording.words import say, say_evidence, say_query
from mintpilot.wording.speech import Speech

_UNDECIDED = message("The mission ended before this was decided.")


def build_record(history: History, *, run_dir: str = "", unfinished: str = "") -> MissionRecord:
    """The record of what is known so far.

    Args:
        history: the events of one mission.
        run_dir: where it is kept; empty where nothing is.
        unfinished: for a mission without a verdict, why; it then counts as aborted.
    """
    started, ended, mint = history.started, history.ended, history.mint
    speech = speech_of(started)
    told = Told(replies=history.replies, asked=history.asked_gaps, flown=history.flown_signature)
    certificate = history.chosen[-1].certificate if history.chosen else None
    mission_legs = [leg for leg in history.legs if leg.phase != "survey"]
    survey_legs = [leg for leg in history.legs if leg.phase == "survey"]
    plan = history.chosen[-1].plan if history.chosen else None
    flight = flight_record(mission_legs)
    if not mission_legs and plan is not None:
        flight = flight.model_copy(update={"planned_m": plan.length_m})
    return MissionRecord(
        name=started.mission.name if started else "",
        instruction=started.mission.instruction if started else "",
        strategy=started.strategy if started else "",
        language=started.language if started else "en",
        language_model=started.language_model if started else "template",
        outcome=ended.verdict.outcome if ended else Outcome.ABORTED,
        reason=speech(
            ended.verdict.reason if ended else verbatim(unfinished) or message("The mission was not finished.")
        ),
        complete=ended is not None,
        seed=started.seed if started else None,
        settings=_settings(started.mission) if started else {},
        versions=versions(),
        gaps=gap_records(history.gaps, history.chosen, history.asked_gaps, speech),
        questions=tuple(_question(asked, history.gaps, speech) for asked in history.asked),
        rounds=tuple(_round(deliberated, speech) for deliberated in history.deliberations),
        tree=tree_record(mint, history.gaps, told, speech=speech) if mint else None,
        plan_classes=class_records(mint, history.gaps, told, speech=speech) if mint else (),
        certificate=_certificate(certificate, speech) if certificate else None,
        achieved=_achieved(ended.verdict, speech) if ended else (),
        left=_left(ended.verdict, speech) if ended else (),
        looks=_looks(ended.verdict, history.map, run_dir, speech) if ended else (),
        rules=_rules(started.task.rules, ended.verdict if ended else None, speech) if started else (),
        waiting=_waiting(ended.verdict) if ended else None,
        flight=flight,
        survey=flight_record(survey_legs) if survey_legs else None,
        seen=_seen(history.map, speech) if history.map else (),
        frames=history.frames,
        timings_s=dict(history.timings_s),
        notices=tuple(NoticeRecord(kind=n.kind, text=speech(n.text)) for n in history.notices),
        orders=tuple(
            OrderRecord(order=o.order, operator=o.operator, text=o.text, answer=speech(o.answer), time_s=o.time_s)
            for o in history.orders
        ),
        run_dir=run_dir,
    )


@cache
def versions() -> dict[str, str]:
    """Versions of Python, MintPilot and the installed parts that decide results."""
    found = {"python": platform.python_version()}
    for part in ("mintpilot", "numpy", "scipy", "numba", "mujoco"):
        try:
            found[part] = metadata.version(part)
        except metadata.PackageNotFoundError:
            continue
    return found


def speech_of(started: MissionStarted | None) -> Speech:
    """The mission's language."""
    return Speech() if started is None else Speech(started.language, dict(started.names))


def _achieved(verdict: Verdict, speech: Speech) -> tuple[AchievedRecord, ...]:
    return tuple(AchievedRecord(n=one.n, text=speech(one.text), at_s=one.at_s) for one in verdict.achieved)


def _looks(verdict: Verdict, map: SemanticMap | None, run_dir: str, speech: Speech) -> tuple[LookRecord, ...]:
    views = {o.id: o.best_view for o in map.objects} if map is not None and run_dir else {}
    return tuple(
        LookRecord(
            n=one.n,
            text=speech(one.text),
            result=one.result,
            what=one.what,
            count=one.count,
            pictures=tuple(f"{FRAMES}/{frame_name(view[0])}" for o in one.objects if (view := views.get(o))),
            seen=one.seen_share,
        )
        for one in verdict.looks
    )


def _rules(rules: Sequence[Rule], verdict: Verdict | None, speech: Speech) -> tuple[RuleRecord, ...]:
    broken = verdict.rules_broken if verdict is not None else None
    return tuple(
        RuleRecord(
            text=speech(rule.text),
            formula=rule.formula,
            kept=None if broken is None else str(rule.text) not in broken,
        )
        for rule in rules
    )


def _waiting(verdict: Verdict) -> WaitingRecord:
    return WaitingRecord(delay_s=verdict.waiting.delay_s, hidden_s=verdict.waiting.hidden_s)


def _left(verdict: Verdict, speech: Speech) -> tuple[LeftRecord, ...]:
    return tuple(
        LeftRecord(
            n=one.n,
            text=speech(one.text),
            reason=speech(one.reason),
            resource=one.resource,
            needed=one.needed_s,
            available=one.available_s,
        )
        for one in verdict.left
    )


def flight_record(legs: Sequence[LegFlown]) -> FlightRecord:
    """Lengths, time and tracking error over these legs; all null where none was flown."""
    if not legs:
        return FlightRecord(planned_m=None, flown_m=None, seconds=None, rms_error_m=None, max_error_m=None)
    planned_m = sum(
        _length_m(leg.log.reference_m) if leg.log.end is FlightEnd.INTERRUPTED else leg.trajectory.length_m
        for leg in legs
    )
    times = [leg.log.time_s for leg in legs if leg.log.time_s.size]
    one_clock = all(a[-1] <= b[0] for a, b in pairwise(times))
    spans = [float(t[-1] - t[0]) for t in times]
    errors = [np.linalg.norm(leg.log.position_m - leg.log.reference_m, axis=1) for leg in legs]
    error_m = np.concatenate(errors)
    return FlightRecord(
        planned_m=float(planned_m),
        flown_m=sum(_length_m(leg.log.position_m) for leg in legs),
        seconds=float(times[-1][-1] - times[0][0]) if times and one_clock else sum(spans),
        rms_error_m=float(np.sqrt(np.mean(error_m**2))) if error_m.size else None,
        max_error_m=float(error_m.max()) if error_m.size else None,
    )


def gap_records(
    gaps: Iterable[KnowledgeGap], chosen: Iterable[PlanChosen], asked: frozenset[str], speech: Speech
) -> tuple[GapRecord, ...]:
    """Every gap with its latest explanation; what was once asked keeps the explanation that says so."""
    explanations: dict[str, GapExplanation] = {}
    for choice in chosen:
        for explanation in choice.explanations:
            before = explanations.get(explanation.gap_id)
            if before is None or explanation.asked or not before.asked:
                explanations[explanation.gap_id] = explanation
    known = {gap.id: gap for gap in gaps}
    return tuple(
        _gap(gap_id, known.get(gap_id), explanations.get(gap_id), gap_id in asked, speech)
        for gap_id in dict.fromkeys((*known, *explanations))
    )


def _gap(
    gap_id: str, gap: KnowledgeGap | None, explanation: GapExplanation | None, asked: bool, speech: Speech
) -> GapRecord:
    description = gap.description if gap else explanation.description if explanation else gap_id
    kind = gap.kind if gap else GapKind(explanation.kind) if explanation and explanation.kind in set(GapKind) else None
    values = zip(gap.values, gap.prior, strict=True) if gap else ()
    return GapRecord(
        id=gap_id,
        kind=kind,
        subject=gap.subject if gap else "",
        description=speech.thing(description),
        values=tuple(ValueRecord(value=v, prior=p, means=speech(say(gap, [v])) if gap else v) for v, p in values),
        asked=asked or bool(explanation and explanation.asked),
        relevant=explanation.relevant if explanation else None,
        why=speech(explanation.why if explanation else _UNDECIDED),
        cost_if_favourable_s=explanation.cost_if_favourable_s if explanation else None,
        cost_if_unfavourable_s=explanation.cost_if_unfavourable_s if explanation else None,
        divergence_m=explanation.divergence_m if explanation else None,
        entropy_bits=explanation.entropy_bits if explanation else None,
        gain_bits=explanation.gain_bits if explanation else None,
        regret_saved_s=explanation.regret_saved_s if explanation else None,
    )


def _question(asked: Asked, gaps: Sequence[KnowledgeGap], speech: Speech) -> QuestionRecord:
    question, scored, answer = asked.question, asked.scored, asked.answer
    return QuestionRecord(
        text=question.text,
        query=question.query.id,
        gaps=question.query.gap_ids,
        gain_bits=scored.gain_bits,
        score=scored.score,
        regret_saved_s=scored.regret_saved_s,
        reply_probabilities=scored.reply_probabilities,
        replies=tuple(question.query.part_words(part) for part in range(question.query.part_count)),
        yes_means=question.yes_means,
        no_means=question.no_means,
        option_means=question.option_means,
        worded_by=question.worded_by,
        wording_s=asked.wording_s,
        attempt=question.attempt,
        reply=answer.reply,
        option=answer.option,
        answer_text=answer.text,
        latency_s=answer.latency_s,
        first_text=asked.first_text,
        better_s=asked.better_s,
        understood_by=answer.understood_by,
        also=tuple(speech(say_evidence(one, gaps)) for one in answer.also),
        proposed_by=scored.proposed_by,
    )


def _round(deliberated: Deliberated, speech: Speech) -> RoundRecord:
    chosen = deliberated.chosen
    scored = [*([chosen] if chosen else []), *deliberated.alternatives, *deliberated.proposed]
    return RoundRecord(
        round=deliberated.round,
        seconds=deliberated.seconds,
        gaps=len(deliberated.gaps),
        nodes=deliberated.mint.nodes if deliberated.mint else 0,
        query=chosen.query.id if chosen else "",
        alternatives=tuple((scored.query.id, scored.gain_bits) for scored in deliberated.alternatives),
        proposals=tuple(
            CutRecord(
                query=cut.query.id,
                words=speech(say_query(cut.query, deliberated.gaps)),
                proposed_by=cut.proposed_by,
                gain_bits=cut.gain_bits,
                score=cut.score,
                asked=chosen is not None and cut.query.id == chosen.query.id,
            )
            for cut in deliberated.proposed
        ),
        best_gain_bits=max((cut.gain_bits for cut in scored), default=None),
        bound_bits=deliberated.bound_bits,
    )


def _certificate(certificate: Certificate, speech: Speech) -> CertificateRecord:
    return CertificateRecord(
        reason=certificate.reason,
        text=speech(certificate.text),
        top_class_probability=certificate.top_class_probability,
        entropy_bits=certificate.entropy_bits,
        best_gain_bits=certificate.best_gain_bits,
        bound_s=certificate.bound_s,
    )


def _seen(seen: SemanticMap, speech: Speech) -> tuple[SeenRecord, ...]:
    objects = (
        SeenRecord(
            id=o.id,
            kind="object",
            description=", ".join(f"{a.name} {a.value}" for a in o.attributes) or o.label,
            position_m=o.position_m,
            state=o.label,
            sightings=o.sightings,
            view=o.best_view,
        )
        for o in seen.objects
    )
    regions = (
        SeenRecord(
            id=r.id,
            kind="region",
            description=speech.thing(r.description) or r.id,
            position_m=_middle(seen, r.cells),
            state=r.passable.value,
            view=r.best_view,
        )
        for r in seen.regions
    )
    rooms = (
        SeenRecord(
            id=r.id,
            kind="room",
            description=speech.thing(r.description) or r.id,
            position_m=r.door_m.centre_m,
            state=r.occupied.value,
            view=r.best_view,
        )
        for r in seen.rooms
    )
    return (*objects, *regions, *rooms)


def _middle(seen: SemanticMap, cells: np.ndarray[tuple[int, ...], np.dtype[np.int64]]) -> tuple[float, float, float]:
    """Middle of a region's cells, metres; the lattice's middle for a region without cells."""
    if not cells.size:
        return seen.frame.box.centre_m
    zyx = np.stack(np.unravel_index(cells, seen.frame.shape), axis=1)
    x, y, z = seen.frame.centres_of(zyx).mean(axis=0)
    return (float(x), float(y), float(z))


def _length_m(path_m: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> float:
    return float(np.linalg.norm(np.diff(path_m, axis=0), axis=1).sum())


def _settings(value: object) -> dict[str, JsonValue]:
    """A settings dataclass as plain data."""
    assert dataclasses.is_dataclass(value)
    return {f.name: _plain(getattr(value, f.name)) for f in dataclasses.fields(value)}


def _plain(value: object) -> JsonValue:
    if dataclasses.is_dataclass(value):
        return _settings(value)
    if isinstance(value, Enum):
        return str(value.value)
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if value is None or isinstance(value, str | int):
        return value
    if isinstance(value, tuple | list):
        return [_plain(item) for item in value]
    return str(value)
