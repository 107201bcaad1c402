"""A policy is learned by a command, and missions are planned and flown by it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import yaml

from mintpilot.cli.main import main

EXAMPLE = Path(__file__).parents[2] / "examples" / "my-policy" / "mission.yaml"
LEARN = ["policy", "learn", str(EXAMPLE), "--transitions", "600000"]
FLY = ["--vehicle", "kinematic", "--operator", "scripted", "--json"]


@pytest.fixture(scope="module")
def learned(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("policy") / "mine.npz"
    assert main([*LEARN, "--out", str(path)]) == 0
    return path


def planned(capsys, *words: str) -> dict:
    assert main(["plan", str(EXAMPLE), "--json", *words]) == 0
    return json.loads(capsys.readouterr().out)


def test_the_same_seed_gives_the_same_file(learned, tmp_path) -> None:
    for seed in ("0", "1"):
        assert main([*LEARN, "--seed", seed, "--out", str(tmp_path / f"{seed}.npz")]) == 0
    assert (tmp_path / "0.npz").read_bytes() == learned.read_bytes()
    assert (tmp_path / "1.npz").read_bytes() != learned.read_bytes()


def test_a_mission_is_planned_by_it_as_without(learned, capsys) -> None:
    plain, by_policy = planned(capsys), planned(capsys, "--planner", f"policy:{learned}")
    assert [g["critical"] for g in by_policy["gaps"]] == [g["critical"] for g in plain["gaps"]] == [True, True]
    costs = [[c["cost_s"] for c in report["plan_classes"]] for report in (plain, by_policy)]
    assert costs[1] == pytest.approx(costs[0], abs=0.01)
    assert by_policy["expected_questions"] == plain["expected_questions"]


@pytest.mark.long
def test_a_mission_is_flown_and_replayed_by_it(learned, tmp_path, capsys) -> None:
    text = yaml.safe_load(EXAMPLE.read_text())
    text["asking"]["impact_metric"] = f"q-value:{learned}"
    text["world"]["map"] = str(EXAMPLE.parent / "hall.map")
    (tmp_path / "mission.yaml").write_text(yaml.safe_dump(text))
    run = [
        "run",
        str(tmp_path / "mission.yaml"),
        *FLY,
        "--planner",
        f"policy:{learned}",
        "--out",
        str(tmp_path / "run"),
    ]
    assert main(run) == 0
    assert json.loads(capsys.readouterr().out)["outcome"] == "success"
    assert main(["replay", "--verify", str(tmp_path / "run")]) == 0


@pytest.mark.long
@pytest.mark.parametrize(
    ("planner", "said"),
    [
        ("policy:none.npz", "there is no such file"),
        ("policy:exakt", "Did you mean 'exact'"),
        ("gird", "Did you mean 'grid'"),
    ],
)
def test_a_planner_that_cannot_be_had(planner, said, tmp_path, monkeypatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    for command in (["plan", str(EXAMPLE)], ["run", str(EXAMPLE), *FLY]):
        assert main([*command, "--planner", planner]) == 2
        shown = capsys.readouterr()
        assert said in shown.out + shown.err
        assert not (tmp_path / "runs").exists()


def test_a_metric_that_cannot_be_had_is_a_mistake_of_the_file(tmp_path, capsys) -> None:
    text = yaml.safe_load(EXAMPLE.read_text())
    text["world"]["map"] = str(EXAMPLE.parent / "hall.map")
    text["asking"]["impact_metric"] = "q-value:none.npz"
    (tmp_path / "mission.yaml").write_text(yaml.safe_dump(text))
    assert main(["check", str(tmp_path / "mission.yaml")]) == 2
    assert "none.npz: there is no such file" in capsys.readouterr().out


@pytest.mark.long
def test_a_policy_of_another_mission_flies_nothing(learned, tmp_path, capsys) -> None:
    other = EXAMPLE.parents[1] / "my-building" / "mission.yaml"
    assert main(["run", str(other), *FLY, "--planner", f"policy:{learned}", "--out", str(tmp_path / "run")]) == 1
    said = json.loads(capsys.readouterr().out)
    assert said["outcome"] == "no-safe-plan"
    assert "made for a grid of (1, 14, 20) cells" in json.dumps(said)


@pytest.mark.parametrize("words", [["--transitions", "0"], ["--out", "mine.pt"], ["--out", "no/such/place.npz"]])
def test_what_cannot_be_learned(words, tmp_path, monkeypatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    where = [] if "--out" in words else ["--out", "mine.npz"]
    assert main(["policy", "learn", str(EXAMPLE), *where, "--transitions", "2048", *words]) == 2
    assert "Traceback" not in capsys.readouterr().err
