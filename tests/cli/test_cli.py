"""The program as a user meets it: exit codes, one JSON object on standard output, words instead of tracebacks."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from mintpilot.cli.demos import DEMOS, demo_mission, demo_path
from mintpilot.cli.exits import EPILOGUE, ExitCode, verdict_on
from mintpilot.cli.main import main
from mintpilot.core import errors

ROOT = Path(__file__).parents[2]
BUILDING = ROOT / "examples" / "my-building" / "mission.yaml"
PROGRAM = [sys.executable, "-c", "import sys; from mintpilot.cli.main import main; sys.exit(main())"]


@pytest.fixture
def bad_mission(tmp_path):
    path = tmp_path / "bad.yaml"
    path.write_text(
        "mintpilot: 1\nname: a\ninstruction: go\nworld: {scenario: fire-warehous}\nvehicle: {radius_m: -1}\n"
    )
    return path


def test_version_and_help(capsys):
    assert main(["--version"]) == 0
    assert capsys.readouterr().out.strip().count(".") == 2
    assert main([]) == 0
    assert "doctor" in capsys.readouterr().out


@pytest.mark.parametrize("command", ["demo", "run", "plan", "check", "doctor"])
def test_help_of_each_command_has_examples_and_exit_codes(capsys, command):
    assert main([command, "--help"]) == 0
    shown = capsys.readouterr().out
    assert f"  mintpilot {command}" in shown
    assert "Exit codes" in shown
    assert "--json" in shown


def test_every_exit_code_is_documented():
    assert all(f"{int(code)} " in EPILOGUE for code in ExitCode)


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (errors.InputError("x"), 2),
        (errors.MissionError("x"), 2),
        (errors.MapError("x"), 2),
        (errors.UnknownNameError("strategy", "x", ["y"]), 2),
        (errors.InfeasibleError("x"), 2),
        (errors.LimitError("x"), 2),
        (errors.MissingPartError("x"), 3),
        (errors.DeviceError("x"), 4),
        (errors.RecordError("x"), 4),
        (MemoryError(), 2),
        (ZeroDivisionError(), 70),
        (KeyboardInterrupt(), 130),
    ],
)
def test_exit_code_of_each_error(error, code):
    assert verdict_on(error)[0] == code


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["rnu"], "Did you mean"),
        (["run"], "MISSION"),
        (["run", "m.yaml", "--vehicel", "kinematic"], "--vehicel"),
        (["run", "m.yaml", "--vehicle", "boat"], "boat"),
        (["run", "m.yaml", "--seed", "x"], "--seed"),
        (["demo", "medicin"], "medicin"),
        (["check"], "--schema"),
        (["demo", "--headless", "--llm", "endpiont"], "Did you mean 'endpoint'"),
        (["plan", str(BUILDING), "--lang", "deutsch"], "unknown language 'deutsch'"),
        (["run", str(BUILDING), "--llm", "endpoint"], "MINTPILOT_LLM_URL"),
    ],
)
def test_wrong_words_end_with_2_and_say_which(capsys, monkeypatch, words, said):
    monkeypatch.delenv("MINTPILOT_LLM_URL", raising=False)
    assert main(words) == ExitCode.WRONG_INPUT
    shown = capsys.readouterr()
    assert shown.out == ""
    assert said in shown.err
    assert main([*words, "--json"]) == ExitCode.WRONG_INPUT
    assert said in json.loads(capsys.readouterr().out)["error"]["message"]


@pytest.mark.long
def test_the_command_line_goes_before_the_mission_file(capsys, tmp_path):
    file = json.loads(demo_mission("fire-warehouse").model_dump_json(exclude_unset=True))
    path = tmp_path / "mission.json"
    for lang, options, words in (("de", [], "Ist "), ("de", ["--lang", "fr"], "Y a"), ("fr", ["--lang", "en"], "Is ")):
        path.write_text(json.dumps({**file, "language": {"lang": lang}}))
        assert main(["plan", str(path), "--json", *options]) == 0
        assert json.loads(capsys.readouterr().out)["query"]["text"].startswith(words)


def test_check_lists_every_mistake(capsys, bad_mission):
    assert main(["check", str(bad_mission)]) == ExitCode.WRONG_INPUT
    shown = capsys.readouterr()
    assert f"{bad_mission}:4 (world.scenario)" in shown.out
    assert f"{bad_mission}:5 (vehicle.radius_m): -1 must be above 0" in shown.out
    assert "2 mistakes" in shown.err
    assert main(["check", str(bad_mission), "--json"]) == ExitCode.WRONG_INPUT
    report = json.loads(capsys.readouterr().out)
    assert [(p["line"], p["path"]) for p in report["problems"]] == [(4, "world.scenario"), (5, "vehicle.radius_m")]


@pytest.mark.parametrize("path", sorted(ROOT.glob("examples/**/mission.yaml")) + sorted(ROOT.glob("examples/*.yaml")))
def test_examples_have_no_mistakes(capsys, path):
    assert main(["check", str(path)]) == 0
    assert "no mistakes" in capsys.readouterr().out


def test_check_schema_prints_the_published_schema(capsys):
    assert main(["check", "--schema"]) == 0
    assert capsys.readouterr().out == (ROOT / "docs" / "mission.schema.json").read_text(encoding="utf-8")


@pytest.mark.parametrize("command", ["run", "plan"])
def test_bad_missions_end_with_2_and_no_traceback(capsys, bad_mission, command):
    for path in (bad_mission, bad_mission.parent / "none.yaml", bad_mission.parent):
        assert main([command, str(path), "--json"]) == ExitCode.WRONG_INPUT
        shown = capsys.readouterr()
        error = json.loads(shown.out)["error"]
        assert error["exit_code"] == 2
        assert str(path) in error["message"]
        assert "Traceback" not in shown.err


def test_debug_shows_the_traceback(capsys, bad_mission):
    main(["plan", str(bad_mission), "--debug"])
    assert "Traceback" in capsys.readouterr().err


def test_an_unknown_strategy_is_named_with_the_nearest(capsys):
    assert main(["plan", str(BUILDING), "--strategy", "mnt"]) == ExitCode.WRONG_INPUT
    assert "Did you mean 'mint'" in capsys.readouterr().err


def test_plan_prints_one_object(capsys):
    assert main(["plan", str(BUILDING), "--json"]) == 0
    shown = capsys.readouterr()
    report = json.loads(shown.out)
    assert {"gaps", "tree", "plan_classes", "query", "expected_questions", "stop_reason"} <= set(report)
    assert {gap["kind"] for gap in report["gaps"]} == {"obstacle", "target", "presence"}
    assert sum(plan["probability"] for plan in report["plan_classes"]) == pytest.approx(1)
    assert report["query"]["text"].endswith("?")
    assert 0 < report["expected_questions"] <= 10
    # Nothing was asked yet: a gap may matter, but no answer has settled anything.
    assert all(gap["why"].startswith("Matters: the best plan takes") for gap in report["gaps"] if gap["critical"])
    assert not any("sked" in gap["why"] for gap in report["gaps"])


def test_plan_for_people(capsys):
    assert main(["plan", str(BUILDING)]) == 0
    shown = capsys.readouterr().out
    for words in (
        "knowledge gaps: 3",
        "the grey smoke in the middle gate",
        "It would ask:",
        "Questions to be expected",
    ):
        assert words in shown


@pytest.mark.long
def test_run_writes_a_folder_and_prints_one_object(tmp_path, capsys):
    out = tmp_path / "run"
    words = ["run", str(BUILDING), "--operator", "scripted", "--vehicle", "kinematic", "--out", str(out)]
    code = main([*words, "--seed", "3", "--json"])
    shown = capsys.readouterr()
    record = json.loads(shown.out)
    assert code == (0 if record["outcome"] == "success" else 1)
    assert record["seed"] == 3
    assert record["run_dir"] == str(out)
    keys = {"outcome", "questions", "gaps", "flight", "timings_s", "seed", "run_dir", "schema_version"}
    keys |= {"achieved", "left", "looks", "waiting", "reason", "people", "rules"}
    assert set(record) == keys
    assert {"text", "gap", "gain_bits", "reply", "latency_s"} == set(record["questions"][0])
    assert (out / "record.json").exists()
    assert "Mission 'my-building'" in shown.err
    assert "\x1b[" not in shown.err  # no terminal: plain lines
    assert main(words) == ExitCode.FAILED_DEVICE
    assert "holds a run already" in capsys.readouterr().err


def test_an_unwritable_run_folder_ends_with_4(tmp_path, capsys):
    (tmp_path / "file").write_text("")
    code = main(
        ["run", str(BUILDING), "--vehicle", "kinematic", "--operator", "scripted", "--out", str(tmp_path / "file")]
    )
    assert code == ExitCode.FAILED_DEVICE
    assert "run folder" in capsys.readouterr().err


@pytest.mark.long
def test_demo_prints_a_report(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code = main(["demo", "--headless", "--vehicle", "kinematic", "--seed", "1"])
    shown = capsys.readouterr()
    (folder,) = (tmp_path / "runs").iterdir()
    outcome = json.loads((folder / "record.json").read_text())["outcome"]
    assert code == (0 if outcome == "success" else 1)
    for words in ("What it saw", "What it did not know", "What it asked", "What it flew"):
        assert words in shown.out
    assert "Mission 'fire-warehouse'" in shown.err


@pytest.mark.long
def test_an_answer_may_come_through_a_pipe(tmp_path):
    command = [*PROGRAM, "run", str(BUILDING), "--operator", "terminal", "--vehicle", "kinematic", "--json"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, input="yes\n" * 10)
    record = json.loads(done.stdout)
    assert record["questions"]
    assert all(question["reply"] == "yes" for question in record["questions"])
    assert "The drone asks" in done.stderr


@pytest.mark.long
@pytest.mark.parametrize("number", [signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.slow)])
def test_ctrl_c_leaves_a_readable_run_folder(tmp_path, number):
    out = tmp_path / "run"
    command = [*PROGRAM, "run", str(BUILDING), "--operator", "terminal", "--vehicle", "kinematic", "--out", str(out)]
    with subprocess.Popen(
        command, cwd=tmp_path, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        while "Your answer" not in (line := process.stderr.readline()) and "Orders" not in line:
            assert line, "it ended before it asked"
        time.sleep(0.2)
        process.send_signal(number)
        _, said = process.communicate(timeout=60)
    assert process.returncode == ExitCode.INTERRUPTED
    assert "Traceback" not in said
    assert str(out) in said.replace("\n", "")
    record = json.loads((out / "record.json").read_text())
    assert record["outcome"] == "aborted"


@pytest.mark.long
def test_a_reader_that_goes_away_is_no_error(tmp_path):
    with subprocess.Popen(
        [*PROGRAM, "check", "--schema"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        process.stdout.close()
        said = process.stderr.read()
    assert process.returncode in (0, ExitCode.SUCCESS)
    assert said == ""


@pytest.mark.long
def test_doctor_looks_at_everything(capsys):
    assert main(["doctor", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    names = {finding["name"] for finding in report["findings"]}
    assert {"Python", "numpy", "MuJoCo (sim)", "off-screen drawing", "run folders", "compiled search"} <= names


@pytest.mark.long
def test_doctor_works_without_the_simulator_and_without_a_writable_folder(tmp_path):
    hide = "import sys; sys.modules['mujoco'] = None\n"
    code = hide + "from mintpilot.cli.doctor import look\nfrom pathlib import Path\n"
    code += f"print([(f.name, f.ok, f.advice) for f in look(Path({str(tmp_path / 'none')!r}))])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env={**os.environ})
    assert done.returncode == 0, done.stderr
    findings = {name: (ok, advice) for name, ok, advice in eval(done.stdout)}
    assert not findings["MuJoCo (sim)"][0]
    assert "mintpilot[sim]" in findings["MuJoCo (sim)"][1]
    assert not findings["run folders"][0]


@pytest.mark.parametrize("name", DEMOS)
def test_demos_are_the_examples(name):
    assert demo_mission(name).instruction
    example = ROOT / "examples" / f"{name}.yaml"
    assert example.read_text(encoding="utf-8") == demo_path(name).read_text(encoding="utf-8")


@pytest.mark.long
def test_the_generated_pages_are_current():
    sys.path.insert(0, str(ROOT / "scripts"))
    try:
        import make_docs
    finally:
        sys.path.pop(0)
    docs = ROOT / "docs"
    assert (docs / "cli.md").read_text(encoding="utf-8") == make_docs.cli_page(), "run: make docs"
    assert (docs / "mission-file.md").read_text(encoding="utf-8") == make_docs.mission_page(), "run: make docs"


@pytest.mark.long
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
def test_a_full_log_does_not_end_a_flight(tmp_path):
    words = ["run", str(BUILDING), "--operator", "scripted", "--vehicle", "kinematic", "--json"]
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [*PROGRAM, *words, "--out", str(tmp_path / "run")], stdout=subprocess.PIPE, stderr=full, text=True
        )
    assert done.returncode == 0
    assert json.loads(done.stdout)["outcome"] == "success"


@pytest.mark.long
def test_readers_that_go_away_do_not_end_a_flight(tmp_path):
    words = ["run", str(BUILDING), "--operator", "scripted", "--vehicle", "kinematic", "--out", str(tmp_path / "run")]
    with subprocess.Popen([*PROGRAM, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        process.stdout.close()
        process.stderr.close()
    assert process.returncode == 0
    assert json.loads((tmp_path / "run" / "record.json").read_text())["outcome"] == "success"
