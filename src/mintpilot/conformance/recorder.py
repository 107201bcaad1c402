"""Check of recorders: whoever keeps what happened."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

from mintpilot.assembly.components import Choices, VehicleChoice, components_for, scripted_operator
from mintpilot.conformance.sample import sample_world
from mintpilot.core.errors import ConformanceError
from mintpilot.core.events import Event, MissionEnded, Noticed, Timed
from mintpilot.core.message import verbatim
from mintpilot.core.mission import Outcome, Verdict
from mintpilot.core.ports import Recorder
from mintpilot.mission.loop import fly_mission
from mintpilot.mission_file.schema import OperatorSpec

_HOSTILE = "<script>alert(1)</script>\x00\x1b[2J\r\n" + "long " * 5000 + "\ud800"


class _Kept(Recorder):
    def __init__(self) -> None:
        self.events: list[Event] = []

    def record(self, event: Event) -> None:
        self.events.append(event)


def check_recorder(make: Callable[[], Recorder]) -> None:
    """Tells it a whole small mission, then events out of order and in hostile words. It must take them all.

    Args:
        make: makes a fresh recorder; called more than once.

    Raises:
        ConformanceError: it breaks the contract of `mintpilot.core.ports.Recorder`.
    """
    mission = sample_events()
    _tell(make(), mission, "a whole mission")
    verdict = Verdict(outcome=Outcome.ABORTED, reason=verbatim(_HOSTILE))
    _tell(make(), (MissionEnded(verdict=verdict), *mission[:2]), "an end before the beginning")
    strange = (Noticed(kind="conformance", text=verbatim(_HOSTILE)), Timed(stage=_HOSTILE[:40], seconds=0.0))
    _tell(make(), (*mission[:3], *strange, MissionEnded(verdict=verdict)), "hostile words")


@cache
def sample_events() -> tuple[Event, ...]:
    """The events of the small mission, flown by the kinematic drone."""
    world, kept = sample_world(), _Kept()
    choices = Choices(vehicle=VehicleChoice.KINEMATIC)
    operator = scripted_operator(world, OperatorSpec())
    with components_for(world, choices, operators=(operator,), recorder=kept) as crew:
        fly_mission(crew)
    return tuple(kept.events)


def _tell(recorder: Recorder, events: tuple[Event, ...], what: str) -> None:
    for event in events:
        try:
            recorder.record(event)
        except Exception as error:
            raise ConformanceError(
                f"{type(recorder).__name__}: {what}: `record` raised {error!r} at {type(event).__name__}; it must note "
                "the loss and go on, since the drone is in the air"
            ) from error
