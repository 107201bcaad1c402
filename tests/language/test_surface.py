"""What the room offers to others."""

from __future__ import annotations

import mintpilot.language as room


def test_the_public_names_are_sorted_complete_and_documented() -> None:
    assert list(room.__all__) == sorted(room.__all__)
    public = {name for name, thing in vars(room).items() if not name.startswith("_") and hasattr(thing, "__doc__")}
    modules = {name for name in public if type(getattr(room, name)).__name__ == "module"}
    assert public - modules == set(room.__all__)
    assert all(getattr(room, name).__doc__ for name in room.__all__)
