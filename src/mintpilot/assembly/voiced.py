"""Missions by voice: the real parts put together, and a simulated person who takes part by sound alone."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from mintpilot.assembly.registry import load
from mintpilot.assembly.talk import Talk
from mintpilot.assembly.worlds import World
from mintpilot.core.gap import KnowledgeGap
from mintpilot.core.predicate import Combine, Literal, SayingKind
from mintpilot.core.query import Query
from mintpilot.elicitation.candidates import gap_literals
from mintpilot.uncertainty.findings import find_gaps
from mintpilot.voice.hearing import Ear
from mintpilot.voice.loopback import Conditions, LoopbackPerson, alike
from mintpilot.voice.mouth import VoiceSettings
from mintpilot.voice.operator import VoiceOperator, VoiceParts
from mintpilot.voice.ports import Activity, Recogniser, SoundLink, Speech

RECOGNISED = 0.6
"""A heard question is one of the world's where so much of the words is the same."""
_READ_BACK = re.compile(r"understood\W+(yes|no)\b", re.IGNORECASE)
_SAY = re.compile(r"say\W+confirm", re.IGNORECASE)
"""A read-back again, without what was understood."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LoopbackParts:
    """Who speaks and hears on both sides."""

    speech: Speech
    ear: Ear
    activity: Activity
    person_hears: Recogniser
    person_speaks: Speech


class WorldKnowledge:
    """Answers heard words from the truth about a world. Never told which question is open.

    Every question that could be asked about the world's gaps, and their attributes, is matched against what was heard;
    a read-back is confirmed if it gives back the last answer.

    Args:
        world: the world with its truth.
        talk: words questions.
    """

    def __init__(self, world: World, talk: Talk) -> None:
        self.answers = dict(_answers(world, talk))
        """Question → whether yes is true."""
        self._last = self._about = ""

    def __call__(self, heard: str) -> str | None:
        """What the person says; None: nothing, since it was no question."""
        read_back = _READ_BACK.search(heard)
        if read_back is not None:
            self._about = read_back.group(1).casefold()
        if read_back is not None or _SAY.search(heard):
            return "confirm" if self._about and self._about == self._last else "no"
        best = max(self.answers, key=lambda text: alike(heard, text), default="")
        if alike(heard, best) < RECOGNISED:
            return "say again" if heard.rstrip().endswith("?") else None
        self._last, self._about = "yes" if self.answers[best] else "no", ""
        return self._last


def _answers(world: World, talk: Talk) -> list[tuple[str, bool]]:
    gaps = find_gaps(world.map, world.task, start_m=world.mission.start_m).gaps
    found = []
    for gap in gaps:
        truth = world.truth.value_of(gap)
        if truth is None:
            continue
        for query in _queries(gap_literals(gap, world.mission.start_m)):
            text = talk.word(query, _spoken_of(gap), None).text
            found.append((text, query.holds({gap.id: truth})))
    return found


def _spoken_of(gap: KnowledgeGap) -> tuple[KnowledgeGap, ...]:
    return (gap,)


def _queries(literals: tuple[Literal, ...]) -> list[Query]:
    """Each by itself, and two of one gap: this or that, and of attributes also both at once."""
    single = [Query(literals=(literal,)) for literal in literals]
    pairs = [*combinations(literals, 2)]
    either = [Query(literals=pair, combine=Combine.ANY) for pair in pairs]
    attributes = [pair for pair in pairs if all(x.saying.kind is SayingKind.ATTRIBUTE for x in pair)]
    return [*single, *either, *(Query(literals=pair, combine=Combine.ALL) for pair in attributes)]


def loopback_operator(
    world: World,
    talk: Talk,
    parts: LoopbackParts,
    *,
    rng: np.random.Generator,
    conditions: Conditions,
) -> tuple[VoiceOperator, LoopbackPerson]:
    """An operator whose person is simulated, by sound only."""
    person = LoopbackPerson(
        ear=parts.person_hears, voice=parts.person_speaks, reply=WorldKnowledge(world, talk), rng=rng,
        conditions=conditions,
    )  # fmt: skip
    mine = VoiceParts(speech=parts.speech, ear=parts.ear, activity=parts.activity, link=person)
    operator = VoiceOperator(mine, understand=talk.understand, order_of=talk.order_of, is_patient=True)
    return operator, person


def real_parts(link: SoundLink, *, lang: str = "en") -> VoiceParts:
    """The recognisers, voice activity and speech that are installed.

    Raises:
        MissingPartError: one is not; the message says how to get it.
        InputError: a model file is not the pinned one.
    """
    return VoiceParts(
        speech=speech_for(lang),
        ear=hears_here(),
        activity=load("activity", "silero")(),
        link=link,
    )


def speech_for(lang: str) -> Speech:
    """The installed voice of a language. Raises as `real_parts`."""
    made: Speech = load("speech", "hibari" if lang == "en" else "espeak")()
    return made


def hears_here() -> Ear:
    """Both installed recognisers. Raises as `real_parts`."""
    first, second = (load("recogniser", name)() for name in ("moonshine", "whisper"))
    return Ear(first=first, second=second)


def voice_operator(
    link: SoundLink, talk: Talk, show: Callable[[str], object], settings: VoiceSettings
) -> VoiceOperator:
    """A voice operator of a mission's language, made of the installed parts; ``show`` gets captions and what was heard.

    Raises as `real_parts`.
    """
    return VoiceOperator(
        real_parts(link, lang=talk.lang),
        understand=talk.understand,
        order_of=talk.order_of,
        caption=lambda text: show(f"[spoken] {text}"),
        heard=lambda text: show(f"[heard] {text}"),
        lang=talk.lang,
        settings=settings,
    )
