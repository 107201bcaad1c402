"""What is run: the resolved configuration of one experiment, and the single trials that it consists of."""

from __future__ import annotations

import hashlib
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from mintpilot.benchmark.methods import Method
from mintpilot.core.think_time import ThinkTime

CONFIG_VERSION = 1
"""Of the configuration file; raised with every change that old readers would misread."""


class Part(BaseModel):
    """Base of all parts: never changed in place, and nothing unknown in it."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class Condition(Part):
    """What the person and the drone's knowledge are like."""

    answer_error: float = Field(default=0.0, ge=0, lt=0.5)
    """Probability that an answer is the opposite of the truth."""
    believed_error: float | None = Field(default=None, ge=0, lt=0.5)
    """What the drone takes it for; None: what it is."""
    unsure_rate: float = Field(default=0.0, ge=0, le=1)
    """Probability of "I don't know"."""
    believed_passable: float | None = Field(default=None, ge=0, le=1)
    """Prior that the drone has of clouds; None: the probability from which the truth is drawn."""
    believed_occupied: float | None = Field(default=None, ge=0, le=1)
    """Prior that the drone has of closed rooms; None: the probability from which the truth is drawn."""
    misplaced_m: float = Field(default=0.0, ge=0)
    """Standard deviation of the error in x and y of where the drone believes clouds and things to be, metres."""


class Cell(Part):
    """Worlds of one kind under one condition, and the methods that fly in each of them."""

    name: str = ""
    """As it stands in tables; unique in the experiment."""
    scenario: str
    """Name of the generator."""
    parameters: dict[str, float] = {}
    """The generator's own; those not named keep their defaults."""
    condition: Condition = Condition()
    methods: tuple[Method, ...]


class Prices(Part):
    """The one axis of cost: seconds of flight, and what counts as how many of them."""

    question_s: float = Field(default=10.0, ge=0)
    """Disturbing a person once."""
    failure_s: float = Field(default=600.0, ge=0)
    """A mission that failed."""


class Experiment(Part):
    """Everything that decides the records of one folder."""

    config_version: int = CONFIG_VERSION
    name: str
    """``table1``, ``boxes`` or ``gaps``."""
    cells: tuple[Cell, ...]
    trials: int = Field(ge=1)
    """Worlds for each cell."""
    seed: int = Field(ge=0)
    """Of the first world; the others follow."""
    vehicle: Literal["kinematic", "mujoco"]
    prices: Prices = Prices()
    tell_prices: bool = False
    """Whether the methods know the prices; else they run with their own defaults, as in a mission."""
    think_s: float = Field(default=0.0, ge=0)
    """How long the scripted person thinks about a question, at least, seconds of mission time."""
    think_most_s: float | None = Field(default=None, ge=0)
    """The time is drawn evenly up to this one; None: it is always the same."""
    llm: str = "template"
    """Language model that may propose questions; ``template``: none."""
    time_limit_s: float = Field(default=120.0, gt=0)
    """A trial that computes longer is recorded as failed."""
    share_plans: bool = True
    """Whether methods in the same world share plans already made: the same results sooner, but no fair timing."""
    share_survey: bool = False
    """Whether the first method's survey flight serves all methods in the same world (`SharedSurvey`)."""
    versions: dict[str, str] = {}
    """Of everything that decides results."""

    @property
    def think(self) -> ThinkTime:
        """How long the scripted person thinks about a question."""
        return ThinkTime(self.think_s, self.think_s if self.think_most_s is None else self.think_most_s)

    def key_data(self) -> str:
        """What must agree for records to stand in one folder: all but the number of trials and the time limit."""
        return self.model_dump_json(exclude={"trials", "time_limit_s"})

    def digest(self) -> str:
        """Short stable name of `key_data`."""
        return hashlib.blake2b(self.key_data().encode(), digest_size=4).hexdigest()


class WorldTask(Part):
    """One world and the methods that have not flown in it yet: what a worker gets."""

    cell: int
    """Index into the experiment's cells."""
    seed: int
    methods: tuple[str, ...]
    survey_world: bool = True
    """Whether the world's own record is still missing."""


def tasks_of(experiment: Experiment, finished: frozenset[tuple[str, int, str]]) -> list[WorldTask]:
    """All that is left to do, world by world over all cells, so that an interrupted run is spread evenly.

    Args:
        experiment: what is to be done.
        finished: (cell, seed, method) of the trials that have a record, with the method ``""`` for the world itself.
    """
    tasks = []
    for seed in range(experiment.seed, experiment.seed + experiment.trials):
        for index, cell in enumerate(experiment.cells):
            left = tuple(m.name for m in cell.methods if (cell.name, seed, m.name) not in finished)
            world = (cell.name, seed, "") not in finished
            if left or world:
                tasks.append(WorldTask(cell=index, seed=seed, methods=left, survey_world=world))
    return tasks
