"""Look or ask: what was asked, looked at and left alone, and why. `python -m bench.looks [--worlds 10] [--dry]`."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from statistics import mean

import numpy as np

from bench.sections import Section, Table, keep
from mintpilot.assembly.api import run_mission
from mintpilot.mission_file.schema import MissionFile
from mintpilot.recording.record import MissionRecord

WAYS = {
    "looks and questions": {},
    "questions only": {"looks": []},
    "looks only": {"asking": {"max_questions": 0}},
    "neither": {"looks": [], "asking": {"max_questions": 0}},
}
EXAMPLES = 6
DEEP_M = 30.0
"""Depth of the hall, metres: ways round are long enough to be worth a look or a question."""
REPLY_S = 10.0


def mission(seed: int) -> dict[str, object]:
    """A hall with three walls across it, a gate in each full of smoke, a way round each, and a look at each cloud."""
    rng = np.random.default_rng([seed, 29])
    solids, smokes, looks = [], [], []
    for number in range(1, 4):
        x, gate = 6.0 * number, float(rng.uniform(3, DEEP_M - 3))
        far = gate < DEEP_M / 2  # the way round is at the other end
        spans = ((0.0 if far else 2.5, gate - 1), (gate + 1, DEEP_M - 2.5 if far else DEEP_M))
        solids += [
            {"id": f"w{number}{i}", "kind": "wall", "extent_m": {"lo_m": [x, a, 0], "hi_m": [x + 0.2, b, 2.6]}}
            for i, (a, b) in enumerate(spans)
            if b - a > 0.2
        ]
        box = {"lo_m": [x - 0.8, gate - 1.2, 0], "hi_m": [x + 1.0, gate + 1.2, 2.6]}
        smokes.append({"id": f"smoke-{number}", "extent_m": box, "toxic": bool(rng.random() < 0.5)})
        away, sees = float(rng.uniform(1.6, 2.6)), float(rng.uniform(0.3, 1.0))
        looks.append(
            {"at": f"smoke-{number}", "viewpoint_m": [x - away, gate, 1.2], "dwell_s": float(rng.uniform(1, 8)),
             "sees": round(sees, 2)}
        )  # fmt: skip
    return {
        "mintpilot": 1,
        "name": f"looks-{seed}",
        "instruction": "Go to the injured person.",
        "world": {
            "scene": {
                "volume": {"lo_m": [0, 0, 0], "hi_m": [24, DEEP_M, 2.6]},
                "start_m": [2, DEEP_M / 2, 1.2],
                "solids": solids,
                "smokes": smokes,
                "persons": [{"id": "p1", "position_m": [22, DEEP_M / 2, 0]}],
            }
        },
        "looks": looks,
        "operator": {"latency_s": REPLY_S},
        "asking": {"reply_s": REPLY_S},
    }


def flown(seed: int, way: str) -> MissionRecord:
    """One mission flown in one way."""
    data, changes = mission(seed), WAYS[way]
    asking = {**dict(data["asking"]), **dict(changes.get("asking", {}))}  # type: ignore[call-overload]
    return run_mission(
        MissionFile.model_validate({**data, **changes, "asking": asking}), vehicle="kinematic", seed=seed
    )


def _row(way: str, records: list[MissionRecord]) -> tuple[str, ...]:
    looks = [sum(one.text.startswith("look at") for one in r.achieved) for r in records]
    return (
        way,
        str(len(records)),
        str(sum(r.outcome.value == "success" for r in records)),
        f"{mean(len(r.questions) for r in records):.2f}",
        f"{mean(looks):.2f}",
        f"{_operator_s(records):.1f} s",
        f"{_reached_s(records):.1f} s",
    )


def _operator_s(records: list[MissionRecord]) -> float:
    return mean(r.waiting.delay_s for r in records)


def _reached_s(records: list[MissionRecord]) -> float:
    """Mean time of the last thing that was done, seconds."""
    return float(np.nanmean([max((one.at_s for one in r.achieved), default=float("nan")) for r in records]))


def _examples(records: list[MissionRecord]) -> Iterator[tuple[str, ...]]:
    for seed, record in enumerate(records):
        for gap in record.gaps:
            yield (str(seed), gap.description, gap.why)


def main() -> None:
    """Flies, and keeps the section."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--worlds", type=int, default=10)
    parser.add_argument("--dry", action="store_true", help="print the section, keep nothing")
    args = parser.parse_args()
    found = {way: [flown(seed, way) for seed in range(args.worlds)] for way in WAYS}
    both, asked = found["looks and questions"], found["questions only"]
    later = (_operator_s(both) - _operator_s(asked), _reached_s(both) - _reached_s(asked))
    header = (
        "allowed",
        "worlds",
        "person reached",
        "questions, mean",
        "looks, mean",
        "operator, mean",
        "reached after",
    )
    made = Section(
        name="41-looks",
        title="Look or ask",
        command=f"python -m bench.looks --worlds {args.worlds}",
        how=f"Halls {DEEP_M:g} m deep with three walls across, a gate full of smoke (toxic with probability 0.5) and a "
        "way round in each, kinematic. Each cloud can be looked at from 1.6 to 2.6 m before it, for 1 to 8 s, seeing "
        f"with probability 0.3 to 1, all drawn. The person takes {REPLY_S:g} s for an answer; the drone knows that.",
        tables=[
            Table(caption="", header=header, rows=[_row(way, records) for way, records in found.items()]),
            Table(
                caption=f"What was asked, looked at and left alone: the first {EXAMPLES} worlds, both allowed",
                header=("world", "what", "why"),
                rows=list(_examples(found["looks and questions"][:EXAMPLES])),
            ),
        ],
        notes=[
            f"Beside questions alone, looks change the person's time by {later[0]:+.1f} s and the time until somebody "
            f"is reached by {later[1]:+.1f} s on average. A part of the person's time is flown meanwhile; the rate of "
            "a question does not count that."
        ],
    )
    print(made.markdown()) if args.dry else keep(made)


if __name__ == "__main__":
    main()
