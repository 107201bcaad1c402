"""A recorder that keeps what a trial's record is made of, and nothing else."""

from __future__ import annotations

from statistics import median

import numpy as np

from mintpilot.benchmark.records import AskedRecord, Stages
from mintpilot.core.events import Asked, Deliberated, Event, FrameSeen, LegFlown, Noticed, PlanChosen, Timed
from mintpilot.core.ports import Recorder
from mintpilot.core.query import Reply

PATH_POINTS = 60
"""A flown path keeps at most about this many points."""


class Tally(Recorder):
    """Listens to one mission.

    Attributes:
        asked: the questions, oldest first.
        flown_m: length of what was flown after the survey, metres.
        frames: pictures that were looked at.
        contradictions: answers that went against earlier ones.
        planned_s: cost of the plan that was chosen last, seconds.
        stop_reason: why no further question was asked.
        deliberation_max_s: the longest deliberation, its wording included.
    """

    def __init__(self) -> None:
        self.asked: list[AskedRecord] = []
        self.flown_m = 0.0
        self.frames = 0
        self.contradictions = 0
        self.planned_s: float | None = None
        self.stop_reason = ""
        self.deliberation_max_s = 0.0
        self._stages: dict[str, float] = {}
        self._perceived: list[float] = []
        self._drawn: list[float] = []
        self._path: list[np.ndarray] = []
        self._flying = False

    def record(self, event: Event) -> None:
        """Takes in one event."""
        match event:
            case Timed():
                self._timed(event)
            case Asked():
                self._asked(event)
            case Deliberated():
                self._thought_s = event.seconds
                self.deliberation_max_s = max(self.deliberation_max_s, event.seconds)
            case PlanChosen():
                self.planned_s = event.plan.cost_s if event.plan else None
                self.stop_reason = event.certificate.reason.value
            case LegFlown() if event.phase != "survey":
                self._flown(event)
            case Noticed() if event.kind == "contradiction":
                self.contradictions += 1
            case FrameSeen():
                self.frames += 1
            case _:
                pass

    @property
    def stages(self) -> Stages:
        """The time by stage."""
        seen = median(self._perceived) if self._perceived else 0.0
        drawn = median(self._drawn) if self._drawn else 0.0
        return Stages(
            perception=seen + drawn,
            deliberation=self._stages.get("deliberation", 0.0),
            wording=self._stages.get("wording", 0.0),
            answer=self._stages.get("answer", 0.0),
            planning=self._stages.get("planning", 0.0),
        )

    @property
    def survey_s(self) -> float:
        """Computing and simulating the survey."""
        return self._stages.get("survey", 0.0)

    @property
    def unsure(self) -> int:
        """Questions that were answered "I don't know"."""
        return sum(asked.reply == Reply.UNSURE.value for asked in self.asked)

    def path(self) -> tuple[tuple[float, float], ...]:
        """What was flown after the survey, from above, thinned."""
        if not self._path:
            return ()
        way = np.vstack(self._path)
        kept = way[:: max(1, len(way) // PATH_POINTS)]
        ends = np.vstack([kept, way[-1:]])
        return tuple((round(float(x), 2), round(float(y), 2)) for x, y, _ in ends)

    def _timed(self, event: Timed) -> None:
        if event.stage == "perception":
            self._perceived.append(event.seconds)
        elif event.stage == "mapping":
            self._drawn.append(event.seconds)
        elif not (event.stage == "deliberation" and self._flying):
            self._stages[event.stage] = self._stages.get(event.stage, 0.0) + event.seconds

    def _asked(self, event: Asked) -> None:
        self.deliberation_max_s = max(self.deliberation_max_s, self._thought_s + event.wording_s)
        self.asked.append(
            AskedRecord(
                text=event.question.text,
                query=event.question.query.id,
                reply=event.answer.reply.value,
                gain_bits=event.scored.gain_bits,
                wording_s=event.wording_s,
            )
        )

    def _flown(self, event: LegFlown) -> None:
        self._flying = True
        self.flown_m += float(np.linalg.norm(np.diff(event.log.position_m, axis=0), axis=1).sum())
        self._path.append(event.log.position_m)

    _thought_s = 0.0
