"""The oracle answers by geometry, whatever the ids on the map are."""

from __future__ import annotations

import pytest

from mintpilot.core.gap import (
    ABSENT,
    BLOCKED,
    NONE_OF_THEM,
    NOT_YET_SEEN,
    PASSABLE,
    PRESENT,
    Candidate,
    GapKind,
    KnowledgeGap,
)
from mintpilot.core.geometry import Vec3
from mintpilot.simulation.scenarios import make_scenario
from mintpilot.simulation.truth import SceneTruth


def gap(kind: GapKind, at_m: Vec3, *values: str, candidates: tuple[Candidate, ...] = ()) -> KnowledgeGap:
    prior = (1 / len(values),) * len(values)
    return KnowledgeGap(
        id="gap", kind=kind, subject="it", description="it", values=values, prior=prior, position_m=at_m,
        candidates=candidates,
    )  # fmt: skip


def shifted(place: Vec3, by_m: float) -> Vec3:
    return (place[0] + by_m, place[1], place[2])


@pytest.mark.parametrize(("prior", "truth"), [(0.0, PASSABLE), (1.0, BLOCKED)])
def test_smoke(prior: float, truth: str) -> None:
    scene = make_scenario("fire-warehouse", 1, prior_toxic=prior).scene
    oracle = SceneTruth(scene)
    cloud = scene.smokes[0].extent_m
    assert oracle.value_of(gap(GapKind.OBSTACLE, cloud.centre_m, PASSABLE, BLOCKED)) == truth
    outside = (cloud.lo_m[0] - 0.8, cloud.centre_m[1], 1.5)
    assert oracle.value_of(gap(GapKind.OBSTACLE, outside, PASSABLE, BLOCKED)) == truth


def test_an_obstacle_without_smoke_is_blocked_where_something_stands_and_nothing_in_the_open() -> None:
    scene = make_scenario("medicine-boxes", 1).scene
    oracle = SceneTruth(scene)
    assert oracle.value_of(gap(GapKind.OBSTACLE, scene.solids[0].extent_m.centre_m, PASSABLE, BLOCKED)) == BLOCKED
    assert oracle.value_of(gap(GapKind.OBSTACLE, (0.2, 0.2, 3.8), PASSABLE, BLOCKED)) is None


@pytest.mark.parametrize(("prior", "truth"), [(0.0, ABSENT), (1.0, PRESENT)])
def test_rooms(prior: float, truth: str) -> None:
    scene = make_scenario("fire-warehouse", 2, prior_occupied=prior).scene
    oracle = SceneTruth(scene)
    door = scene.rooms[0].door_m.centre_m
    assert oracle.value_of(gap(GapKind.PRESENCE, shifted(door, 0.4), PRESENT, ABSENT)) == truth
    assert oracle.value_of(gap(GapKind.PRESENCE, scene.start_m, PRESENT, ABSENT)) is None


def test_a_value_outside_the_gaps_domain_is_no_answer() -> None:
    scene = make_scenario("fire-warehouse", 2, prior_occupied=0.0).scene
    door = scene.rooms[0].door_m.centre_m
    assert SceneTruth(scene).value_of(gap(GapKind.PRESENCE, door, PRESENT)) is None


@pytest.mark.parametrize("seed", range(10))
def test_the_box_meant_is_found_among_misplaced_candidates(seed: int) -> None:
    scene = make_scenario("medicine-boxes", seed).scene
    places = {s.id: s.extent_m.centre_m for s in scene.solids}
    candidates = tuple(Candidate(id=f"map-{i}", position_m=shifted(p, 0.25)) for i, p in enumerate(places.values()))
    ids = tuple(c.id for c in candidates)
    meant = f"map-{list(places).index(scene.goal_objects[0])}"
    asked = gap(GapKind.TARGET, (6.0, 5.0, 0.3), *ids, candidates=candidates)
    assert SceneTruth(scene).value_of(asked) == meant


def test_a_phrase_for_a_person_means_the_injured_one() -> None:
    scene = make_scenario("medicine-boxes", 0).scene
    true = Candidate(id="person-1", position_m=shifted(scene.persons[0].position_m, 0.3))
    false = Candidate(id="person-2", position_m=(0.5, 9.5, 0.0))
    asked = gap(GapKind.TARGET, (6.0, 5.0, 0.3), "person-2", "person-1", candidates=(false, true))
    assert SceneTruth(scene).value_of(asked) == "person-1"
    alone = gap(GapKind.TARGET, (6.0, 5.0, 0.3), "person-2", candidates=(false,))
    assert SceneTruth(scene).value_of(alone) is None


def test_an_ordered_quantity_is_not_known() -> None:
    scene = make_scenario("medicine-boxes", 0).scene
    assert SceneTruth(scene).value_of(gap(GapKind.VALUE, scene.start_m, "1", "2")) is None


def test_where_the_thing_meant_is_no_candidate_it_is_none_of_them() -> None:
    scene = make_scenario("medicine-boxes", 3).scene
    wrong = Candidate(id="thing-1", position_m=scene.start_m)
    about = gap(GapKind.TARGET, scene.start_m, "thing-1", NONE_OF_THEM, NOT_YET_SEEN, candidates=(wrong,))
    assert SceneTruth(scene, tolerance_m=0.1).value_of(about) == NONE_OF_THEM
