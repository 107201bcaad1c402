"""All that a mission has told so far, sorted by kind."""

from __future__ import annotations

from dataclasses import dataclass, field

from mintpilot.core.events import (
    Asked,
    Deliberated,
    Event,
    FactsChanged,
    FrameSeen,
    LegFlown,
    MapUpdated,
    MissionEnded,
    MissionStarted,
    Noticed,
    OrderTaken,
    PlanChosen,
    QuestionTimed,
    Stepped,
    StopsDone,
    Timed,
    ViewTaken,
)
from mintpilot.core.gap import KnowledgeGap
from mintpilot.core.query import Evidence
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.tree import Mint


@dataclass(slots=True, kw_only=True)
class History:
    """Collects events; pictures are counted, not kept."""

    started: MissionStarted | None = None
    frames: int = 0
    map: SemanticMap | None = None
    """The latest one."""
    deliberations: list[Deliberated] = field(default_factory=list)
    asked: list[Asked] = field(default_factory=list)
    chosen: list[PlanChosen] = field(default_factory=list)
    legs: list[LegFlown] = field(default_factory=list)
    notices: list[Noticed] = field(default_factory=list)
    orders: list[OrderTaken] = field(default_factory=list)
    timings_s: dict[str, float] = field(default_factory=dict)
    """Seconds in all for each stage."""
    ended: MissionEnded | None = None

    def add(self, event: Event) -> None:
        """Takes in one event."""
        match event:
            case MissionStarted():
                self.started = event
            case FrameSeen():
                self.frames += 1
            case MapUpdated():
                self.map = event.map
            case Deliberated():
                self.deliberations.append(event)
            case Asked():
                self.asked.append(event)
            case PlanChosen():
                self.chosen.append(event)
            case LegFlown():
                self.legs.append(event)
            case Noticed():
                self.notices.append(event)
            case OrderTaken():
                self.orders.append(event)
            case Stepped() | FactsChanged() | StopsDone() | QuestionTimed() | ViewTaken():
                pass
            case Timed():
                self.timings_s[event.stage] = self.timings_s.get(event.stage, 0.0) + event.seconds
            case MissionEnded():
                self.ended = event

    @property
    def mint(self) -> Mint | None:
        """The largest tree that was built, the earliest among equals: the one that explains most."""
        trees = [d.mint for d in self.deliberations if d.mint is not None]
        return max(trees, key=lambda mint: mint.nodes, default=None)

    @property
    def gaps(self) -> tuple[KnowledgeGap, ...]:
        """Every gap that was ever open, in the order in which they were found."""
        found: dict[str, KnowledgeGap] = {}
        for deliberation in self.deliberations:
            for gap in deliberation.gaps:
                found.setdefault(gap.id, gap)
        return tuple(found.values())

    @property
    def asked_gaps(self) -> frozenset[str]:
        """Ids of the gaps that some question spoke of."""
        return frozenset(gap for asked in self.asked for gap in asked.question.query.gap_ids)

    @property
    def replies(self) -> tuple[Evidence, ...]:
        """The queries that were answered, in order, with what was said beyond them."""
        return tuple(
            reply
            for a in self.asked
            if a.answer.part is not None
            for reply in (Evidence(query=a.question.query, part=a.answer.part), *a.answer.also)
        )

    @property
    def flown_signature(self) -> str:
        """Signature of the plan chosen last; empty where none was."""
        plan = self.chosen[-1].plan if self.chosen else None
        return "" if plan is None else plan.signature
