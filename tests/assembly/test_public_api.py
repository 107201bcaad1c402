import pytest

import mintpilot
from mintpilot.assembly import registry
from mintpilot.core.errors import UnknownNameError


def test_every_public_name_is_there_and_listed() -> None:
    assert list(mintpilot.__all__) == sorted(mintpilot.__all__)
    assert set(mintpilot.__all__) == set(mintpilot._PLACES)
    for name in mintpilot.__all__:
        assert getattr(mintpilot, name) is not None
    assert set(mintpilot.__all__) < set(dir(mintpilot))


def test_an_unknown_public_name_says_what_there_is() -> None:
    with pytest.raises(AttributeError, match="plan_mission"):
        mintpilot.no_such_thing  # noqa: B018


@pytest.mark.parametrize(("port", "name"), [(p, n) for p, table in registry.BUILT_IN.items() for n in table])
def test_every_registered_part_can_be_made(port: str, name: str) -> None:
    assert registry.load(port, name)() is not None


def test_an_unknown_part_gives_the_nearest_name() -> None:
    with pytest.raises(UnknownNameError, match="Did you mean 'exhaustive'"):
        registry.load("strategy", "exhautive")
