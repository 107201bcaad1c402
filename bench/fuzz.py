"""Fuzzes what comes from outside: ``python -m bench.fuzz TARGET [--seconds 120] [--corpus DIR]``. Wants atheris.

Coverage guides it (libFuzzer). A traceback, a call of more than 5 s or more than 1 GB of memory ends it with the input
in ``runs/fuzz/TARGET``; what it found and was mended is a test in ``tests/security/test_findings.py``.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import atheris
from pydantic import ValidationError

READERS = [
    "mission_file",
    "language",
    "console.protocol",
    "mapping",
    "recording.event_log",
    "recording.codec",
    "frames",
]
with atheris.instrument_imports(include=[f"mintpilot.{room}" for room in READERS]):
    from mintpilot.assembly.talk import Talk
    from mintpilot.conformance.sample import sample_problem
    from mintpilot.console.protocol import COMMANDS, Hello
    from mintpilot.core.errors import MintPilotError
    from mintpilot.core.ports import SourceOptions
    from mintpilot.core.predicate import Literal, Saying, SayingKind
    from mintpilot.core.query import Query, Question
    from mintpilot.frames.bags import RosBag
    from mintpilot.language.answer_model import read_with_model
    from mintpilot.language.instruction_model import parse_with_model
    from mintpilot.mapping.movingai import load_movingai
    from mintpilot.mapping.occupancy import load_ros_map
    from mintpilot.mission_file.reader import find_problems
    from mintpilot.models.doubles import FunctionModel
    from mintpilot.recording.event_log import read_event_log

TIMEOUT_S, MEMORY_MB, LONGEST = 5, 1024, 20_000
WORK = Path(tempfile.mkdtemp(prefix="mintpilot-fuzz-", dir="/dev/shm" if Path("/dev/shm").is_dir() else None))
PICTURE = b"P5\n4 3\n255\n" + bytes(range(0, 240, 20))


def file_of(name: str, data: bytes) -> Path:
    """A file with these bytes."""
    path = WORK / name
    path.write_bytes(data)
    return path


def mission(data: bytes) -> None:
    """A mission file: any bytes have problems or none, with places."""
    for problem in find_problems(file_of("mission.yaml", data)):
        assert str(problem).isprintable()


def map_file(data: bytes) -> None:
    """A map: header and picture, or a grid of the path-finding benchmarks."""
    header, _, picture = data.partition(b"\0")
    file_of("map.pgm", picture or PICTURE)
    for load, name, content in ((load_ros_map, "map.yaml", header), (load_movingai, "map.map", data)):
        with suppress(MintPilotError):
            load(file_of(name, content))


def events(data: bytes) -> None:
    """A recorded run."""
    with suppress(MintPilotError):
        for _ in read_event_log(file_of("events.ndjson", data)):
            pass


def web(data: bytes) -> None:
    """What a web client sends."""
    text = data.decode("utf-8", "replace")
    for parse in (COMMANDS.validate_json, Hello.model_validate_json):
        with suppress(ValidationError):
            parse(text)


def model(data: bytes) -> None:
    """What a language model returns, for an answer and for an instruction; and the answer itself."""
    text = data.decode("utf-8", "replace")
    says = FunctionModel(lambda _: text)
    read_with_model(text[:200], QUESTION, says, guarded=())
    read_with_model("big fat affirmative", QUESTION, says, guarded=())
    for words in ("Fetch me something nice from over there.", text[:300]):
        with suppress(MintPilotError):
            parse_with_model(words, says)
    with suppress(MintPilotError):
        Talk().parse(text[:300])


def bag(data: bytes) -> None:
    """A ROS 2 bag in MCAP."""
    with suppress(MintPilotError):
        for _ in RosBag(str(file_of("bag.mcap", data)), SourceOptions()).frames():
            pass


GAP = sample_problem().gaps[0]
QUESTION = Question(
    query=Query(
        literals=(Literal(gap=GAP.id, values=frozenset({GAP.values[0]}), saying=Saying(kind=SayingKind.VALUE)),)
    ),
    text="Is it?", yes_means="it flies", no_means="it stays", gaps=(GAP,), id="q1",
)  # fmt: skip
TARGETS: dict[str, tuple[Callable[[bytes], None], tuple[str, ...]]] = {
    "mission": (mission, ("examples/*.yaml", "examples/my-building/mission.yaml")),
    "map": (map_file, ("examples/my-building/building.yaml",)),
    "events": (events, ()),
    "web": (web, ()),
    "model": (model, ()),
    "bag": (bag, ()),
}


def main() -> None:
    """Fuzzes one target; never returns: libFuzzer ends the process."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("target", choices=sorted(TARGETS))
    arguments.add_argument("--seconds", type=int, default=120)
    arguments.add_argument("--corpus", type=Path, default=Path("runs/fuzz"))
    given = arguments.parse_args()
    function, seeds = TARGETS[given.target]
    folder = given.corpus / given.target
    (folder / "corpus").mkdir(parents=True, exist_ok=True)
    for pattern in seeds:
        for seed in Path().glob(pattern):
            (folder / "corpus" / f"seed-{seed.name}").write_bytes(seed.read_bytes())
    words = [
        f"-max_total_time={given.seconds}", f"-timeout={TIMEOUT_S}", f"-rss_limit_mb={MEMORY_MB}",
        f"-max_len={LONGEST}", f"-artifact_prefix={folder}/", str(folder / "corpus"),
    ]  # fmt: skip
    os.environ.setdefault("PYTHONWARNINGS", "ignore")
    atheris.Setup([sys.argv[0], *words], function)
    atheris.Fuzz()


if __name__ == "__main__":
    main()
