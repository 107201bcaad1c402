"""One table of names: which class a name in a mission file, an option or a strategy list means.

Our own entries are ``module:attribute`` strings, loaded when they are asked for. Anybody's package adds its own through
the entry-point group ``mintpilot.<port>``, e.g. ``[project.entry-points."mintpilot.strategy"]``.
"""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

from mintpilot.core.errors import InputError, UnknownNameError

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

BUILT_IN: Final = MappingProxyType(
    {
        "strategy": MappingProxyType(
            {
                "mint": "mintpilot.strategies.mint:MintStrategy",
                "exhaustive": "mintpilot.strategies.exhaustive:ExhaustiveStrategy",
                "entropy-threshold": "mintpilot.strategies.entropy_threshold:EntropyThresholdStrategy",
                "gap-by-gap": "mintpilot.strategies.gap_by_gap:GapByGapStrategy",
                "knowno": "mintpilot.strategies.knowno:KnowNoStrategy",
                "random": "mintpilot.strategies.random_query:RandomQueryStrategy",
                "passive-conservative": "mintpilot.strategies.passive:ConservativeStrategy",
                "passive-risky": "mintpilot.strategies.passive:RiskyStrategy",
                "passive-mixture": "mintpilot.strategies.passive:PassiveMixtureStrategy",
            }
        ),
        "objective": MappingProxyType(
            {
                "information-gain": "mintpilot.elicitation.objectives.information_gain:InformationGain",
                "ec2": "mintpilot.elicitation.objectives.ec2:Ec2",
                "value-of-information": "mintpilot.elicitation.objectives.value_of_information:ValueOfInformation",
                "optimal": "mintpilot.elicitation.objectives.optimal:Optimal",
                "random": "mintpilot.elicitation.objectives.random:Random",
            }
        ),
        "metric": MappingProxyType(
            {
                "frechet": "mintpilot.reasoning.metrics:FrechetMetric",
                "hausdorff": "mintpilot.reasoning.metrics:HausdorffMetric",
                "path-variance": "mintpilot.reasoning.metrics:PathVarianceMetric",
                "q-value": "mintpilot.policies.metric:QValueMetric",
            }
        ),
        "planner": MappingProxyType(
            {
                "grid": "mintpilot.planning.task_planner:GridPlanner",
                "policy": "mintpilot.policies.planner:PolicyPlanner",
            }
        ),
        "policy": MappingProxyType({"exact": "mintpilot.policies.exact:ExactPolicy"}),
        "perception": MappingProxyType(
            {
                "geometric": "mintpilot.perception.geometric:GeometricPerception",
                "segments": "mintpilot.perception.segments:SegmentPerception",
            }
        ),
        "namer": MappingProxyType(
            {
                "geometry": "mintpilot.perception.geometry_namer:GeometryNamer",
                "ocr": "mintpilot.perception.ocr_namer:OcrNamer",
                "vision": "mintpilot.assembly.perceiving:vision_namer",
            }
        ),
        "frames": MappingProxyType(
            {
                "tum": "mintpilot.frames.folders:TumFolder",
                "folder": "mintpilot.frames.folders:TrajectoryFolder",
                "picture": "mintpilot.frames.single:SinglePicture",
                "bag": "mintpilot.frames.bags:RosBag",
                "realsense": "mintpilot.frames.realsense:RealSense",
                "sim": "mintpilot.simulation.picture_server:simulated",
            }
        ),
        "language": MappingProxyType(
            {
                "template": "mintpilot.models.doubles:NoModel",
                "endpoint": "mintpilot.models.endpoint:EndpointModel",
                "embedded": "mintpilot.models.embedded:EmbeddedModel",
            }
        ),
        "speech": MappingProxyType(
            {
                "double": "mintpilot.voice.doubles:SpeechDouble",
                "espeak": "mintpilot.voice.gpl:EspeakSpeech",
                "hibari": "mintpilot.voice.hibari:HibariSpeech",
                "piper": "mintpilot.voice.gpl:PiperSpeech",
            }
        ),
        "recogniser": MappingProxyType(
            {
                "moonshine": "mintpilot.voice.moonshine:MoonshineRecogniser",
                "whisper": "mintpilot.voice.whisper:WhisperRecogniser",
            }
        ),
        "vehicle": MappingProxyType({"mavlink": "mintpilot.vehicle.mavlink_vehicle:MavlinkVehicle"}),
        "activity": MappingProxyType({"silero": "mintpilot.voice.silero:SileroActivity"}),
    }
)
"""Port → name → where it is. Every entry is called without arguments to make a part; one of ``frames`` with the place
of the pictures, and what is known of them (`mintpilot.core.ports.SourceOptions`); one of ``vehicle``, whose name is the
scheme of an address, as `mintpilot.assembly.real_vehicle.make_vehicle` does."""


FORMER: Final = MappingProxyType({"strategy": MappingProxyType({"pure-llm": "passive-mixture"})})
"""Port → former name → present one. Former names are told, not taken: records that hold them stay readable."""
_CALLED: Final = MappingProxyType({"language": "language model"})
"""Ports whose name says too little in a message."""


def names(port: str) -> tuple[str, ...]:
    """All names of that port, ours and those of installed plug-ins, sorted."""
    return tuple(sorted({*BUILT_IN[port], *(e.name for e in _plug_ins(port))}))


def load(port: str, name: str) -> type:
    """The class (or factory) with that name.

    Raises:
        UnknownNameError: nobody registered it; the nearest known name is given.
        InputError: a plug-in is registered but cannot be imported.
    """
    if name in BUILT_IN[port]:
        module, _, attribute = BUILT_IN[port][name].partition(":")
        found: type = getattr(import_module(module), attribute)
        return found
    for entry in _plug_ins(port):
        if entry.name == name:
            return _load_plug_in(port, entry)
    raise unknown(port, name, names(port))


def check_name(port: str, name: str) -> None:
    """Whether a part of that name can be had. Our own are known to be there; a plug-in is loaded to find out.

    Raises:
        UnknownNameError: nobody registered it; the nearest known name is given.
        InputError: a plug-in is registered but cannot be imported.
    """
    if name not in BUILT_IN[port]:
        load(port, name)


def present_name(strategy: str) -> str:
    """What a strategy that is named in an older record is called now."""
    return FORMER["strategy"].get(strategy, strategy)


def unknown(port: str, name: str, known: Iterable[str]) -> UnknownNameError:
    """The error for a name of that port that is not among the known ones; a former name is told as such."""
    return UnknownNameError(
        _CALLED.get(port, port), name, known, now=FORMER[port].get(name, "") if port in FORMER else ""
    )


def _plug_ins(port: str) -> tuple[EntryPoint, ...]:
    from importlib.metadata import entry_points

    return tuple(entry_points(group=f"mintpilot.{port}"))


def _load_plug_in(port: str, entry: EntryPoint) -> type:
    try:
        found: type = entry.load()
    except Exception as error:  # a stranger's package may fail in any way; the user must learn whose it is
        raise InputError(
            f"{port} '{entry.name}' of the installed package '{entry.dist.name if entry.dist else '?'}' cannot be "
            f"loaded from '{entry.value}': {error!r}. Mend or uninstall that package."
        ) from error
    return found
