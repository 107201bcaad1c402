"""One maker for strategies: the seed reaches every draw, arguments come from the file and from the command line."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from mintpilot.assembly.api import run_mission
from mintpilot.assembly.components import Choices, deliberation_parts
from mintpilot.assembly.registry import BUILT_IN
from mintpilot.assembly.strategies import make_objective, make_strategy, parse_arguments, strategy_label
from mintpilot.assembly.worlds import build_world
from mintpilot.cli.main import main
from mintpilot.core.errors import InputError, UnknownNameError
from mintpilot.core.mission import Outcome
from mintpilot.core.tree import StopReason
from mintpilot.mission.rehearsal import begin
from mintpilot.mission_file.reader import read_mission
from mintpilot.strategies.knowno import KnowNoStrategy

BUILDING = Path(__file__).parents[2] / "examples" / "my-building" / "mission.yaml"


@pytest.mark.parametrize("name", BUILT_IN["strategy"])
def test_every_strategy_is_made_with_any_seed(name: str) -> None:
    assert make_strategy(name, seed=3) is not make_strategy(name, seed=3)


def flown(name: str, seed: int) -> str:
    world = build_world(read_mission(BUILDING), base=BUILDING.parent, seed=seed)
    parts = deliberation_parts(world, Choices(strategy=name))
    decision = begin(parts, world.map).deliberated().decision
    plan = getattr(decision, "plan", None)
    return plan.signature if plan else ""


def test_the_seed_of_the_run_reaches_the_coin() -> None:
    drawn = [flown("passive-mixture", seed) for seed in range(8)]
    assert len(set(drawn)) > 1
    assert drawn == [flown("passive-mixture", seed) for seed in range(8)]


def test_the_seed_of_the_run_reaches_the_random_objective() -> None:
    one, other, again = (make_objective("random", seed=seed) for seed in (1, 2, 1))
    draws = [objective._rng.random() for objective in (one, other, again)]  # type: ignore[attr-defined]
    assert draws[0] == draws[2] != draws[1]


def test_arguments_reach_the_strategy() -> None:
    made = make_strategy("knowno", seed=0, arguments={"quantile": 0.8})
    assert isinstance(made.strategy.strategy.strategy.strategy, KnowNoStrategy)  # type: ignore[attr-defined]
    assert made.strategy.strategy.strategy.strategy._quantile == 0.8  # type: ignore[attr-defined]
    assert strategy_label("knowno", {"quantile": 0.8}) == "knowno quantile=0.8"
    assert strategy_label("mint") == "mint"


@pytest.mark.parametrize(
    ("name", "arguments", "said"),
    [
        ("knowno", {"quantil": 0.8}, "Did you mean 'quantile'"),
        ("knowno", {"quantile": "high"}, "must be a number"),
        ("knowno", {"quantile": True}, "must be a number"),
        ("knowno", {"quantile": 1.5}, "from 0 to 1"),
        ("mint", {"objective": "ec2"}, "takes no argument 'objective'"),
        ("exhaustive", {"x": 1}, r"It takes: \(none\)"),
        ("random", {"seed": 1}, "--seed"),
    ],
)
def test_arguments_that_do_not_fit_are_named(name: str, arguments: dict, said: str) -> None:
    with pytest.raises(InputError, match=said):
        make_strategy(name, seed=0, arguments=arguments)


def test_a_former_name_is_told_as_such() -> None:
    with pytest.raises(UnknownNameError, match=r"unknown strategy 'pure-llm'. It is called 'passive-mixture' now"):
        make_strategy("pure-llm", seed=0)


def test_arguments_of_the_command_line_are_read_as_what_they_look_like() -> None:
    assert parse_arguments(["a=1", "b=0.5", "c=true", "d=x=y"]) == {"a": 1, "b": 0.5, "c": True, "d": "x=y"}
    for wrong in (["a"], ["=1"], ["a b=1"], ["a=1", "a=2"]):
        with pytest.raises(InputError, match="--strategy-arg"):
            parse_arguments(wrong)


def mission(tmp_path: Path, arguments: str = "{}", more: str = "") -> Path:
    given = f"asking: {{strategy_arguments: {arguments}, {more}"
    text, changed = re.subn(r"^asking: \{", given, BUILDING.read_text(), flags=re.MULTILINE)
    assert changed == 1
    for name in BUILDING.parent.iterdir():
        if name != BUILDING:
            (tmp_path / name.name).write_bytes(name.read_bytes())
    path = tmp_path / "mission.yaml"
    path.write_text(text)
    return path


def test_the_file_gives_arguments_and_the_command_line_goes_before_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = mission(tmp_path, "{knowno: {quantile: 0.7}}")
    said = []
    for words in (["--strategy", "knowno"], ["--strategy", "knowno", "--strategy-arg", "quantile=0.8"], []):
        assert main(["plan", str(path), "--json", *words]) == 0
        said.append(json.loads(capsys.readouterr().out)["strategy"])
    assert said == ["knowno quantile=0.7", "knowno quantile=0.8", "mint"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [("{knowno: {quantil: 1}}", "quantile"), ("{knwno: {}}", "knowno"), ("{knowno: {quantile: [1]}}", "quantile")],
)
def test_check_finds_wrong_arguments(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], arguments: str, said: str
) -> None:
    assert main(["check", str(mission(tmp_path, arguments))]) == 2
    assert said in capsys.readouterr().out


def test_a_mission_whose_objective_meets_a_bound_is_flown_cautiously_and_says_so(tmp_path: Path) -> None:
    path = mission(tmp_path, more="objective: optimal, answer_error: 0.1, ")
    record = run_mission(path, vehicle="kinematic")
    assert record.outcome is not Outcome.ABORTED
    assert record.questions == ()
    assert record.certificate is not None
    assert record.certificate.reason is StopReason.LIMIT
    assert any(n.kind == "bound" and "use 'information-gain'" in n.text for n in record.notices)
