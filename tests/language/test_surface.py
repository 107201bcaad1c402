"""What the room offers to others."""

from __future__ import annotations

import pytest

import mintpilot.language as room


def test_the_public_names_are_sorted_complete_and_documented() -> None:
    assert list(room.__all__) == sorted(room.__all__)
    modules = {name for name, thing in vars(room).items() if type(thing).__name__ == "module"}
    loaded = {name for name in vars(room) if not name.startswith("_")} - modules
    assert loaded <= set(room.__all__)
    assert all(getattr(room, name).__doc__ for name in room.__all__)
    with pytest.raises(AttributeError, match=r"it offers .*read_answer"):
        room.read_anser  # noqa: B018
