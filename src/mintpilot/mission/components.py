"""The components of a mission: everything that the loop works with."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from mintpilot.core.briefing import Briefing
from mintpilot.core.events import MissionStarted
from mintpilot.core.message import NOTHING, Message
from mintpilot.core.ports import Camera, Judge, Operator, Recorder, Vehicle
from mintpilot.mission.deliberation import DeliberationParts
from mintpilot.mission.map_source import MapSource
from mintpilot.mission.rewording import Improve
from mintpilot.mission.state import Setup
from mintpilot.mission.worker import InlineWorker, Worker


def _nothing() -> None:
    """Does nothing."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MissionComponents:
    """Ports and settings of one mission."""

    parts: DeliberationParts
    vehicle: Vehicle
    map_source: MapSource
    operators: tuple[Operator, ...]
    """All that may answer and give orders; the first answer counts."""
    recorder: Recorder
    worker: Callable[[DeliberationParts], Worker] = InlineWorker
    """Makes who works deliberations out."""
    begin_task: Callable[[], None] = _nothing
    """Called when the survey is over: a simulator brings a fresh battery."""
    spoken: Callable[[Message], str] = str
    """Puts what is told into the mission's language."""
    judge: Judge | None = None
    """In a simulator, says how it really went."""
    improve: Improve | None = None
    """Makes better words while the first ones are shown; None: nobody does."""
    remarks: Callable[[], Sequence[Message]] = tuple
    """What went wrong with the words since it was last called, in sentences."""
    surveys: bool = False
    """True where the first map is made by a survey flight."""
    simulated: bool = False
    """True in a simulator only: baselines may then fly what is not known to be passable."""
    lands: bool = False
    """True for a real vehicle: however the mission ends, it returns if it can, and lands."""
    begins_with: Message = NOTHING
    """Of a mission that begins with an earlier map: a sentence that says how old it is."""
    watch_map: bool = True
    """False where the map is given and nothing new can be seen."""
    camera_period_s: float = 0.5
    """Between pictures in flight, seconds."""
    viewed: Camera | None = None
    """Takes pictures for a person who watches, beside those that the map is made of; None: nobody does."""
    briefing: Briefing | None = None
    """What is shown before take-off and must be answered with yes; None: it takes off at once."""
    digests: bool = False
    """Whether each step's directives are kept as a digest, for a later replay."""
    strategy_name: str = "mint"
    planner_name: str = "grid"
    language: str = "en"
    names: tuple[tuple[str, str], ...] = ()
    language_model: str = "template"
    seed: int | None = None

    @property
    def setup(self) -> Setup:
        """What stays the same for the whole mission."""
        return Setup(
            mission=self.parts.mission,
            task=self.parts.task,
            surveys=self.surveys,
            simulated=self.simulated,
            lands=self.lands,
            briefing=self.briefing,
        )

    def started(self) -> MissionStarted:
        """The first event of the record."""
        return MissionStarted(
            mission=self.parts.mission,
            task=self.parts.task,
            seed=self.seed,
            strategy=self.strategy_name,
            language=self.language,
            names=self.names,
            language_model=self.language_model,
            groups=self.parts.groups,
            planner=self.planner_name,
            simulated=self.simulated,
            surveys=self.surveys,
            lands=self.lands,
            briefing=self.briefing,
        )
