"""The instruction [I] made into ordered sub-goals."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from mintpilot.core.geometry import Vec3
from mintpilot.core.observation import Attribute, RegionKind


class Action(StrEnum):
    """What is done at a stop."""

    GO = "go"
    """Reach it."""
    PICK = "pick"
    """Take something up there."""
    DELIVER = "deliver"
    """Hand over what is carried."""
    LOOK = "look"
    """Look into a room from its viewpoint."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Reference:
    """A phrase of the instruction that means a thing in the world."""

    phrase: str
    """The words themselves: ``the red box``."""
    label: str = ""
    """Semantic class that it must have; empty for any."""
    attributes: tuple[Attribute, ...] = ()
    """What it must have besides."""
    position_m: Vec3 | None = None
    """A fixed place instead of a thing: then nothing else counts."""
    object_id: str = ""
    """A known object of the map instead of a description."""
    every: bool = False
    """True when all things that match are meant (``every room on the left``), in whichever order is shortest."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SubGoal:
    """One step of the task."""

    action: Action
    reference: Reference
    dwell_s: float = 2.0
    """How long the drone stays there, seconds."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Avoidance:
    """A kind of region that the person wants the drone to stay out of, whatever its passability."""

    kind: RegionKind
    strict: bool = True
    """False for a wish (``skip the smoke if you can``): given up where the task cannot be done otherwise."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Task:
    """Sub-goals in the order in which they are to be reached."""

    instruction: str
    """The words of the person who gave it."""
    subgoals: tuple[SubGoal, ...]
    seeks_people: bool = False
    """True when everybody who is hurt must be found: closed rooms then open presence gaps."""
    avoid: tuple[Avoidance, ...] = ()
    """What is to be stayed out of. Regions of these kinds open no gap, so that no plan enters them."""
