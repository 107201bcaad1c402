"""What browsers see of a mission, made of its events in a thread of its own: the mission never waits for it."""

from __future__ import annotations

import math
from collections.abc import Callable

from mintpilot.console.board import Panes
from mintpilot.console.map_pane import map_pane
from mintpilot.console.pictures import Pictures, as_jpeg
from mintpilot.console.protocol import (
    AnswerLine,
    FlownPoint,
    LogLine,
    MissionPane,
    PathPane,
    PosePane,
    QuestionPane,
    TreePane,
    TreeRound,
)
from mintpilot.console.question_pane import path_points, question_pane
from mintpilot.console.steps import Progress
from mintpilot.console.told_pane import told_pane
from mintpilot.console.tree_pane import tree_pane
from mintpilot.core.decisions import AskQuestion, Explore, FlyPlan, FlyTrajectory, GoBack
from mintpilot.core.events import (
    Asked,
    Deliberated,
    Event,
    FactsChanged,
    FrameSeen,
    MapUpdated,
    MissionEnded,
    MissionStarted,
    Noticed,
    OrderTaken,
    PlanChosen,
    QuestionTimed,
    Stepped,
    StopsDone,
    ViewTaken,
)
from mintpilot.core.gap import GapKind
from mintpilot.core.geometry import Floats
from mintpilot.core.inputs import (
    Answered,
    DeliberationEnded,
    MapObserved,
    MissionBegun,
    MotionEnded,
    Ticked,
)
from mintpilot.core.message import Message, joined, message, verbatim
from mintpilot.core.mission import Verdict
from mintpilot.core.query import Answer, Evidence, Question
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.trajectory import VehicleState
from mintpilot.core.tree import Certificate, GapExplanation
from mintpilot.recording.build import speech_of
from mintpilot.recording.words import ORDER_WORDS, REPLY_WORDS
from mintpilot.wording.speech import Speech

_STEP_M = 0.1
"""Of the flown path: places nearer than this to the last one are left out, metres."""
_MAP_S = 1.0
"""The map is drawn anew no more often than this, seconds of mission time."""

_ROUNDS = 6
"""Earlier trees that are kept."""


