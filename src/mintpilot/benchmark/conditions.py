"""Worlds as the benchmark flies them: drawn by a generator, believed under a condition."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from mintpilot.assembly.worlds import World, build_world
from mintpilot.benchmark.experiment import Cell, Condition, Experiment
from mintpilot.benchmark.methods import Method
from mintpilot.core.geometry import Box, Floats, GridFrame, Ints
from mintpilot.core.mission import AskingSettings, CriticalityRule, QueryKinds, WhileWaiting
from mintpilot.core.semantic_map import Cell as Voxel
from mintpilot.core.semantic_map import MapObject, SemanticMap
from mintpilot.mission_file.schema import MissionFile
from mintpilot.mission_file.schema_world import ScenarioWorld
from mintpilot.simulation.scenarios import make_scenario


def true_world(cell: Cell, seed: int) -> World:
    """The world with that seed, its map that of a perfect survey.

    Raises:
        UnknownNameError: the scenario or a parameter of it is not known.
        MissionError: a parameter's value breaks a rule.
    """
    world = ScenarioWorld.model_validate({"scenario": cell.scenario, "parameters": cell.parameters})
    file = MissionFile(mintpilot=1, name=cell.scenario, instruction=_instruction(cell.scenario), world=world)
    return build_world(file, base=Path.cwd(), seed=seed)


def believed_world(world: World, condition: Condition) -> World:
    """The same world, with what the drone believes of it as the condition says. The truth stays."""
    believed = world.map
    mission = world.mission
    if condition.believed_passable is not None:
        prior = condition.believed_passable
        mission = replace(mission, prior_passable=prior)
        believed = replace(believed, regions=tuple(replace(r, prior_passable=prior) for r in believed.regions))
    if condition.believed_occupied is not None:
        prior = condition.believed_occupied
        mission = replace(mission, prior_occupied=prior)
        believed = replace(believed, rooms=tuple(replace(r, prior_occupied=prior) for r in believed.rooms))
    if condition.misplaced_m > 0:
        believed = misplaced(believed, condition.misplaced_m, np.random.default_rng([world.seed, 11]))
    return replace(world, mission=mission, map=believed)


def asking_for(
    settings: AskingSettings, experiment: Experiment, condition: Condition, method: Method
) -> AskingSettings:
    """The settings that one method decides with: what the drone believes of answers, and the prices if told.

    How long the person takes on average is told, too.
    """
    error = condition.answer_error if condition.believed_error is None else condition.believed_error
    told = replace(settings, answer_error=error, reply_s=experiment.think.mean_s)
    if experiment.tell_prices:
        prices = experiment.prices
        told = replace(told, question_price_s=prices.question_s, failure_price_s=prices.failure_s)
    return replace(told, **_typed(method.asking)) if method.asking else told


def misplaced(believed: SemanticMap, sigma_m: float, rng: np.random.Generator) -> SemanticMap:
    """The map with clouds and things moved sideways, each by its own normal error; walls and doors stay.

    A cloud moves by whole voxels, and never into matter.
    """
    regions = []
    for region in believed.regions:
        steps = np.rint(rng.normal(0.0, sigma_m, 2) / believed.frame.resolution_m).astype(np.int64)
        cells = _moved(region.cells, believed.frame, steps)
        cells = cells[believed.cells.ravel()[cells] != Voxel.OCCUPIED]
        regions.append(replace(region, cells=cells) if cells.size else region)
    objects = tuple(_moved_object(thing, rng.normal(0.0, sigma_m, 2)) for thing in believed.objects)
    return replace(believed, regions=tuple(regions), objects=objects)


def _moved(cells: Ints, frame: GridFrame, steps: Ints) -> Ints:
    """Flat indices moved by (x, y) voxels; what leaves the lattice is lost."""
    z, y, x = np.unravel_index(cells, frame.shape)
    x, y = x + steps[0], y + steps[1]
    inside = (x >= 0) & (x < frame.shape[2]) & (y >= 0) & (y < frame.shape[1])
    flat: Ints = np.ravel_multi_index((z[inside], y[inside], x[inside]), frame.shape).astype(np.int64)
    flat.sort()
    return flat


def _moved_object(thing: MapObject, off_m: Floats) -> MapObject:
    dx, dy = float(off_m[0]), float(off_m[1])
    (x0, y0, z0), (x1, y1, z1) = thing.box_m.lo_m, thing.box_m.hi_m
    return replace(thing, box_m=Box(lo_m=(x0 + dx, y0 + dy, z0), hi_m=(x1 + dx, y1 + dy, z1)))


def _typed(values: dict[str, str | float]) -> dict[str, Any]:
    kinds = {"rule": CriticalityRule, "while_waiting": WhileWaiting, "kinds": QueryKinds}
    return {k: kinds[k](str(v)) if k in kinds else v for k, v in values.items()}


@lru_cache
def _instruction(scenario: str) -> str:
    return make_scenario(scenario, 0).mission.instruction
