"""From a run folder to a verification: the parts as they were, the steps as they were recorded."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from mintpilot.assembly.policies import make_metric, make_planner
from mintpilot.assembly.strategies import make_objective, make_strategy, parse_arguments
from mintpilot.assembly.talk import Talk
from mintpilot.core.errors import RecordError
from mintpilot.core.events import MissionStarted, Stepped
from mintpilot.mission.deliberation import DeliberationParts
from mintpilot.mission.replay import Verification, verify
from mintpilot.recording.event_log import LoggedEvent, read_event_log


@dataclass(frozen=True, slots=True, kw_only=True)
class Replayed:
    """What `mintpilot replay --verify` tells."""

    verification: Verification
    cut: str
    """Where the record breaks off; empty where it is whole."""
    lost: int
    """Events that could not be written then."""


def verify_run(run: Path) -> Replayed:
    """Thinks a recorded mission through again.

    Args:
        run: the run folder, or its events file.

    Raises:
        RecordError: it cannot be read, is damaged, is of another version, or lacks what a replay needs.
        UnknownNameError: the mission's strategy, planner or the like is not installed here.
    """
    log = read_event_log(run)
    events = iter(log)
    first = next((logged.event for logged in events), None)
    if not isinstance(first, MissionStarted):
        raise RecordError(f"{run}: the record does not begin with the start of a mission: give a whole run folder")
    result = verify(first, _steps(events), parts_of(first))
    if log.lost:
        raise RecordError(
            f"{run}: {log.lost} events could not be written when the mission was flown, so it cannot be replayed; "
            "the report is as good as before"
        )
    return Replayed(verification=result, cut=log.cut, lost=log.lost)


def parts_of(started: MissionStarted) -> DeliberationParts:
    """The parts of deliberation that the mission began with."""
    asking, seed = started.mission.asking, started.seed or 0
    name, *arguments = started.strategy.split(" ")
    return DeliberationParts(
        mission=started.mission,
        task=started.task,
        planner=make_planner(started.planner),
        strategy=make_strategy(name, seed=seed, arguments=parse_arguments(arguments)),
        metric=make_metric(asking.impact_metric),
        objective=make_objective(asking.objective, seed=seed),
        groups=started.groups,
        word=Talk(lang=started.language, names=dict(started.names)).word,
    )


def _steps(events: Iterator[LoggedEvent]) -> Iterator[tuple[int, Stepped]]:
    for logged in events:
        if isinstance(logged.event, Stepped):
            yield logged.number, logged.event
