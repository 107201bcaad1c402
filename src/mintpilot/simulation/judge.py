"""How a simulated mission really went: the truth of the scene against what the drone did."""

from __future__ import annotations

import math

import numpy as np

from mintpilot.core.geometry import Bools, Box, Floats, Vec3
from mintpilot.core.message import Message, joined, message, verbatim
from mintpilot.core.mission import Outcome, Verdict
from mintpilot.core.plan import Stop
from mintpilot.core.ports import Judge
from mintpilot.core.room_view import RoomView
from mintpilot.core.task import Action
from mintpilot.simulation.scene import FlightRules, Landmark, Person, Scene, Solid

BODY_M = 1.7
"""Length of a person lying down."""


class SceneJudge(Judge):
    """Judges by true positions, touches and acts, which a simulator feeds in order.

    The mission's clock (endurance, late solids) stands still until `begin_mission`: a survey before it is flown on
    another battery. Everything else counts from the start. The first failure stays.

    Args:
        scene: the truth.
        rules: what ends a flight, and how near is near enough.
    """

    def __init__(self, scene: Scene, rules: FlightRules) -> None:
        self._scene = scene
        self._rules = rules
        self._failure: Verdict | None = None
        self._mission_start_s = math.inf
        self._goals_left = list(scene.goal_objects)
        self._carried = ""
        self._found: set[str] = set()

    def begin_mission(self, time_s: float) -> None:
        """The mission's clock runs from this moment of the vehicle's clock on, with a fresh battery."""
        self._mission_start_s = time_s

    def mission_s(self, time_s: float) -> float:
        """Seconds of mission flight at that time of the vehicle's clock; below 0 before the mission."""
        return time_s - self._mission_start_s

    def endurance_left_s(self, time_s: float) -> float:
        """Flight time that is left, seconds, not below 0."""
        return max(self._rules.endurance_s - max(self.mission_s(time_s), 0.0), 0.0)

    def first_failure(self, time_s: Floats, position_m: Floats) -> tuple[int, Verdict] | None:
        """The first sample of a flight that fails the mission, and why; changes nothing.

        Args:
            time_s: (n,) vehicle's clock.
            position_m: (n, 3) true positions of the drone's centre.
        """
        found: list[tuple[int, Verdict]] = []
        for smoke in self._scene.smokes:
            if smoke.toxic:
                inside = self._touches(smoke.extent_m, position_m)
                toxic = message("its hull was in the toxic smoke '{smoke}'", smoke=smoke.id)
                self._note(found, inside, Outcome.TOXIC_SMOKE, toxic)
        outside = ~self._scene.volume.contains(position_m)
        self._note(found, outside, Outcome.LEFT_VOLUME, message("it left the volume in which it may fly"))
        spent = time_s - self._mission_start_s > self._rules.endurance_s
        reason = message("its endurance of {seconds:g} s was spent in the air", seconds=self._rules.endurance_s)
        self._note(found, spent, Outcome.ENDURANCE, reason)
        return min(found, key=lambda item: item[0]) if found else None

    def observe(self, time_s: Floats, position_m: Floats) -> int | None:
        """As `first_failure`, and the failure counts. Returns the index of the failing sample, if any."""
        first = self.first_failure(time_s, position_m)
        if first is None:
            return None
        self.fail(first[1])
        return first[0]

    def fail(self, verdict: Verdict) -> None:
        """Something ended the mission; only the first such thing counts."""
        self._failure = self._failure or verdict

    def touched(self, what: str) -> None:
        """The drone touched something: any contact is a collision."""
        self.fail(collision(verbatim(what)))

    def hovered(self, position_m: Vec3) -> None:
        """The drone came to rest here: people in the open within reach count as found."""
        for person in self._scene.persons:
            if _distance_to_person(position_m, person) <= self._rules.person_reach_m:
                self._found.add(person.id)
        for mark in self._scene.landmarks:
            if box_distance(mark.extent_m, position_m) <= self._rules.person_reach_m:
                self._found.add(mark.id)

    def acted(self, stop: Stop, position_m: Vec3) -> None:
        """The drone did what the stop is for, from this position, and stayed its time.

        What it reaches for is the object nearest to the stop's site; of a stop with several sites, to the one nearest
        to the drone. Only solids and landmarks of the kinds among the goal objects count as objects; all do while one
        of the goals is not declared.
        """
        self.hovered(position_m)
        if stop.action is Action.LOOK:
            for room in self._scene.rooms:
                near = math.dist(position_m, room.viewpoint_m) <= self._rules.look_reach_m
                if near and room.occupant is not None:
                    self._found.add(room.occupant.id)
            return
        target = self._target(stop, position_m)
        if stop.action is Action.PICK:
            self._picked(target, position_m)
            return
        if stop.action is Action.DELIVER:
            self._carried = ""
        if target is None or not self._goals_left or self._goals_left[0] not in ("", target.id):
            return
        if box_distance(target.extent_m, position_m) <= self._rules.pick_reach_m:
            self._goals_left.pop(0)

    def view(self, stop: Stop, position_m: Vec3) -> RoomView | None:
        """What is seen of the room that is looked into from there; None: no room is."""
        for room in self._scene.rooms if stop.action is Action.LOOK else ():
            if math.dist(position_m, room.viewpoint_m) <= self._rules.look_reach_m:
                return RoomView(people=int(room.occupant is not None), seen_share=1.0)
        return None

    def people(self) -> tuple[int, int]:
        """(how many of the people who must be found were found, how many there are)."""
        wanted = self._wanted_people()
        return sum(name in self._found for name in wanted), len(wanted)

    def verdict(self) -> Verdict | None:
        """The failure that has happened, if any."""
        return self._failure

    def final(self) -> Verdict:
        """The verdict at the end: the first failure, else somebody missed, else something not reached, else success."""
        if self._failure is not None:
            return self._failure
        missed = [name for name in self._wanted_people() if name not in self._found]
        if missed:
            who = message("nobody found {who}, who needs help", who=_listed(missed))
            return Verdict(outcome=Outcome.PERSON_MISSED, reason=who)
        if self._goals_left:
            left = _listed(self._goals_left)
            return Verdict(outcome=Outcome.NOT_REACHED, reason=message("it never got to {what}", what=left))
        return Verdict(outcome=Outcome.SUCCESS, reason=message("everything was reached, nothing was touched"))

    def _picked(self, target: Solid | Landmark | None, position_m: Vec3) -> None:
        wanted = self._goals_left[0] if self._goals_left else None
        if target is None or wanted not in ("", target.id):
            taken = _listed([target.id]) if target is not None else message("nothing that can be taken")
            meant = message("'{what}' was meant", what=wanted) if wanted else message("nothing more was to be taken")
            reason = message("it reached for {taken}, but {meant}", taken=taken, meant=meant)
            self.fail(Verdict(outcome=Outcome.WRONG_TARGET, reason=reason))
            return
        gap = box_distance(target.extent_m, position_m)
        if gap > self._rules.pick_reach_m:
            reason = message(
                "it reached for '{what}' from {gap_m:.2f} m away, farther than {reach_m:g} m",
                what=target.id,
                gap_m=gap,
                reach_m=self._rules.pick_reach_m,
            )
            self.fail(Verdict(outcome=Outcome.WRONG_TARGET, reason=reason))
            return
        self._carried = self._goals_left.pop(0)

    def _target(self, stop: Stop, position_m: Vec3) -> Solid | Landmark | None:
        things: list[Solid | Landmark] = [*self._scene.solids, *self._scene.landmarks]
        goals = self._scene.goal_objects
        kinds = {t.kind for t in things if t.id in goals}
        objects = [t for t in things if t.kind in kinds or "" in goals]
        places = [site.position_m for site in stop.sites] or [position_m]
        place = min(places, key=lambda p: math.dist(p, position_m))
        wanted = self._goals_left[0] if self._goals_left else ""
        # A bare place may lie in a thing: then the one that is wanted counts.
        return min(objects, key=lambda t: (box_distance(t.extent_m, place), t.id != wanted, t.id), default=None)

    def _wanted_people(self) -> list[str]:
        inside = [room.occupant for room in self._scene.rooms if room.occupant is not None]
        people: list[Person | Landmark] = [*self._scene.persons, *inside, *self._scene.landmarks]
        return [p.id for p in people if p.must_be_found]

    def _touches(self, box: Box, position_m: Floats) -> Bools:
        """At which positions (n, 3) of its centre the drone's hull, an upright cylinder, reaches into a box."""
        beyond = np.maximum(np.maximum(box.lo_m - position_m, position_m - box.hi_m), 0.0)
        beside = np.hypot(beyond[:, 0], beyond[:, 1]) < self._rules.radius_m
        touching: Bools = beside & (beyond[:, 2] < self._rules.half_height_m)
        return touching

    @staticmethod
    def _note(found: list[tuple[int, Verdict]], flags: np.ndarray, outcome: Outcome, reason: Message) -> None:
        if flags.any():
            found.append((int(np.argmax(flags)), Verdict(outcome=outcome, reason=reason)))


def collision(what: Message) -> Verdict:
    """The verdict on touching something."""
    return Verdict(outcome=Outcome.COLLISION, reason=message("it touched {what}", what=what))


def box_distance(box: Box, point_m: Vec3) -> float:
    """Metres from a point to the nearest point of a box; 0 inside."""
    gaps = (max(lo - x, 0.0, x - hi) for lo, x, hi in zip(box.lo_m, point_m, box.hi_m, strict=True))
    return math.hypot(*gaps)


def _distance_to_person(point_m: Vec3, person: Person) -> float:
    """Metres to the nearest point of the body's axis."""
    axis = np.array([math.cos(person.yaw_rad), math.sin(person.yaw_rad), 0.0])
    off = np.asarray(point_m) - person.position_m
    along = float(np.clip(off @ axis, -BODY_M / 2, BODY_M / 2))
    return float(np.linalg.norm(off - along * axis))


def _listed(names: list[str]) -> Message:
    """Names in quotation marks; an empty one: what the instruction means."""
    told = [message("'{name}'", name=name) if name else message("what the instruction means") for name in names]
    return joined(told, ", ")
