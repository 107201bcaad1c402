"""``mintpilot bench perception``."""

from __future__ import annotations

import json as json_module
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from mintpilot.cli.bench_flags import Flag, Json
from mintpilot.cli.exits import ExitCode, guarded
from mintpilot.core.errors import InputError, RecordError, UnknownNameError

if TYPE_CHECKING:
    from mintpilot.benchmark.perception import PerceptionRow
    from mintpilot.simulation.furnished.style import Style


def perception(
    *,
    style: Annotated[list[str], Parameter(name="--style", negative="")] = [],  # noqa: B006
    scenes: int = 25,
    seed: int = 0,
    data: Path | None = None,
    use: Annotated[str, Parameter(name="--perception")] = "segments",
    namer: Annotated[list[str], Parameter(name="--namer", negative="")] = [],  # noqa: B006
    calibrate: Path | None = None,
    json: Json = False,
    debug: Flag = False,
) -> ExitCode:
    """What is found, named and asked about in furnished rooms with people, doors and things; the truth is known.

    Args:
        style: Of the rooms; may be given several times. Default: those that no rule was chosen on.
        scenes: Rooms of each style.
        seed: Of the first room; the others follow.
        data: A folder of pictures labelled pixel by pixel, instead of rooms (docs/benchmark.md says how).
        use: Perception that is measured.
        namer: Who names what is found; may be given several times. Default: the perception's own way.
        calibrate: Measure how often the names are right, and write this file of true confidences. It goes into a
            mission file (perception: calibration) or to mintpilot see. What was found in drawn rooms only takes
            certainty away. Default: nothing is calibrated.
        json: Print one JSON object, and nothing else, on standard output.
        debug: Show the traceback of an error.
    """

    def work() -> ExitCode:
        from mintpilot.assembly.perceiving import Seeing, make_perception
        from mintpilot.benchmark.perception import measure_perception, rows_of

        if scenes < 1 or seed < 0:
            raise InputError(f"--scenes {scenes} --seed {seed}: at least 1 room, and no negative seed")
        picked = _styles(style)
        if calibrate is not None:
            return _calibrate(calibrate, namer or ["geometry"], picked, scenes, seed, data)
        if data is not None:
            rows = list(_rows_of_frames(data))
        else:
            made = make_perception(Seeing(perception=use, namers=tuple(namer)))
            rows = list(rows_of(measure_perception(picked, scenes, seed, made)))
        if json:
            names = [] if data is not None else [one.name for one in picked]
            print(json_module.dumps({"schema_version": 1, "styles": names, "rows": [asdict(row) for row in rows]}))
            return ExitCode.SUCCESS
        for row in rows:
            interval = "" if row.low is None or row.high is None else f" [{row.low:.3f}, {row.high:.3f}]"
            wanted = f"; wanted: {row.wanted}" if row.wanted else ""
            print(f"{row.value:8.3f}{interval}  of {row.n}  {row.name}{wanted}")
        return ExitCode.SUCCESS

    return guarded(work, as_json=json, debug=debug)


def _styles(names: Sequence[str]) -> list[Style]:
    from mintpilot.simulation.furnished.styles import HELD_BACK, STYLES

    for name in names:
        if name not in STYLES:
            raise UnknownNameError("style", name, STYLES)
    return [STYLES[name] for name in dict.fromkeys(names or HELD_BACK)]


def _rows_of_frames(folder: Path) -> Iterator[PerceptionRow]:
    from mintpilot.benchmark.labelled_frames import count_frames, labelled_frames
    from mintpilot.benchmark.perception import PerceptionRow, share_row

    counts = count_frames(labelled_frames(folder))
    yield share_row("things found (overlap over 0.5)", counts.found, counts.things, "0.85")
    for name, number in (("split", counts.split), ("merged", counts.merged)):
        yield share_row(f"things {name}", number, counts.things, "")
    each = counts.false / counts.frames if counts.frames else 0.0
    yield PerceptionRow(name="false things in a picture", value=each, n=counts.frames, wanted="0.3")
    for name, value in (
        ("overlap, mean", counts.mean_iou),
        ("overlap recall", counts.overlap_recall),
        ("overlap precision", counts.overlap_precision),
    ):
        yield PerceptionRow(name=name, value=value, n=counts.things)


def _calibrate(
    out: Path, namers: Sequence[str], styles: Sequence[Style], scenes: int, seed: int, data: Path | None
) -> ExitCode:
    from mintpilot.assembly.perceiving import plain_namer
    from mintpilot.benchmark.calibrating import calibrated, pairs_in_frames, pairs_in_rooms
    from mintpilot.benchmark.labelled_frames import labelled_frames

    by = f"--data {data.name}" if data is not None else f"--style {' --style '.join(s.name for s in styles)}"
    made_by = f"mintpilot bench perception --calibrate {out.name} {by} --scenes {scenes} --seed {seed}"
    pairs = {
        name: pairs_in_frames(plain_namer(name), labelled_frames(data))
        if data is not None
        else pairs_in_rooms(plain_namer(name), styles, scenes, seed)
        for name in namers
    }
    made = calibrated(pairs, made_by, drawn=data is None)
    try:
        out.write_text(made.model_dump_json(indent=1) + "\n", "utf-8")
    except OSError as error:
        raise RecordError(f"'{out}' cannot be written ({error.strerror}); choose another --calibrate") from None
    for name in namers:
        scales = made.namers.get(name, {})
        print(f"{name}: {', '.join(f'{label} of {s.examples}' for label, s in scales.items()) or 'too few examples'}")
    return ExitCode.SUCCESS
