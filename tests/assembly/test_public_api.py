from pathlib import Path

import pytest

import mintpilot
from mintpilot.assembly import registry
from mintpilot.core.errors import MissingPartError, UnknownNameError
from mintpilot.core.ports import SourceOptions


def test_every_public_name_is_there_and_listed() -> None:
    assert list(mintpilot.__all__) == sorted(mintpilot.__all__)
    assert set(mintpilot.__all__) == set(mintpilot._PLACES)
    for name in mintpilot.__all__:
        assert getattr(mintpilot, name) is not None
    assert set(mintpilot.__all__) < set(dir(mintpilot))


def test_an_unknown_public_name_says_what_there_is() -> None:
    with pytest.raises(AttributeError, match="plan_mission"):
        mintpilot.no_such_thing  # noqa: B018


@pytest.mark.long
@pytest.mark.parametrize(("port", "name"), [(p, n) for p, table in registry.BUILT_IN.items() for n in table])
def test_every_registered_part_can_be_made(port: str, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MINTPILOT_LLM_URL", "http://127.0.0.1:9/v1")
    monkeypatch.setenv("MINTPILOT_LLM_MODEL", "tiny")
    pictures = ("medicine-boxes", SourceOptions(color=Path("a.png"), depth=Path("b.png"))) if port == "frames" else ()
    try:
        part = registry.load(port, name)
        if port == "vehicle":  # it is made with an address, and connects to it
            assert callable(part)
            return
        made = part(*pictures)
    except MissingPartError as error:
        pytest.skip(str(error))
    assert made is not None
    if hasattr(made, "close"):
        made.close()


def test_an_unknown_part_gives_the_nearest_name() -> None:
    with pytest.raises(UnknownNameError, match="Did you mean 'exhaustive'"):
        registry.load("strategy", "exhautive")
