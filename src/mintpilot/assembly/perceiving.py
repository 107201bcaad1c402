"""From names to what makes objects of pictures: the perception, and who names what it finds."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from mintpilot.assembly.registry import load
from mintpilot.core.errors import InputError
from mintpilot.core.ports import Namer, Perception
from mintpilot.perception.calibration import CalibratedNamer, read_calibration
from mintpilot.perception.recorded_vision import RecordedVision
from mintpilot.perception.segments import SegmentPerception
from mintpilot.perception.settings import PerceptionSettings
from mintpilot.perception.vision_namer import VisionNamer

VISION: Final = "vision"
"""The namer that is a vision-language model."""
URL_VARIABLES: Final = ("MINTPILOT_VLM_URL", "MINTPILOT_LLM_URL")
MODEL_VARIABLES: Final = ("MINTPILOT_VLM_MODEL", "MINTPILOT_LLM_MODEL")
RECORDED_VARIABLE: Final = "MINTPILOT_VLM_RECORDED"
"""A file of answers: those in it are not asked for again."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Seeing:
    """Which perception, by registered names."""

    perception: str
    namers: tuple[str, ...] = ()
    """Who names segments; empty: the perception's own way."""
    wanted: tuple[str, ...] = ()
    """Nouns that the instruction is about."""
    floor_m: float = 0.0
    """Height of the floor in the world frame, metres."""
    calibration: Path | None = None
    """File of confidences measured on somebody's own pictures; what it does not tell of stays as it is said."""


def make_perception(seeing: Seeing, environment: Mapping[str, str] = os.environ) -> Perception:
    """The perception with its namers.

    Args:
        seeing: which.
        environment: holds the address and the name of a vision-language model.

    Raises:
        UnknownNameError: nobody registered the perception, or a namer.
        InputError: that perception takes no namers, the calibration cannot be read, or the model has no address.
        MissingPartError: a namer needs a part that is not installed.
    """
    make = load("perception", seeing.perception)
    settings = PerceptionSettings(floor_m=seeing.floor_m)
    if not seeing.namers and seeing.calibration is not None and issubclass(make, SegmentPerception):
        seeing = replace(seeing, namers=("geometry",))
    if seeing.namers or seeing.calibration is not None:
        if not issubclass(make, SegmentPerception):
            raise InputError(
                f"perception '{seeing.perception}' names things its own way; namers and a calibration go with "
                "'segments': use that, or leave them out"
            )
        namers = tuple(calibrated_namer(name, seeing, environment) for name in dict.fromkeys(seeing.namers))
        return make(settings, namers=namers)
    try:
        made: Perception = make(settings)
    except TypeError:  # a plug-in that is made without settings
        made = make()
    return made


def remarks_of(perception: Perception) -> Sequence[str]:
    """What went wrong with its namers since it was last asked, in sentences."""
    return perception.take_remarks() if isinstance(perception, SegmentPerception) else ()


def calibrated_namer(name: str, seeing: Seeing, environment: Mapping[str, str] = os.environ) -> Namer:
    """A namer with confidences as whoever flies measured them; without a measurement as it says them."""
    namer = plain_namer(name, seeing.wanted, environment)
    if seeing.calibration is not None:
        given = read_calibration(seeing.calibration)
        if name in given.namers:
            return CalibratedNamer(namer, given.namers[name], only_lowers=given.only_lowers)
    return namer


def plain_namer(name: str, wanted: Sequence[str] = (), environment: Mapping[str, str] = os.environ) -> Namer:
    """A namer by its registered name, with the confidences that it says."""
    if name != VISION:
        made: Namer = load("namer", name)()
        return made
    return vision_namer(wanted, environment)


def vision_namer(wanted: Sequence[str] = (), environment: Mapping[str, str] = os.environ) -> VisionNamer:
    """A vision-language model as a namer: behind the address in the environment, or from a file of its answers.

    Args:
        wanted: nouns that are looked for.
        environment: holds the address and the name of the model.

    Raises:
        InputError: there is no usable address, or no model is named.
        MissingPartError: the client is not installed.
    """
    recorded = environment.get(RECORDED_VARIABLE, "")
    url = next((environment[v] for v in URL_VARIABLES if environment.get(v)), "")
    model = next((environment[v] for v in MODEL_VARIABLES if environment.get(v)), "")
    if recorded and not url:
        return VisionNamer(RecordedVision(Path(recorded)), wanted=wanted)
    from mintpilot.models.endpoint import EndpointModel

    endpoint = EndpointModel(url, model, environment=environment)
    return VisionNamer(RecordedVision(Path(recorded), endpoint) if recorded else endpoint, wanted=wanted)
