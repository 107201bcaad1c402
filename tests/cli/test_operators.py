"""Who answers, as the command line says it."""

from __future__ import annotations

import io
from contextlib import ExitStack
from pathlib import Path
from typing import cast

import pytest
from rich.console import Console

from mintpilot.cli.fly import _operators, operator_names
from mintpilot.cli.main import main
from mintpilot.cli.progress import Narrator
from mintpilot.cli.web_page import PageOptions, ServedPage
from mintpilot.core.errors import InputError
from mintpilot.recording.question_notes import QuestionNotes


@pytest.mark.parametrize(
    ("given", "names"),
    [
        ([], ()),
        (["terminal"], ("terminal",)),
        (["console,terminal"], ("console", "terminal")),
        (["console", "terminal", "console"], ("console", "terminal")),
        (["voice, console"], ("voice", "console")),
    ],
)
def test_several_may_be_named_either_way(given: list[str], names: tuple[str, ...]) -> None:
    assert operator_names(given) == names


@pytest.mark.parametrize(
    ("given", "said"), [(["pilot"], "pilot"), (["console,"], "choose among"), (["scripted,terminal"], "alone")]
)
def test_wrong_ones_are_told(given: list[str], said: str) -> None:
    with pytest.raises(InputError, match=said):
        operator_names(given)


def test_the_command_refuses_them_before_anything_else(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "nowhere.yaml", "--operator", "scripted,console"]) == 2
    assert "alone" in capsys.readouterr().err
    assert main(["run", "nowhere.yaml", "--operator", "terminal", "--port", "8000"]) == 2
    assert "--operator console" in capsys.readouterr().err
    assert main(["run", "nowhere.yaml", "--operator", "terminal", "--volume", "0.5"]) == 2
    assert "--operator voice" in capsys.readouterr().err
    assert main(["run", "nowhere.yaml", "--operator", "voice", "--volume", "7"]) == 2
    assert "--volume 7" in capsys.readouterr().err


def chosen(choice: tuple[str, ...], *, page: bool) -> tuple[object, ...]:
    """Who answers where nobody sits at the terminal."""
    console = Console(file=io.StringIO(), force_terminal=False)
    with ExitStack() as stack, Narrator(console) as narrator:
        served = ServedPage(PageOptions(), console, stack) if page else None
        return cast(
            "tuple[object, ...]",
            _operators(choice, console, narrator, served, stack, notes=QuestionNotes(Path("nowhere")), real=False),
        )


def test_page_and_terminal_stand_side_by_side() -> None:
    assert len(chosen(("console", "terminal"), page=True)) == 3  # the page, its microphone, the terminal
    assert len(chosen(("console",), page=True)) == 2
    assert len(chosen(("terminal",), page=False)) == 1
    assert chosen((), page=False) == ("scripted",)
    assert chosen(("scripted",), page=False) == ("scripted",)


def test_a_real_vehicle_is_not_left_to_the_script() -> None:
    console = Console(file=io.StringIO(), force_terminal=False)
    with ExitStack() as stack, Narrator(console) as narrator, pytest.raises(InputError, match="real vehicle"):
        _operators((), console, narrator, None, stack, notes=QuestionNotes(Path("nowhere")), real=True)
