"""How time passes beside a person: as on the wall, and whoever says something is heard at once."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.mission.scenes import hall

from mintpilot.assembly.components import Choices, VehicleChoice, components_for
from mintpilot.assembly.worlds import build_world
from mintpilot.core.events import ViewTaken
from mintpilot.core.inputs import OperatorInput, Ordered
from mintpilot.core.observation import CameraModel, Frame
from mintpilot.core.query import Order, Question
from mintpilot.mission.shell import HEARING_S, VIEW_S, Shell
from mintpilot.mission.state import MissionState
from mintpilot.mission.step import initial_state
from mintpilot.recording.recorders import MemoryRecorder

LENS = CameraModel(width=4, height=3, fx=3.0, fy=3.0, cx=2.0, cy=1.5)


class Wall:
    """A clock that stands still but for those who sleep, and for a camera that takes its time."""

    now_s = 0.0
    says_s = float("inf")
    attended, hears_once = True, False

    def clock(self) -> float:
        return self.now_s

    def sleep(self, seconds: float) -> None:
        self.now_s += seconds

    def show(self, question: Question, patience_s: float) -> None: ...

    def withdraw(self, question: str, why: str) -> None: ...

    def tell(self, text: str) -> None: ...

    def poll(self, time_s: float) -> tuple[OperatorInput, ...]:
        if self.now_s < self.says_s:
            return ()
        self.says_s = float("inf")
        return (Ordered(time_s=time_s, order=Order.HOLD),)


class Viewed:
    def __init__(self, wall: Wall, takes_s: float) -> None:
        self.wall, self.takes_s = wall, takes_s

    def capture(self) -> Frame:
        self.wall.now_s += self.takes_s
        return Frame(
            time_s=0.0,
            rgb=np.zeros((3, 4, 3), np.uint8),
            depth_m=np.ones((3, 4), np.float32),
            camera=LENS,
            world_from_camera=np.eye(4),
        )


@contextmanager
def shell(takes_s: float | None = None) -> Iterator[tuple[Wall, Callable[[], list[object]], MemoryRecorder]]:
    wall, recorder = Wall(), MemoryRecorder()
    world = build_world(hall(), base=Path(), seed=0)
    choices = Choices(vehicle=VehicleChoice.KINEMATIC)
    with components_for(world, choices, operators=(wall,), recorder=recorder) as parts:
        viewed = None if takes_s is None else Viewed(wall, takes_s)
        made = Shell(replace(parts, viewed=viewed), clock=wall.clock, sleep=wall.sleep)
        state: MissionState = initial_state(parts.setup, parts.vehicle.state())
        yield wall, lambda: list(made.observe(state)), recorder
        made.close()


def test_what_is_said_is_heard_before_the_piece_of_time_is_over() -> None:
    with shell() as (wall, observe, _):
        observe()
        begun_s = wall.now_s
        wall.says_s = begun_s + 0.03
        heard = observe()
        assert any(isinstance(event, Ordered) for event in heard)
        assert wall.now_s <= begun_s + 0.03 + HEARING_S + 1e-9


def test_time_passes_as_on_the_wall_whoever_interrupts() -> None:
    with shell() as (wall, observe, _):
        for number in range(40):
            if number % 3 == 0:
                wall.says_s = wall.now_s + 0.05
            events = observe()
            times = [event.time_s for event in events]
            assert max(times) - 0.1 - 1e-6 <= wall.now_s + 1e-6
        assert max(times) == pytest.approx(wall.now_s, abs=0.1 + 1e-6)


@pytest.mark.parametrize("takes_s", [0.01, 0.3])
def test_pictures_for_whoever_watches_come_five_times_a_second_where_there_is_time(takes_s: float) -> None:
    with shell(takes_s) as (wall, observe, recorder):
        times = [0.0]
        while times[-1] < 4.0:
            times.append(max(event.time_s for event in observe()))
        views = sum(isinstance(event, ViewTaken) for event in recorder.events)
        if takes_s < 0.1:
            assert views == pytest.approx(4.0 / VIEW_S, abs=2)
        else:
            assert 1 <= views < 0.5 * 4.0 / VIEW_S
        assert wall.now_s == pytest.approx(times[-1], abs=0.2 + takes_s * views)
