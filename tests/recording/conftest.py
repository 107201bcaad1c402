"""A small mission told by hand: smoke on the direct way, a closed room that does not matter, three boxes."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

from mintpilot.core import events as ev
from mintpilot.core.gap import BLOCKED, PASSABLE, Assumptions, Candidate, GapKind, Joint, KnowledgeGap
from mintpilot.core.geometry import Box, GridFrame
from mintpilot.core.message import verbatim
from mintpilot.core.mission import Mission, Outcome, Verdict
from mintpilot.core.observation import Attribute, CameraModel, Detection, Frame, RegionKind
from mintpilot.core.plan import Leg, Plan, Site, Stop
from mintpilot.core.query import Answer, Literal, Query, Question, Reply, Saying, SayingKind
from mintpilot.core.semantic_map import Cell, Knowledge, MapObject, Region, Room, SemanticMap
from mintpilot.core.task import Action, Reference, SubGoal, Task
from mintpilot.core.trajectory import FlightEnd, FlightLog, Trajectory
from mintpilot.core.tree import Certificate, GapExplanation, LeafReason, Mint, Node, PlanClass, ScoredQuery, StopReason

HOSTILE = "<script>alert('x')</script> & \x1b[31m\"red\""
"""What a sign in a picture, or a model, may say."""
SMOKE, ROOM = "obstacle:smoke-1", "presence:room-1"
MakeEvents = Callable[..., tuple[ev.Event, ...]]


def picture(index: int) -> Frame:
    """A picture with a red box and grey smoke in it."""
    rng = np.random.default_rng(index)
    rgb = np.full((120, 160, 3), (176, 170, 158), np.uint8)
    rgb[60:] = (120, 118, 112)
    rgb[62:92, 30:58] = (190, 40, 36)
    rgb[30:80, 90:150] = 150 + rng.integers(0, 40, (50, 60, 1), dtype=np.uint8)
    camera = CameraModel(width=160, height=120, fx=120.0, fy=120.0, cx=80.0, cy=60.0)
    depth = np.full((120, 160), 4.0, np.float32)
    return Frame(time_s=index * 0.5, rgb=rgb, depth_m=depth, camera=camera, world_from_camera=np.eye(4))


def hall(smoke: Knowledge = Knowledge.OPEN, *, label: str = "box", description: str = "the grey smoke") -> SemanticMap:
    """A hall of 20 x 14 x 3 m with two racks, smoke between them, and a room in the corner."""
    frame = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.25, shape=(12, 56, 80))
    cells = np.full(frame.shape, Cell.FREE, np.uint8)
    cells[0] = cells[:, :1] = cells[:, -1:] = cells[:, :, :1] = cells[:, :, -1:] = Cell.OCCUPIED
    cells[:9, 26:30, 12:34] = cells[:9, 26:30, 44:66] = Cell.OCCUPIED
    cells[:, 44:56, 64:80] = Cell.UNKNOWN
    cells[:, 44, 64:80] = cells[:, 44:56, 64] = Cell.OCCUPIED
    cloud = np.zeros(frame.shape, bool)
    z, y, x = np.ogrid[:12, :56, :80]
    cloud |= (y - 28) ** 2 / 49 + (x - 39) ** 2 / 30 + z * 0 < 1
    region = Region(
        id="smoke-1", kind=RegionKind.SMOKE, cells=np.flatnonzero(cloud), passable=smoke, description=description,
        best_view=(2, 90, 30, 150, 80),
    )  # fmt: skip
    room = Room(
        id="room-1", door_m=Box(lo_m=(17.0, 10.9, 0.0), hi_m=(18.0, 11.2, 2.1)), viewpoint_m=(17.5, 9.8, 1.5),
        description="the closed room with the brown door", best_view=(3, 20, 20, 60, 100),
    )  # fmt: skip
    places = ((10.0, 11.6, "red"), (6.0, 12.0, "blue"), (15.0, 2.0, "yellow"))
    boxes = tuple(
        MapObject(
            id=f"{label}-{number}", label=label, sightings=4, best_view=(number, 30, 62, 58, 92),
            box_m=Box(lo_m=(x, y, 0.0), hi_m=(x + 0.6, y + 0.6, 0.6)),
            attributes=(Attribute(name="colour", value=colour), Attribute(name="size", value="small")),
        )
        for number, (x, y, colour) in enumerate(places, start=1)
    )  # fmt: skip
    return SemanticMap(frame=frame, cells=cells, objects=boxes, regions=(region,), rooms=(room,))


def way(points: list[tuple[float, float]], enters: frozenset[str] = frozenset()) -> Plan:
    """A plan at 1.5 m height through these points, one metre a second."""
    corners = np.array([(x, y, 1.5) for x, y in points])
    path = np.concatenate([np.linspace(a, b, 20) for a, b in pairwise(corners)])
    length = float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())
    stop = Stop(id="goal-1", action=Action.GO, sites=(Site(position_m=(10.3, 11.9, 0.3), label="box-1"),))
    leg = Leg(stop=stop, site=stop.sites[0], path_m=path, length_m=length, duration_s=length + 2)
    return Plan(legs=(leg,), cost_s=length + 2, relies_on=enters, enters=enters)


def flight(plan: Plan, *, share: float = 1.0, start_s: float = 0.0) -> tuple[Trajectory, FlightLog]:
    """The plan flown 3 cm to the east of where it should be, as far as ``share`` of it."""
    path = np.array(plan.path_m)
    time = np.linspace(0, plan.length_m, len(path))
    trajectory = Trajectory(
        time_s=time, position_m=path, velocity_mps=np.zeros_like(path), acceleration_mps2=np.zeros_like(path),
        yaw_rad=np.zeros(len(path)),
    )  # fmt: skip
    count = max(2, int(len(path) * share))
    end = FlightEnd.ARRIVED if share == 1 else FlightEnd.INTERRUPTED
    flown = path[:count] + np.array((0.03, 0.0, 0.0))
    return trajectory, FlightLog(end=end, time_s=time[:count] + start_s, position_m=flown, reference_m=path[:count])


@pytest.fixture
def make_events() -> MakeEvents:
    """Tells the mission; words and reply can be chosen."""
    return tell


def tell(*, label: str = "box", description: str = "the grey smoke near the gate", reply: Reply = Reply.NO,
         words: str = "no", ended: bool = True) -> tuple[ev.Event, ...]:  # fmt: skip
    """All events of the mission."""
    smoke = KnowledgeGap(
        id=SMOKE, kind=GapKind.OBSTACLE, subject="smoke-1", description=description, values=(PASSABLE, BLOCKED),
        prior=(0.5, 0.5), position_m=(9.8, 7.0, 1.5),
    )  # fmt: skip
    ids = tuple(f"{label}-{n}" for n in (1, 2, 3))
    target = KnowledgeGap(
        id="target:1", kind=GapKind.TARGET, subject="the medicine box", description="the medicine box", values=ids,
        prior=(0.9, 0.05, 0.05), position_m=(10.0, 8.0, 0.3),
        candidates=tuple(Candidate(id=i, position_m=(1.0, 1.0, 0.3), description=f"the {i}") for i in ids),
    )  # fmt: skip
    direct = way([(10, 2), (10, 10.4)], frozenset({SMOKE}))
    around = way([(10, 2), (18, 4), (18, 9), (10.5, 10.6)])
    given = Assumptions.exactly
    leaves = tuple(
        Node(given=given({SMOKE: value}), probability=0.5, optimistic=plan, cautious=around, divergence_m=6.5,
             leaf=LeafReason.RELIES_ON_NOTHING, plan=plan)
        for value, plan in ((PASSABLE, direct), (BLOCKED, around))
    )  # fmt: skip
    root = Node(given=Assumptions(), probability=1.0, optimistic=direct, cautious=around, divergence_m=6.5,
                branch_on=SMOKE, children=leaves)  # fmt: skip
    mint = Mint(
        root=root, belief=Joint(gaps=(smoke,), probability=np.array([0.5, 0.5])), nodes=3, class_of=np.array([0, 1]),
        classes=tuple(PlanClass(plan=leaf.plan, probability=0.5, given=(leaf.given,)) for leaf in leaves),
    )  # fmt: skip
    query = Query(literals=(Literal(gap=SMOKE, values=frozenset({PASSABLE}), saying=Saying(kind=SayingKind.VALUE)),))
    scored = ScoredQuery(query=query, score=1.0, gain_bits=1.0, regret_saved_s=5.9, reply_probabilities=(0.5, 0.5))
    question = Question(
        query=query, text=f"Can I fly through {description}?", yes_means="I fly straight through it, 10 s",
        no_means="I fly around it, 25 s", gaps=(smoke,),
    )  # fmt: skip
    chosen = direct if reply is Reply.YES else around
    certificate = Certificate(
        reason=StopReason.ONE_CLASS, top_class_probability=1.0, entropy_bits=0.0, best_gain_bits=0.0,
        bound_s=0.0 if reply in (Reply.YES, Reply.NO) else float("inf"),
        text=verbatim("One way to fly holds 100 % of the mass."),
    )  # fmt: skip
    explanations = (
        GapExplanation(gap_id=SMOKE, description=description, kind="obstacle", asked=True, relevant=True,
                   why=verbatim("Flying around costs 14.9 s more than 2.0 s, and the paths are 6.5 m apart."),
                   cost_if_favourable_s=direct.cost_s, cost_if_unfavourable_s=around.cost_s, divergence_m=6.5,
                   entropy_bits=1.0, gain_bits=1.0, regret_saved_s=5.9),
        GapExplanation(gap_id="target:1", description="the medicine box", kind="target", asked=False, relevant=False,
                   why=verbatim("Its entropy of 0.57 bit does not change the way by more than 0.4 s."),
                   cost_if_favourable_s=direct.cost_s, cost_if_unfavourable_s=float("inf"), entropy_bits=0.57),
    )  # fmt: skip
    trajectory, log = flight(chosen)
    mission = Mission(name="fire-warehouse", instruction="Bring the medicine box.", start_m=(10.0, 2.0, 1.5),
                      volume=Box(lo_m=(0, 0, 0), hi_m=(20, 14, 3)))  # fmt: skip
    task = Task(
        instruction=mission.instruction, subgoals=(SubGoal(action=Action.GO, reference=Reference(phrase="box")),)
    )
    before = hall(label=label, description=description)
    known = Knowledge.YES if reply is Reply.YES else Knowledge.NO
    survey, survey_log = flight(way([(2, 2), (18, 2), (18, 8)]))
    story: list[ev.Event] = [ev.MissionStarted(mission=mission, task=task, seed=7, strategy="mint")]
    for index in range(12):
        found = Detection(label=label, score=0.9, box_m=Box(lo_m=(1, 1, 0), hi_m=(2, 2, 1)), pixels=(30, 62, 58, 92),
                          frame_index=index, points_m=np.zeros((5, 3)))  # fmt: skip
        story.append(ev.FrameSeen(index=index, frame=picture(index), detections=(found,)))
    story += [
        ev.LegFlown(phase="survey", stop_id="", trajectory=survey, log=survey_log),
        ev.Timed(stage="survey", seconds=2.5),
        ev.MapUpdated(map=before, why="survey"),
        ev.Timed(stage="mapping", seconds=0.25),
        ev.Deliberated(round=1, gaps=(smoke, target), mint=mint, chosen=scored,
                       alternatives=(scored,), certificate=None, seconds=0.12),
        ev.Timed(stage="deliberation", seconds=0.12),
        ev.Asked(question=question, scored=scored, wording_s=0.001,
                 answer=Answer(reply=reply, latency_s=4.2, text=words)),
        ev.MapUpdated(map=hall(known, label=label, description=description), why="answer"),
        ev.Deliberated(round=2, gaps=(target,), mint=None, chosen=None, alternatives=(),
                       certificate=certificate, seconds=0.03),
        ev.Timed(stage="deliberation", seconds=0.03),
        ev.PlanChosen(plan=chosen, certificate=certificate, explanations=explanations),
        ev.Noticed(kind="new-object", text=verbatim(f"Something new was seen in flight: {label}.")),
        ev.LegFlown(phase="mission", stop_id="goal-1", trajectory=trajectory, log=log),
        ev.Timed(stage="flight", seconds=1.1),
    ]  # fmt: skip
    if ended:
        story.append(
            ev.MissionEnded(verdict=Verdict(outcome=Outcome.SUCCESS, reason=verbatim("Every goal was reached.")))
        )
    return tuple(story)
