"""Perception on pictures that nobody here rendered: ``python -m bench.perception [--json]``.

Labelled Kinect frames of things on a table, half of them used to choose parameters and half to report; an RGB-D
recording and a desk, against a list of obvious things. Reads ``../shared/data``; says so where it is absent.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections import Counter
from dataclasses import asdict
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "perception"))
from real_things import DESK, REPORTED, RGBD, TABLETOP, TUNED, place, room_places

from mintpilot.assembly.seeing import see
from mintpilot.assembly.sources import open_source
from mintpilot.benchmark.labelled_frames import count_frames, labelled_frames
from mintpilot.core.ports import SourceOptions
from mintpilot.frames.aligned import AlignedFrames

NEAR_M = 0.15
HAZARDS = ("person", "fire", "smoke", "door")


def tabletop(numbers: tuple[int, ...]) -> dict[str, float | int]:
    """Things found, split, merged and false, and overlap, on labelled frames."""
    counts = count_frames(labelled_frames(TABLETOP, frozenset(f"learn{n}" for n in numbers)))
    shown = {key: round(value, 3) if isinstance(value, float) else value for key, value in asdict(counts).items()}
    return {**shown, "false_per_frame": round(counts.false / counts.frames, 3)}


def living_room() -> dict[str, object]:
    """The recording with poses."""
    source = open_source(str(RGBD), SourceOptions())
    report = see(source, name="rgbd", instruction=None)
    matrix = np.array(report.world_from_source)
    places = {name: matrix[:3, :3] @ p + matrix[:3, 3] for name, p in room_places().items()}
    return {**_found(report, places), "back_projection_m": round(_back_projection(), 4)}


def desk() -> dict[str, object]:
    """A single view of a desk."""
    folder = RGBD / "tum_desk"
    options = SourceOptions(color=folder / "2.png", depth=folder / "2_depth.png", depth_unit_m=0.0002)
    (frame,) = AlignedFrames(open_source("", options))
    report = see(open_source("", options), name="desk", instruction="pick up the can")
    places = {t.name: place(t, folder / "2_depth.png", 5000.0, frame.world_from_camera) for t in DESK}
    asked = next((g for g in report.gaps if g.kind == "target"), None)
    cans = [o.id for o in report.objects for n in ("near can", "far can") if _near(o.position_m, places[n])]
    return {
        **_found(report, places),
        "can_is_asked_about": asked is not None and sum(v in cans for v in list(asked.values)[:2]),
    }


def _found(report, places) -> dict[str, object]:  # type: ignore[no-untyped-def]
    missing = [n for n, p in places.items() if not any(_near(o.position_m, p) for o in report.objects)]
    kinds = Counter(o.label for o in report.objects) + Counter(r.kind for r in report.regions)
    return {
        "listed": len(places),
        "found": len(places) - len(missing),
        "missing": missing,
        "false_hazards": {k: kinds[k] for k in HAZARDS} | {"rooms": len(report.rooms)},
        "doubtful_people": sum(g.kind == "presence" for g in report.gaps),
    }


def _near(a, b) -> bool:  # type: ignore[no-untyped-def]
    return math.dist(a, b) < NEAR_M


def _back_projection() -> float:
    """Median distance in depth between the last frame's surface and the first one's, seen from the first, metres."""
    frames = list(AlignedFrames(open_source(str(RGBD), SourceOptions())))
    first, last = frames[0], frames[-1]
    v, u = np.mgrid[4:476:6, 4:636:6]
    z = last.depth_m[v, u].astype(float)
    rays = np.stack([(u - 319.5) / 525.0, (v - 239.5) / 525.0, np.ones(u.shape)], -1)
    points = (rays * z[..., None])[z > 0] @ last.world_from_camera[:3, :3].T + last.world_from_camera[:3, 3]
    back = (points - first.world_from_camera[:3, 3]) @ first.world_from_camera[:3, :3]
    x = np.round(back[:, 0] / back[:, 2] * 525.0 + 319.5).astype(int)
    y = np.round(back[:, 1] / back[:, 2] * 525.0 + 239.5).astype(int)
    inside = (x >= 0) & (x < 640) & (y >= 0) & (y < 480)
    seen = first.depth_m[y[inside], x[inside]]
    return float(np.median(np.abs(seen - back[inside, 2])[seen > 0]))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true")
    flags = parser.parse_args()
    if not TABLETOP.is_dir():
        print("../shared/data is not there: nothing to measure")
        return 0
    rows = {
        "tabletop, frames used to choose parameters": tabletop(TUNED),
        "tabletop, the other frames": tabletop(REPORTED),
        "living room": living_room(),
        "desk": desk(),
    }
    if flags.json:
        print(json.dumps(rows))
    else:
        for name, row in rows.items():
            print(name)
            for key, value in row.items():
                print(f"  {key:22} {value}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
