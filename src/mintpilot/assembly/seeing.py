"""See without flying: pictures of any source into a map, its objects, what is not known, and a folder to fly on."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from mintpilot.assembly.mapping_frames import REACH_M, mapped
from mintpilot.assembly.perceiving import Seeing, make_perception, remarks_of
from mintpilot.assembly.seen_report import GapSeen, SeenReport, gap_seen, report_of
from mintpilot.core.errors import InputError, MapError, RecordError
from mintpilot.core.gap import NONE_OF_THEM, NOT_YET_SEEN
from mintpilot.core.geometry import Vec3
from mintpilot.core.observation import Frame
from mintpilot.core.ports import FrameSource
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.frames.aligned import AlignedFrames
from mintpilot.language.instruction import parse_instruction
from mintpilot.mission_file.seen_map import save_map
from mintpilot.uncertainty.doubts import doubtful_people, referents, said_of
from mintpilot.uncertainty.findings import find_gaps
from mintpilot.uncertainty.matching import asked_name
from mintpilot.uncertainty.things import things_of


def see(
    source: FrameSource,
    *,
    name: str,
    perception: str = "segments",
    namers: Sequence[str] = (),
    calibration: Path | None = None,
    instruction: str | None = None,
    out: Path | None = None,
) -> SeenReport:
    """Makes map, objects, gaps and a report of the pictures of a source.

    Args:
        source: of the pictures.
        name: what the report calls it.
        perception: registered name of what makes objects of pictures.
        namers: registered names of who names what is found; empty: the perception's own way.
        calibration: file of measured confidences of the namers; None: as they say them.
        instruction: gaps are then those that bear on it, too.
        out: folder that becomes a world for missions (``world: {seen: DIR}``); None: nothing is written.

    Raises:
        InputError: the pictures cannot be used, or the instruction is not understood; the message says why.
        RecordError: ``out`` cannot be written.
    """
    aligned = AlignedFrames(source)
    frames = list(aligned)
    if not frames:
        raise MapError(f"'{name}' has no usable frame: {' '.join(aligned.warnings)}")
    setting = aligned.setting
    wanted = wanted_nouns(instruction)
    seeing = make_perception(
        Seeing(
            perception=perception,
            namers=tuple(namers),
            wanted=wanted,
            floor_m=setting.floor_m,
            calibration=calibration,
        )
    )
    map_ = mapped(frames, seeing, setting.floor_m)
    x, y, z = (float(v) for v in frames[0].world_from_camera[:3, 3])
    warnings = [*aligned.warnings, *remarks_of(seeing), *_seen_nothing(map_, frames)]
    gaps, problems = gaps_of(map_, instruction, start_m=(x, y, z))
    report = report_of(
        name=name,
        frames=len(frames),
        instruction=instruction,
        world_from_source=setting.world_from_source.tolist(),
        floor_m=setting.floor_m,
        map=map_,
        gaps=gaps,
        warnings=[*warnings, *problems],
    )
    if out is not None:
        save_map(map_, out, start_m=(x, y, z))
        try:
            (out / "report.json").write_text(report.model_dump_json(indent=1) + "\n", "utf-8")
        except OSError as error:
            raise RecordError(f"'{out}' cannot be written ({error.strerror}); choose another --out") from None
    return report


def wanted_nouns(instruction: str | None) -> tuple[str, ...]:
    """The nouns of the things that an instruction is about, as far as it is understood."""
    if instruction is None:
        return ()
    try:
        task = parse_instruction(instruction, home_m=(0.0, 0.0, 0.0))
    except InputError:
        return ()
    return tuple(dict.fromkeys(g.reference.label for g in task.subgoals if g.reference.label))


def gaps_of(map_: SemanticMap, instruction: str | None, *, start_m: Vec3) -> tuple[list[GapSeen], list[str]]:
    """What may be a person, what is not known that bears on an instruction, and what it speaks of in vain."""
    gaps = [gap_seen(gap, question=f"Is that a person: {gap.description}?") for gap in doubtful_people(map_.objects)]
    if instruction is None:
        return gaps, []
    task = parse_instruction(instruction, home_m=start_m)
    findings = find_gaps(map_, task, start_m=start_m)
    known = {gap.id for gap in gaps}
    for gap in findings.gaps:
        if gap.id not in known and not gap.id.startswith("target:"):
            gaps.append(gap_seen(gap))
    for number, subgoal in enumerate(task.subgoals, start=1):
        meant = subgoal.reference
        if meant.position_m is not None or meant.object_id or not meant.label:
            continue
        wanted = {a.value for a in meant.attributes if a.name in ("", "colour", "size")}
        fitting = [o for o in map_.objects if not _contradicts(o.values("colour") | o.values("size"), wanted)]
        found = referents(asked_name(meant, things_of(map_)), fitting)
        named = {o.id: said_of(o) for o in map_.objects}
        values = {i: round(p, 4) for i, p in found.things} | {
            NONE_OF_THEM: round(found.none_of_them, 4),
            NOT_YET_SEEN: round(found.not_yet_seen, 4),
        }
        gaps.append(
            GapSeen(
                id=f"target:{number}:{meant.phrase.lower().removeprefix('the ').replace(' ', '-')}",
                kind="target",
                subject=meant.phrase,
                description=f"which thing '{meant.phrase}' means",
                values=values,
                candidates={i: named[i] for i, _ in found.things},
            )
        )
    return gaps, [str(problem) for problem in findings.problems]


_COLOURS = frozenset({"red", "orange", "yellow", "green", "blue", "purple", "white", "grey", "black", "brown"})
_SIZES = frozenset({"small", "medium", "large"})


def _contradicts(known: frozenset[str], wanted: set[str]) -> bool:
    """Whether a thing is known to have another colour or size than is wanted."""
    return any(wanted & group and known & group and not (wanted & known & group) for group in (_COLOURS, _SIZES))


def _seen_nothing(map_: SemanticMap, frames: list[Frame]) -> list[str]:
    if map_.objects or map_.regions or map_.rooms:
        return []
    depth = np.concatenate([f.depth_m[::8, ::8].ravel() for f in frames])
    depth = depth[np.nan_to_num(depth) > 0]
    if not depth.size:
        return ["Nothing was seen: no frame has depth."]
    if float(np.median(depth)) > REACH_M:
        return [f"Nothing was seen: half of the depth is beyond {REACH_M:g} m; is the depth unit right?"]
    return ["Nothing was seen that stands on its own: only floor, walls and surfaces are in view, or it is too small."]
