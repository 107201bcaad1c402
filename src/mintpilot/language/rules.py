"""The rules for clauses, in the order in which they are tried. What no rule takes refuses the instruction."""

from __future__ import annotations

from collections.abc import Callable

from mintpilot.language.asking import count, photograph, report, seek, somebody_in, told
from mintpilot.language.carrying import bring, bring_somebody, drop, needed, pick
from mintpilot.language.clauses import Reading
from mintpilot.language.going import (
    find,
    go,
    go_on_home,
    home,
    look_behind,
    look_into,
    same,
    search_venue,
    take_off,
    visit,
    wait,
)


def read_clause(reading: Reading) -> bool:
    """Takes one clause; False, and nothing taken, where no rule fits. Raises `InputError` for what is impossible."""
    return any(reading.attempt(rule) for rule in _RULES)


_RULES: tuple[Callable[[Reading], None], ...] = (
    take_off, home, photograph, report, count, wait, somebody_in, seek, search_venue, look_into, look_behind,
    find, go, visit, bring, bring_somebody, drop, pick, needed, go_on_home, same, told,
)  # fmt: skip
"""The first that fits the words at the cursor decides; a longer reading stands before a shorter one."""
