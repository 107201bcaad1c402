"""The question card: words, consequences with their ways, the places it is about, and the figures behind it."""

from __future__ import annotations

import numpy as np

from mintpilot.console.protocol import Consequence, Point, QuestionPane, Reason, Spot, Worth
from mintpilot.core.decisions import AskQuestion
from mintpilot.core.gap import GapKind, KnowledgeGap
from mintpilot.core.geometry import Floats
from mintpilot.core.plan import Plan
from mintpilot.core.query import NO_PART, YES_PART, Answer, Query, Question, Reply
from mintpilot.core.reading import guarded_replies
from mintpilot.core.tree import GapExplanation, Mint
from mintpilot.wording.speech import Speech

_MOST_POINTS = 400


def question_pane(
    question: Question,
    asked: AskQuestion | None,
    explanations: dict[str, GapExplanation],
    *,
    speech: Speech,
    deadline_s: float,
    extended: bool = False,
    again: bool = False,
) -> QuestionPane:
    """The card of one question.

    Args:
        question: with its id; with a read-back where one is to be confirmed.
        asked: the deliberation that chose it; None: nothing is known of what follows (before take-off).
        explanations: of the gaps, by id.
        speech: of its words.
        deadline_s: until when it is waited for, mission clock.
        extended: whether more time was given.
        again: whether words were not understood.
    """
    return QuestionPane(
        id=question.id,
        text=question.text,
        lang=speech.lang,
        attempt=question.attempt,
        deadline_s=deadline_s,
        extended=extended,
        again=again,
        consequences=_consequences(question, asked, speech),
        spots=tuple(spot for gap in question.gaps for spot in _spots(gap, question.query, speech)),
        why=tuple(_reason(e, speech) for gap in question.gaps if (e := explanations.get(gap.id)) is not None),
        worth=_worth(asked),
        read_back=_said(question, question.read_back),
        read_back_means=_means(question, question.read_back),
    )


def path_points(path_m: Floats) -> tuple[Point, ...]:
    """A path (n, 3) as points for the map, thinned out to a few hundred, rounded to centimetres."""
    step = max(1, -(-len(path_m) // _MOST_POINTS))
    kept = path_m[::step] if len(path_m) % step == 1 or step == 1 else np.vstack([path_m[::step], path_m[-1:]])
    return tuple((round(float(x), 2), round(float(y), 2), round(float(z), 2)) for x, y, z in kept)


def _reason(explanation: GapExplanation, speech: Speech) -> Reason:
    return Reason(
        words=speech(explanation.figures or explanation.why),
        best_s=explanation.cost_if_favourable_s,
        worst_s=explanation.cost_if_unfavourable_s,
        apart_m=explanation.divergence_m,
    )


def _consequences(question: Question, asked: AskQuestion | None, speech: Speech) -> tuple[Consequence, ...]:
    query = question.query
    reasoning = asked.reasoning if asked is not None else None
    mint = reasoning.mint if reasoning is not None else None
    found: list[Consequence] = []
    if query.is_choice:
        for part, words in enumerate(question.option_means):
            found.append(_led_to(query, part, mint, Consequence(reply="option", option=part, words=words)))
    else:
        guarded = guarded_replies(question)
        yes, no = (reply in guarded and len(guarded) == 1 for reply in (Reply.YES, Reply.NO))
        found.append(_led_to(query, YES_PART, mint, Consequence(reply="yes", words=question.yes_means, frees=yes)))
        found.append(_led_to(query, NO_PART, mint, Consequence(reply="no", words=question.no_means, frees=no)))
    grounded = any(gap.kind is GapKind.GO for gap in question.gaps)  # without a yes it does not take off
    found.append(Consequence(reply="unsure", words=question.no_means if grounded else ""))
    silence = Consequence(reply="silence", words=question.no_means if grounded else "")
    cautious = reasoning.cautious if reasoning is not None else None
    if reasoning is not None and cautious is not None:
        silence = _with_plan(silence, cautious, reasoning.gaps, None)
    return tuple(
        c.model_copy(update={"undone": tuple(speech.thing(one) for one in c.undone)}) for c in (*found, silence)
    )


def _led_to(query: Query, part: int, mint: Mint | None, consequence: Consequence) -> Consequence:
    """With the likeliest plan under that part of the query."""
    if mint is None:
        return consequence
    try:
        inside = query.part_table(mint.belief) == part
    except KeyError:  # it speaks of a gap that the tree does not branch on
        return consequence
    masses = np.where(inside, mint.belief.probability, 0.0).ravel()
    classes = mint.class_of.ravel()
    held = classes >= 0
    by_class = np.bincount(classes[held], weights=masses[held], minlength=len(mint.classes))
    total = float(by_class.sum())
    if total <= 0:
        return consequence
    best = int(by_class.argmax())
    plan = mint.classes[best].plan
    share = float(by_class[best]) / total
    return consequence if plan is None else _with_plan(consequence, plan, mint.belief.gaps, share)


def _with_plan(
    consequence: Consequence, plan: Plan, gaps: tuple[KnowledgeGap, ...], share: float | None
) -> Consequence:
    known = {gap.id: gap.description for gap in gaps}
    undone = tuple(known.get(name, name) for name in sorted(plan.skips))
    update = {"path": path_points(plan.path_m), "seconds": round(plan.cost_s, 1), "undone": undone, "share": share}
    return consequence.model_copy(update=update)


def _spots(gap: KnowledgeGap, query: Query, speech: Speech) -> tuple[Spot, ...]:
    if gap.kind is GapKind.GO:
        return ()
    if not gap.candidates:
        region = gap.subject if gap.kind is GapKind.OBSTACLE else ""
        return (Spot(id=gap.subject, words=speech.thing(gap.description), position=gap.position_m, region=region),)
    choosable = query.gap_ids == (gap.id,)
    return tuple(
        Spot(
            id=c.id,
            words=speech.thing(c.description) if c.description else c.id,
            position=c.position_m,
            choosable=choosable,
        )
        for c in gap.candidates
    )


def _worth(asked: AskQuestion | None) -> Worth | None:
    if asked is None:
        return None
    return Worth(
        gain_bits=asked.scored.gain_bits,
        saved_s=asked.scored.regret_saved_s,
        queries=1 + len(asked.alternatives),
        gaps=len(asked.reasoning.gaps),
    )


def _said(question: Question, answer: Answer | None) -> str:
    if answer is None:
        return ""
    if answer.option is not None and not answer.also:
        return question.query.part_words(answer.option)
    return answer.text if answer.also else answer.reply.value


def _means(question: Question, answer: Answer | None) -> str:
    return "" if answer is None or answer.part is None else question.means(answer.part)