class MissionView:
    """Keeps the panes of one mission. All methods are called by one thread.

    Args:
        board: where the panes stand.
        jpeg_of: the picture of an event; None: there is none any more.
    """

    def __init__(self, board: Panes, jpeg_of: Callable[[FrameSeen], bytes | None] = as_jpeg) -> None:
        self._board = board
        self._pictures = Pictures(board, jpeg_of)
        self._started: MissionStarted | None = None
        self._map: SemanticMap | None = None
        self._drawn_s = -math.inf
        self._clock_s = 0.0
        self._last_m: tuple[float, float, float] | None = None
        self._progress = Progress()
        self._asked: AskQuestion | None = None
        self._round: Deliberated | None = None
        self._called: dict[str, str] = {}
        self._explanations: dict[str, GapExplanation] = {}
        self._replies: list[tuple[Evidence, AnswerLine]] = []
        self._asked_gaps: frozenset[str] = frozenset()
        self._tree_shown: TreePane | None = None
        self._earlier: tuple[TreeRound, ...] = ()
        self._question: Question | None = None
        self._timed: QuestionTimed | None = None
        self._deadline_s = 0.0

    # What the operator port is told

    def show(self, question: Question, patience_s: float, *, again: bool = False) -> None:
        """The card of an open question, or the same one in other words, or with a read-back."""
        open_ = self._question
        if open_ is None or open_.id != question.id:
            self._log("question", question.text)
            self._asked_gaps |= set(question.query.gap_ids)
            self._tree(None)
        self._deadline_s = self._clock_s + patience_s
        self._question = question
        self._show(again=again)

    def show_again(self, question: Question) -> None:
        """Words were not understood, or a read-back was denied: the question itself once more."""
        if self._question is not None and self._question.id == question.id:
            self._question = question
            self._show(again=True)

    def withdraw(self, question: str, why: str) -> None:
        """The question is no longer open."""
        if self._question is not None and self._question.id == question:
            self._question = None
            self._pictures.clear()
            self._board.put("question", QuestionPane(closed=why))

    def tell(self, text: str) -> None:
        """What the drone says."""
        self._log("says", text)

    # What the recorder is told

    def record(self, event: Event) -> None:
        """Takes in one event."""
        match event:
            case Stepped():
                self._stepped(event)
            case FrameSeen():
                self._pictures.seen(event)
            case ViewTaken():
                self._pictures.viewed(event)
            case MissionStarted():
                self._begun(event)
            case MapUpdated():
                self._draw(event.map)
            case Deliberated():
                self._deliberated(event)
            case PlanChosen():
                self._chosen(event)
            case StopsDone():
                self._progress.did(event.stops)
                self._steps()
            case Asked():
                self._learnt(event)
            case OrderTaken():
                parts = [ORDER_WORDS[event.order], event.answer]
                self._log("order", self._speech(joined(parts, ": ")))
            case Noticed():
                self._log("note", self._speech(event.text))
            case QuestionTimed():
                self._timed = event
                if self._is_open(event.question):
                    self._show()
            case FactsChanged():
                self._board.put("told", told_pane(event, self._speech))
            case MissionEnded():
                self._ended(event)
            case _:
                pass

    def _begun(self, event: MissionStarted) -> None:
        self._started = event
        self._progress.begin(event.task, self._speech)
        self._mission()
        self._steps()
        self._log("begun", event.mission.instruction)

    def _mission(self, verdict: Verdict | None = None) -> None:
        assert self._started is not None
        mission = self._started.mission
        (left, bottom, _), (right, top, _) = mission.volume.lo_m, mission.volume.hi_m
        self._board.put(
            "mission",
            MissionPane(
                name=mission.name,
                instruction=mission.instruction,
                lang=self._started.language,
                strategy=self._started.strategy,
                start=mission.start_m,
                volume=(left, bottom, right, top),
                briefing=tuple(map(self._speech, self._started.briefing.lines)) if self._started.briefing else (),
                verdict=verdict.outcome.value if verdict is not None else "",
                reason=self._speech(verdict.reason) if verdict is not None else "",
                waited_s=verdict.waiting.delay_s if verdict is not None else 0.0,
                hidden_s=verdict.waiting.hidden_s if verdict is not None else 0.0,
            ),
        )

    def _ended(self, event: MissionEnded) -> None:
        if self._question is not None:
            self.withdraw(self._question.id, self._speech(message("the mission is over")))
        if self._started is not None:
            self._mission(event.verdict)
        self._log("ended", self._speech(event.verdict.reason))

    def _stepped(self, event: Stepped) -> None:
        input = event.input
        self._clock_s = max(self._clock_s, input.time_s)
        match input:
            case Ticked() | MissionBegun() | MotionEnded():
                if input.vehicle is not None:
                    self._pose(input.vehicle)
            case MapObserved() if self._clock_s >= self._drawn_s + _MAP_S or self._map is None:
                self._draw(input.map)
            case DeliberationEnded():
                self._decided(input)
            case Answered():
                said = input.answer.text or self._speech(_reply(input.answer))
                self._log("answer", f"{said} ({input.operator})" if input.operator else said)
            case _:
                pass
        if "WithdrawQuestion" in event.directives and self._question is not None:
            # The mission may be busy for a while before it says so: the card goes at once.
            self.withdraw(self._question.id, "")

    def _is_open(self, question: str) -> bool:
        return self._question is not None and self._question.id == question

    def _pose(self, vehicle: VehicleState) -> None:
        left_s = vehicle.endurance_left_s
        self._board.put(
            "pose",
            PosePane(
                time_s=round(vehicle.time_s, 2),
                position=_rounded(vehicle.position_m),
                yaw_rad=round(vehicle.yaw_rad, 3),
                speed_mps=round(math.hypot(*vehicle.velocity_mps), 2),
                battery_s=round(left_s, 1) if math.isfinite(left_s) else None,
                need_s=self._progress.need_s,
            ),
        )
        if self._last_m is None or math.dist(self._last_m, vehicle.position_m) >= _STEP_M:
            self._last_m = vehicle.position_m
            self._board.append("flown", FlownPoint(at=_rounded(vehicle.position_m)))

    def _draw(self, map: SemanticMap) -> None:
        self._map, self._drawn_s = map, self._clock_s
        height_m = self._started.mission.start_m[2] if self._started is not None else 1.0
        pane, picture = map_pane(map, height_m, self._speech, self._called)
        self._board.put("map", pane, picture)

    def _decided(self, event: DeliberationEnded) -> None:
        decision = event.decision
        if isinstance(decision, FlyTrajectory | Explore | GoBack):
            trajectory = decision.trajectory
            if self._progress.plan is None and trajectory is not None:
                self._path(trajectory.position_m, trajectory.duration_s)
        elif isinstance(decision, AskQuestion | FlyPlan):
            self._explanations |= {e.gap_id: e for e in decision.reasoning.explanations}
            self._asked = decision if isinstance(decision, AskQuestion) else None

    def _deliberated(self, event: Deliberated) -> None:
        before, answers = self._tree_shown, tuple(line for _, line in self._replies)
        if before is not None and before.root is not None and answers:
            kept = TreeRound(round=before.round, root=before.root, answers=answers)
            self._earlier = (*self._earlier, kept)[-_ROUNDS:]
        self._round, self._replies = event, []
        called = {gap.subject: gap.description for gap in event.gaps if gap.kind is not GapKind.TARGET}
        if not called.items() <= self._called.items():
            self._called |= called
            if self._map is not None:
                self._draw(self._map)
        self._tree(event.certificate)

    def _chosen(self, event: PlanChosen) -> None:
        self._explanations |= {e.gap_id: e for e in event.explanations}
        self._progress.plan = event.plan
        if event.plan is not None:
            self._path(event.plan.path_m, event.plan.cost_s)
        else:
            self._board.put("plan", PathPane())
        self._tree(event.certificate, event.plan.signature if event.plan is not None else "")
        self._log("plan", self._speech(event.certificate.text))
        self._steps()

    def _learnt(self, event: Asked) -> None:
        self._asked_gaps |= set(event.question.query.gap_ids)
        part = event.answer.part
        line = AnswerLine(question=event.question.text, reply=event.answer.text or self._speech(_reply(event.answer)))
        if part is not None:
            self._replies.append((Evidence(query=event.question.query, part=part), line))
        self._tree(None)

    def _tree(self, certificate: Certificate | None, flown: str = "") -> None:
        event = self._round
        if event is None:
            return
        pane = tree_pane(
            event.mint,
            event.gaps,
            self._replies,
            self._explanations.values(),
            round=event.round,
            asked=self._asked_gaps,
            flown=flown,
            certificate=certificate,
            earlier=self._earlier,
            speech=self._speech,
        )
        self._tree_shown = pane
        self._board.put("tree", pane)

    def _show(self, *, again: bool = False) -> None:
        question = self._question
        if question is None:
            return
        timed = self._timed if self._timed is not None and self._timed.question == question.id else None
        pane = question_pane(
            question,
            self._asked,
            self._explanations,
            speech=self._speech,
            deadline_s=timed.deadline_s if timed is not None else self._deadline_s,
            extended=timed is not None and timed.extended,
            again=again,
        )
        self._board.put("question", pane)
        self._pictures.about(question, self._map)

    @property
    def _speech(self) -> Speech:
        """The language in which the drone speaks."""
        return speech_of(self._started)

    def _path(self, path_m: Floats, seconds: float) -> None:
        self._board.put("plan", PathPane(points=path_points(path_m), seconds=round(seconds, 1)))

    def _steps(self) -> None:
        self._board.put("steps", self._progress.pane)

    def _log(self, kind: str, text: str) -> None:
        self._board.append("log", LogLine(time_s=round(self._clock_s, 1), kind=kind, text=text))


def _reply(answer: Answer) -> Message:
    return REPLY_WORDS.get(answer.reply) or verbatim(answer.reply.value)


def _rounded(point_m: tuple[float, float, float]) -> tuple[float, float, float]:
    x, y, z = (round(float(c), 2) for c in point_m)
    return (x, y, z)
