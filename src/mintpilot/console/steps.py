"""How far the mission has got: each step of the task with its state, and what the rest of the plan takes."""

from __future__ import annotations

from collections.abc import Iterable

from mintpilot.console.protocol import StepPane, StepsPane
from mintpilot.core.plan import Plan
from mintpilot.core.task import Task
from mintpilot.wording.speech import Speech


class Progress:
    """The steps of one task.

    Attributes:
        plan: what is flown; None: nothing yet.
    """

    def __init__(self) -> None:
        self.plan: Plan | None = None
        self._texts: list[tuple[str, str]] = []
        self._done: set[str] = set()

    def begin(self, task: Task, speech: Speech) -> None:
        """Takes over the task, told in that language."""
        self._texts, self._done = _keys(task, speech), set()

    def did(self, stops: Iterable[str]) -> None:
        """Takes in which stops were done so far."""
        self._done = set(stops)

    @property
    def need_s(self) -> float | None:
        """What the rest of the plan takes, seconds; None without a plan."""
        if self.plan is None:
            return None
        return round(sum(leg.duration_s for leg in self.plan.legs if leg.stop.id not in self._done), 1)

    @property
    def pane(self) -> StepsPane:
        """All steps with their states."""
        stops = [leg.stop.id for leg in self.plan.legs] if self.plan is not None else []
        following = next((stop for stop in stops if stop not in self._done), "")
        known = [key for key, _ in self._texts if key]
        steps = []
        for key, text in self._texts:
            mine = [stop for stop in {*stops, *self._done} if _belongs(stop, key, known)]
            state = "open"
            if following in mine:
                state = "now"
            elif mine and all(stop in self._done for stop in mine):
                state = "done"
            elif self.plan is not None and not mine and not key:
                state = "left-out"
            steps.append(StepPane.model_validate({"text": text, "state": state}))
        return StepsPane(steps=tuple(steps))


def _keys(task: Task, speech: Speech) -> list[tuple[str, str]]:
    """(id of the stops' common beginning, text) of each step; without an id: all stops that belong to no other."""
    goals = list(enumerate(task.subgoals, 1))
    found: list[tuple[str, str]] = []
    for step in task.steps:
        key = ""
        while step.action != "seek" and goals and not key:
            number, goal = goals.pop(0)
            if goal.action == step.action and goal.reference.phrase in (step.target, step.place):
                key = f"{goal.action}:{number}"
        found.append((key, speech(step.text)))
    return found


def _belongs(stop: str, key: str, known: list[str]) -> bool:
    if key:
        return stop == key or stop.startswith(f"{key}:")
    return not any(stop == other or stop.startswith(f"{other}:") for other in known)
