"""Map and task → what is not known, and which places are to be visited (method, sections 1 and 2)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from mintpilot.core.errors import InputError
from mintpilot.core.gap import PRESENT, Belief, GapKind, KnowledgeGap
from mintpilot.core.geometry import Vec3
from mintpilot.core.message import Message, Named, joined, message
from mintpilot.core.observation import PERSON
from mintpilot.core.plan import PRICE_S, PlanningProblem, Stop, VehicleLimits
from mintpilot.core.rule import Ruling
from mintpilot.core.semantic_map import Knowledge, Region, SemanticMap
from mintpilot.core.task import Action, Task, what_is_done
from mintpilot.uncertainty.describing import describe, place
from mintpilot.uncertainty.doubts import is_doubtful_person
from mintpilot.uncertainty.gaps import obstacle_gaps, people_gaps, presence_gaps
from mintpilot.uncertainty.keep_away import PREFIX
from mintpilot.uncertainty.matching import Standpoint
from mintpilot.uncertainty.targets import Binding, bind
from mintpilot.uncertainty.things import Thing, stands_for, things_of

SOMEBODY = "somebody who needs help"
"""Who is sought where everybody must be found."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Findings:
    """What map and task leave open, and what is to be done."""

    gaps: tuple[KnowledgeGap, ...]
    """All that is open and bears on the task, sorted by id."""
    stops: tuple[Stop, ...]
    """Ordered stops in order, then the optional ones, sorted by id."""
    problems: tuple[Message, ...]
    """A plain sentence for each reference that matches nothing, with what was seen instead."""
    sought: str = ""
    """What is sought and on no map yet, in plain words; empty where all that is sought was seen."""
    unseen: tuple[Message, ...] = ()
    """Those of the problems that end once more was seen."""
    wishes: tuple[str, ...] = ()
    """Ids of open regions that are stayed out of only because the person wished so. Where nothing can be flown,
    `find_gaps` with ``honour_wishes=False`` lets them be asked about."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Prices:
    """What leaving stops undone costs, for those that name no price of their own."""

    usual_s: float = PRICE_S
    """Seconds of flight."""
    people_s: float | None = None
    """Of people, seen or supposed; None: as usual."""


def find_gaps(
    map: SemanticMap,
    task: Task,
    *,
    start_m: Vec3,
    prior_passable: float = 0.5,
    finished: frozenset[str] = frozenset(),
    honour_wishes: bool = True,
) -> Findings:
    """Finds obstacle, target and presence gaps and the stops of the task.

    The order of objects, regions and rooms in the map does not matter, and ids stay the same when unrelated things are
    added.

    Args:
        map: what is believed of the world.
        task: what is to be done.
        start_m: where the drone is, metres; ``nearest`` and ``left`` are judged from there, looking towards the middle
            of the map.
        prior_passable: for regions that have no prior of their own.
        finished: ids of stops already fulfilled; they are left out, and gaps that only they depended on too.
        honour_wishes: False gives up what is only wished, and opens the gaps that rules settle: they say what is flown.
    """
    things = things_of(map)
    view = Standpoint(start_m=start_m, towards_m=map.frame.box.centre_m)
    bound = bind(task, things, view, finished=finished)
    avoided = _kept_out(map, task) if honour_wishes else ()
    gaps = [*bound.gaps.values(), *obstacle_gaps(map, things, prior_passable=prior_passable, leave_out=avoided)]
    stops = list(bound.stops)
    if task.seeks_people:
        looked_at = {site.label for stop in stops if not stop.gap for site in stop.sites}
        for more_gaps, more_stops in (
            presence_gaps(map, things, finished=finished, looked_at=looked_at),
            people_gaps(map, finished=finished, bound=looked_at),
        ):
            gaps += more_gaps
            stops += more_stops
    return Findings(
        gaps=tuple(sorted(told_apart(gaps, map.frame.box.lo_m), key=lambda gap: gap.id)),
        stops=tuple(_on_layer(stop, map) for stop in stops),
        problems=tuple(dict.fromkeys((*bound.problems, *_heights(task, map)))),
        sought=_sought(task, things, bound),
        unseen=tuple(bound.unmatched.values()),
        wishes=tuple(
            sorted(r.id for r in map.regions if honour_wishes and _is_wish(r, task) and r.passable is Knowledge.OPEN)
        ),
    )


def _sought(task: Task, things: Sequence[Thing], bound: Binding) -> str:
    """What matches nothing that was seen; of people whoever needs help, while nobody was seen for certain."""
    if bound.unmatched:
        return next(iter(bound.unmatched))
    seen = any(stands_for(t.label, PERSON) and not is_doubtful_person(t) for t in things)
    return "" if seen or not task.seeks_people else SOMEBODY


def _kept_out(map: SemanticMap, task: Task) -> frozenset[str]:
    """Ids of the regions that nobody need be asked about: rules or wishes keep out of them."""
    ruled = {rule.keeps_out_of for rule in task.rules}
    return frozenset(r.id for r in map.regions if _is_wish(r, task) or ruled & {r.id, str(r.kind)})


def _is_wish(region: Region, task: Task) -> bool:
    return region.kind in task.avoid or region.id.startswith(PREFIX)


def frame_problem(
    map: SemanticMap,
    task: Task,
    findings: Findings,
    *,
    start_m: Vec3,
    limits: VehicleLimits,
    finished: frozenset[str] = frozenset(),
    prices: Prices | None = None,
    belief: Belief | None = None,
    home_m: Vec3 | None = None,
    ruling: Ruling | None = None,
) -> PlanningProblem:
    """Puts map, findings and vehicle into the form that a planner takes.

    Args:
        map: what is believed of the world.
        task: what is to be done.
        findings: the gaps and stops that map and task come to.
        start_m: where the drone is, metres.
        limits: what the vehicle can do.
        finished: ids of stops already fulfilled.
        prices: of leaving stops undone; None: `PRICE_S` each.
        belief: says how likely it is that somebody is in a room; None: as the gaps' priors say.
        home_m: where the drone must be able to return to, metres; None: nowhere.
        ruling: the rules to be kept; None: there are none.

    Raises:
        InputError: nothing of the task can be done, since its phrases match nothing that was seen.
    """
    if not findings.stops and findings.problems and not finished:
        raise InputError(
            message(
                "nothing of '{instruction}' can be done: {why} Name something that was seen, or look at more of the "
                "place first.",
                instruction=task.instruction,
                why=joined(findings.problems),
            )
        )
    called = _called(things_of(map))
    return PlanningProblem(
        map=map,
        start_m=start_m,
        stops=tuple(_weighed(stop, task, findings, prices or Prices(), belief, called) for stop in findings.stops),
        gaps=findings.gaps,
        limits=limits,
        finished=finished,
        home_m=home_m,
        ruling=ruling,
    )


def _called(things: Sequence[Thing]) -> dict[str, str]:
    """Words for each thing, by id: what it is and what it stands next to; where needed its place in metres."""
    words = {thing.id: describe(thing) + place(thing, things) for thing in things}
    counts = Counter(words.values())
    return {
        thing.id: words[thing.id]
        if counts[words[thing.id]] == 1
        else f"{words[thing.id]} at x {thing.position_m[0]:.1f} m, y {thing.position_m[1]:.1f} m"
        for thing in things
    }


def _weighed(
    stop: Stop, task: Task, findings: Findings, prices: Prices, belief: Belief | None, called: Mapping[str, str]
) -> Stop:
    """The stop with its price, and the probability that it is needed."""
    if not stop.optional:
        subgoal = task.subgoals[int(stop.id.split(":")[1]) - 1]
        of_kind_s = prices.people_s if subgoal.reference.label == PERSON else None
        own_s = next((p for p in (subgoal.price_s, of_kind_s) if p is not None), prices.usual_s)
        number, named = int(stop.id.split(":")[1]), stop.id.split(":")[2:]
        step = task.step_for(number)
        text = what_is_done(Action.GO, called.get(named[0], named[0])) if step.action == "seek" and named else step.text
        return replace(stop, price_s=own_s, step=step.n, text=text)
    gap = next(gap for gap in findings.gaps if gap.id == stop.gap)
    value = stop.sites[0].value or PRESENT
    chance = belief.probability_of(gap.id, value) if belief else gap.prior[gap.values.index(value)]
    price_s = prices.usual_s if prices.people_s is None else prices.people_s
    seek = task.step_for(0).n
    about = next((one.description for one in gap.candidates if one.id == value), gap.description)
    text = message("look closer at {place}", place=Named(about)) if gap.is_thing else what_is_done(Action.LOOK, about)
    return replace(stop, price_s=price_s, chance=chance, step=seek, text=text)


def told_apart(gaps: Sequence[KnowledgeGap], corner_m: Vec3) -> list[KnowledgeGap]:
    """The gaps, with words added to those regions and rooms that are called alike: where they are on the map.

    Never relative to the drone, which the operator may not see. A question must name one thing. Where even that is not
    enough, decimetres are.
    """
    said = list(gaps)
    for digits in (0, 1):
        counts = Counter(gap.description for gap in said)
        alike = [g.kind is not GapKind.TARGET and counts[g.description] > 1 for g in said]
        said = [
            replace(was, description=f"{was.description} {_whereabouts(was.position_m, corner_m, digits)}")
            if mixed
            else now
            for was, now, mixed in zip(gaps, said, alike, strict=True)
        ]
    return said


def _whereabouts(position_m: Vec3, corner_m: Vec3, digits: int) -> str:
    parts = []
    for offset, forth, back in (
        (position_m[0] - corner_m[0], "east", "west"),
        (position_m[1] - corner_m[1], "north", "south"),
    ):
        if round(abs(offset), digits) > 0:
            parts.append(f"{abs(offset):.{digits}f} m {forth if offset > 0 else back}")
    return f"{' and '.join(parts)} of the map's south-west corner" if parts else "at the map's south-west corner"


def _heights(task: Task, map: SemanticMap) -> list[Message]:
    """A sentence for each height that a flat map does not have."""
    lo_m, hi_m = map.frame.box.lo_m[2], map.frame.box.hi_m[2]
    layer = (
        message("one layer, at {height_m:g} m", height_m=map.frame.box.centre_m[2])
        if map.frame.is_flat
        else message("heights from {lo_m:g} to {hi_m:g} m", lo_m=lo_m, hi_m=hi_m)
    )
    spare_m = max(0.25, map.frame.resolution_m) if map.frame.is_flat else 0.0
    return [
        message(
            "'{what}' at a height of {height_m:g} m cannot be flown: the map has {layer}.",
            what=goal.reference.phrase,
            height_m=goal.height_m,
            layer=layer,
        )
        for goal in task.subgoals
        if goal.height_m is not None and not lo_m - spare_m <= goal.height_m <= hi_m + spare_m
    ]


def _on_layer(stop: Stop, map: SemanticMap) -> Stop:
    """In a flat map every place is at the height of its one layer."""
    if not map.frame.is_flat:
        return stop
    z_m = map.frame.box.centre_m[2]
    sites = tuple(replace(s, position_m=(s.position_m[0], s.position_m[1], z_m)) for s in stop.sites)
    return replace(stop, sites=sites)
