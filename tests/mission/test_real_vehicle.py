"""What a mission does beside a real vehicle: it ends on the ground, asks for a hand, and obeys a pilot's switch."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from mintpilot.assembly.components import Choices, VehicleChoice, components_for, scripted_operator
from mintpilot.assembly.worlds import build_world
from mintpilot.core.inputs import Link, LinkChanged, MotionEnded, Ordered
from mintpilot.core.motion import FollowTrajectory, Land, PerformAction
from mintpilot.core.ports import Vehicle
from mintpilot.core.query import Order
from mintpilot.mission.loop import fly_mission
from mintpilot.mission_file.reader import read_mission
from mintpilot.mission_file.schema import OperatorSpec
from mintpilot.recording.recorders import NullRecorder

EXAMPLES = Path(__file__).parents[2] / "examples"


class Beside(Vehicle):
    """The kinematic drone without a gripper; a pilot may take over when it begins its n-th flight.

    Attributes:
        motions: what it was told to do.
    """

    def __init__(self, simulator, *, by_hand: str = "", taken_at: int | None = None) -> None:
        self._simulator, self._by_hand, self._taken_at = simulator, by_hand, taken_at
        self.motions = []

    def state(self):
        return self._simulator.state()

    def command(self, motion):
        self.motions.append(motion)
        self._simulator.command(motion)

    def brake(self):
        self._simulator.brake()

    def hold(self):
        self._simulator.hold()

    def advance(self, until_s):
        flights = sum(isinstance(motion, FollowTrajectory) for motion in self.motions)
        if self._taken_at is not None and flights >= self._taken_at:
            self._taken_at = None
            lost = LinkChanged(time_s=self.state().time_s, link=Link.CONTROL, up=False, reason="mode POSCTL: hands off")
            return (lost,)
        acts = {motion.id for motion in self.motions if isinstance(motion, PerformAction)}
        return tuple(
            replace(event, by_hand=self._by_hand) if isinstance(event, MotionEnded) and event.motion in acts else event
            for event in self._simulator.advance(until_s)
        )


class Helper:
    """Says 'continue' when a thing was attached or taken, and answers nothing."""

    attended = False
    hears_once = False

    def __init__(self, willing: bool = True) -> None:
        self.told: list[str] = []
        self._willing, self._done = willing, 0

    def show(self, question, patience_s):
        """It does not answer."""

    def withdraw(self, question, why):
        """Nothing to do."""

    def tell(self, text):
        self.told.append(text)

    def poll(self, time_s):
        wanted = sum("by hand" in text for text in self.told) if self._willing else 0
        orders = [Ordered(time_s=time_s, order=Order.CONTINUE)] * (wanted - self._done)
        self._done = wanted
        return tuple(orders)


def flown(helper: Helper, **options):
    """The verdict of the medicine mission beside such a vehicle, and the vehicle."""
    path = EXAMPLES / "medicine.yaml"
    world = build_world(read_mission(path), base=path.parent, seed=0)
    operators = (scripted_operator(world, OperatorSpec()), helper)
    choices = Choices(vehicle=VehicleChoice.KINEMATIC)
    with components_for(world, choices, operators=operators, recorder=NullRecorder()) as made:
        vehicle = Beside(made.vehicle, **options)
        components = replace(made, vehicle=vehicle, judge=None, simulated=False, lands=True)
        return fly_mission(components), vehicle


def test_a_real_mission_ends_on_the_ground_at_the_start():
    verdict, vehicle = flown(Helper())
    assert verdict.outcome.value == "success"
    assert isinstance(vehicle.motions[-1], Land)
    assert vehicle.state().position_m[2] < 0.2


def test_where_the_vehicle_cannot_a_person_lends_a_hand():
    helper = Helper()
    verdict, vehicle = flown(helper, by_hand="Attach it by hand")
    assert verdict.outcome.value == "success"
    acts = [motion.stop.id for motion in vehicle.motions if isinstance(motion, PerformAction)]
    assert len(acts) == len(set(acts)) == 2, "what was done by hand is not done again"
    assert sum("say 'continue'" in text and "by hand" in text for text in helper.told) == 2


@pytest.mark.long
def test_where_nobody_lends_a_hand_it_goes_home():
    verdict, vehicle = flown(Helper(willing=False), by_hand="Attach it by hand")
    assert verdict.outcome.value == "aborted"
    assert isinstance(vehicle.motions[-1], Land)


@pytest.mark.parametrize("flight", [1, 2])
def test_whoever_takes_over_has_it_and_it_is_said(flight):
    helper = Helper()
    verdict, vehicle = flown(helper, taken_at=flight)
    assert verdict.outcome.value == "aborted"
    assert "hands off" in str(verdict.reason)
    assert sum(isinstance(motion, FollowTrajectory) for motion in vehicle.motions) == flight
    assert not isinstance(vehicle.motions[-1], Land)
    assert any("not flying any more" in text for text in helper.told)
