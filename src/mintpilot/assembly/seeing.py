"""See without flying: pictures of any source into a map, its objects, what is not known, and a folder to fly on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from mintpilot.assembly.perceiving import Seeing, make_perception, remarks_of
from mintpilot.assembly.seen_report import GapSeen, SeenReport, gap_seen, report_of
from mintpilot.core.errors import InputError, MapError, RecordError
from mintpilot.core.gap import NONE_OF_THEM, NOT_YET_SEEN
from mintpilot.core.geometry import Floats, GridFrame, Vec3
from mintpilot.core.observation import Frame
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.ports import FrameSource, Perception
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.frames.aligned import AlignedFrames
from mintpilot.language.instruction import parse_instruction
from mintpilot.mapping.builder import MapBuilder
from mintpilot.mapping.settings import MappingSettings
from mintpilot.mission_file.seen_map import save_map
from mintpilot.uncertainty.doubts import doubtful_people, referents, said_of
from mintpilot.uncertainty.findings import find_gaps
from mintpilot.uncertainty.matching import asked_name
from mintpilot.uncertainty.things import things_of

REACH_M = 8.0
"""Depth beyond this places no surface."""
ROUND_M = 0.5
"""The lattice reaches so far around what was seen and where it was seen from."""
CELLS = 4_000_000
"""The lattice is made coarser until it has no more cells."""
FINEST_M = 0.05
START_M = 0.45
"""So much space around the camera is known free: the camera was there."""


def see(
    source: FrameSource,
    *,
    name: str,
    perception: str = "segments",
    namers: Sequence[str] = (),
    instruction: str | None = None,
    out: Path | None = None,
) -> SeenReport:
    """Makes map, objects, gaps and a report of the pictures of a source.

    Args:
        source: of the pictures.
        name: what the report calls it.
        perception: registered name of what makes objects of pictures.
        namers: registered names of who names what is found; empty: the perception's own way.
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
        Seeing(perception=perception, namers=tuple(namers), wanted=wanted, floor_m=setting.floor_m)
    )
    map_ = _mapped(frames, seeing, setting.floor_m)
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
    return gaps, list(findings.problems)


_COLOURS = frozenset({"red", "orange", "yellow", "green", "blue", "purple", "white", "grey", "black", "brown"})
_SIZES = frozenset({"small", "medium", "large"})


def _contradicts(known: frozenset[str], wanted: set[str]) -> bool:
    """Whether a thing is known to have another colour or size than is wanted."""
    return any(wanted & group and known & group and not (wanted & known & group) for group in (_COLOURS, _SIZES))


def _mapped(frames: list[Frame], perception: Perception, floor_m: float) -> SemanticMap:
    lattice = lattice_of(frames)
    settings = MappingSettings()
    few = len(frames) < 4
    builder = MapBuilder(
        lattice,
        limits=VehicleLimits(),
        volume=lattice.box,
        settings=replace(
            settings,
            max_range_m=REACH_M,
            sure_score=0.5 if few else settings.sure_score,
            viewpoint_height_m=settings.viewpoint_height_m + floor_m,
        ),
    )
    for index, frame in enumerate(frames):
        builder.integrate(frame, perception.detect(frame, index))
    builder.mark_flown(np.array([f.world_from_camera[:3, 3] for f in frames]), START_M)
    return builder.snapshot()


def lattice_of(frames: list[Frame]) -> GridFrame:
    """A lattice around all that is seen within reach, and around where it was seen from."""
    corners = [np.stack([f.world_from_camera[:3, 3] for f in frames])]
    for frame in frames:
        points = _sampled(frame)
        if len(points):
            corners.append(np.percentile(points, (0.5, 99.5), axis=0))
    places = np.concatenate(corners)
    lo, hi = places.min(axis=0) - ROUND_M, places.max(axis=0) + ROUND_M
    resolution = FINEST_M
    while np.prod(np.ceil((hi - lo) / resolution)) > CELLS:
        resolution *= 1.25
    shape = np.ceil((hi - lo) / resolution).astype(int)
    return GridFrame(
        origin_m=(float(lo[0]), float(lo[1]), float(lo[2])),
        resolution_m=float(resolution),
        shape=(int(shape[2]), int(shape[1]), int(shape[0])),
    )


def _sampled(frame: Frame) -> Floats:
    step, lens = max(1, frame.camera.width // 80), frame.camera
    v, u = np.mgrid[0 : lens.height : step, 0 : lens.width : step]
    z = np.nan_to_num(frame.depth_m[v, u]).astype(float)
    kept = (z > 0) & (z < REACH_M)
    u, v, z = u[kept] + 0.5, v[kept] + 0.5, z[kept]
    points = np.stack([(u - lens.cx) / lens.fx * z, (v - lens.cy) / lens.fy * z, z], axis=1)
    moved: Floats = points @ frame.world_from_camera[:3, :3].T + frame.world_from_camera[:3, 3]
    return moved


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
