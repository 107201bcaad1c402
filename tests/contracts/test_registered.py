"""Everything that is registered keeps the contract of its port, and the checkers find those that do not."""

from __future__ import annotations

import io
from functools import partial

import numpy as np
import pytest
from rich.console import Console
from tests.assembly.llm_server import LlmServer

from assembly.vision_server import VisionServer, naming
from mintpilot.assembly.perceiving import vision_namer
from mintpilot.assembly.registry import load, names
from mintpilot.assembly.talk import Talk
from mintpilot.conformance import (
    check_frame_source,
    check_language_model,
    check_metric,
    check_namer,
    check_objective,
    check_operator,
    check_perception,
    check_planner,
    check_policy,
    check_recorder,
    check_strategy,
    check_vehicle,
)
from mintpilot.conformance.sample import sample_world
from mintpilot.core.errors import MissingPartError
from mintpilot.core.ports import Completion, SourceOptions
from mintpilot.interaction.scripted import ScriptedOperator
from mintpilot.interaction.terminal import TerminalOperator
from mintpilot.models.doubles import FunctionModel, ReplayModel
from mintpilot.recording.in_memory import HistoryRecorder
from mintpilot.recording.recorders import MemoryRecorder, NullRecorder, TeeRecorder
from mintpilot.recording.run_folder import RunFolder
from mintpilot.simulation.kinematic import KinematicSimulator
from mintpilot.simulation.mujoco_vehicle import MujocoSimulator


@pytest.mark.parametrize("name", names("planner"))
def test_planners(name):
    check_planner(load("planner", name))


@pytest.mark.parametrize("name", names("policy"))
def test_policies(name):
    check_policy(load("policy", name))


@pytest.mark.parametrize("name", names("metric"))
def test_metrics(name):
    check_metric(load("metric", name))


@pytest.mark.parametrize("name", names("objective"))
def test_objectives(name):
    check_objective(load("objective", name))


@pytest.mark.long
@pytest.mark.parametrize("name", names("strategy"))
def test_strategies(name):
    check_strategy(load("strategy", name))


@pytest.mark.parametrize("name", names("perception"))
def test_perceptions(name):
    check_perception(load("perception", name))


@pytest.mark.parametrize("name", names("namer"))
def test_namers(name):
    if name == "ocr":
        pytest.importorskip("rapidocr_onnxruntime", reason="needs rapidocr-onnxruntime")
    if name != "vision":
        check_namer(load("namer", name))
        return
    server = VisionServer(naming(lambda *_: "box"))
    environment = {"MINTPILOT_VLM_URL": server.url, "MINTPILOT_VLM_MODEL": "eyes"}
    check_namer(lambda: vision_namer(environment=environment))
    server.shut_down()


@pytest.mark.long
def test_recordings_are_frame_sources(tmp_path):
    from frames.recordings import poses, save_folder, save_tum, views

    tum, folder = save_tum(tmp_path / "tum", views(), poses()), save_folder(tmp_path / "log", views(), poses())
    color, depth = folder / "color" / "00000.png", folder / "depth" / "00000.png"
    check_frame_source(lambda: load("frames", "tum")(str(tum), SourceOptions()))
    check_frame_source(lambda: load("frames", "folder")(str(folder), SourceOptions()))
    check_frame_source(lambda: load("frames", "picture")("", SourceOptions(color=color, depth=depth)))


def test_the_simulator_is_a_frame_source():
    pytest.importorskip("mujoco", reason="needs MuJoCo")
    check_frame_source(lambda: load("frames", "sim")("medicine-boxes", SourceOptions(longest=3)))


@pytest.mark.parametrize("make", [NullRecorder, MemoryRecorder, HistoryRecorder, lambda: TeeRecorder(MemoryRecorder())])
def test_recorders(make):
    check_recorder(make)


def test_the_run_folder_is_a_recorder(tmp_path):
    folders = (tmp_path / str(number) for number in range(100))
    check_recorder(lambda: RunFolder(next(folders)))


@pytest.mark.parametrize("talk", ["", "yes\n" * 30, "perhaps\n" * 30])
def test_the_terminal_is_an_operator(tmp_path, talk):
    (tmp_path / "talk").write_text(talk)
    with (tmp_path / "talk").open() as typed:
        words = {"understand": Talk().understand, "order_of": Talk().order_of}
        make = partial(TerminalOperator, Console(file=io.StringIO()), typed, **words)
        check_operator(make, patience_s=0.2)


@pytest.mark.parametrize("silence_rate", [0.0, 1.0])
def test_the_script_is_an_operator(silence_rate):
    truth = sample_world().truth
    check_operator(lambda: ScriptedOperator(truth, rng=np.random.default_rng(1), silence_rate=silence_rate))


def test_the_kinematic_drone_is_a_vehicle():
    world = sample_world()
    check_vehicle(lambda: KinematicSimulator(world.scene, world.rules, seed=0))


@pytest.mark.sim
def test_the_drone_of_four_rotors_is_a_vehicle():
    pytest.importorskip("mujoco")
    world = sample_world()
    check_vehicle(lambda: MujocoSimulator(world.scene, world.rules, seed=0))


def test_no_language_model_keeps_the_contract_of_one():
    check_language_model(load("language", "template"))


def test_a_function_and_a_recording_are_language_models():
    check_language_model(lambda: FunctionModel(lambda prompt: "yes"))
    check_language_model(lambda: ReplayModel([Completion(text="yes", model="replay", seconds=0.0)] * 3))


def test_a_server_is_a_language_model(monkeypatch):
    pytest.importorskip("pydantic_ai")
    server = LlmServer(lambda prompt: "yes")
    monkeypatch.setenv("MINTPILOT_LLM_URL", server.url)
    monkeypatch.setenv("MINTPILOT_LLM_MODEL", "tiny")
    check_language_model(load("language", "endpoint"))
    server.shut_down()
    check_language_model(load("language", "endpoint"))


@pytest.mark.slow
def test_the_embedded_model_is_one():
    try:
        made = load("language", "embedded")()
    except MissingPartError as error:
        pytest.skip(str(error))
    check_language_model(lambda: made)
