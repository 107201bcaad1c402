"""Notes which test reaches which line and how long it takes: a plug-in for pytest, in one process.

The lines that a shared fixture runs belong to every test that uses the fixture, not only to the first one.
"""

from __future__ import annotations

import json
import os
from collections import defaultdict
from collections.abc import Generator
from pathlib import Path

import pytest
from coverage import Coverage

ROOT = Path(__file__).resolve().parents[1]


class Mapper:
    """Writes ``{"seconds": {test: CPU s}, "lines": {file: {line: [test, …]}}}``."""

    def __init__(self, sources: list[str], out: Path) -> None:
        self._out = out
        self._coverage = Coverage(data_file=None, config_file=False, include=[str(ROOT / s) for s in sources])
        self._coverage.start()
        self._now = ""
        self._seconds: dict[str, float] = {}
        self._fixtures: dict[str, set[str]] = defaultdict(set)
        """Which tests use what a fixture made."""

    def _switch(self, context: str) -> str:
        before, self._now = self._now, context
        self._coverage.switch_context(context)
        return before

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Generator[None, object, object]:
        """One test, with the fixtures that it alone uses."""
        before, start_s = self._switch(item.nodeid), _cpu_s()
        done = yield
        self._seconds[item.nodeid] = _cpu_s() - start_s
        self._switch(before)
        for name, found in item._fixtureinfo.name2fixturedefs.items():
            for made in found:
                if made.scope != "function":
                    self._fixtures[f"fixture {made.baseid} {name}"].add(item.nodeid)
        return done

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef: pytest.FixtureDef[object]) -> Generator[None, object, object]:
        """A fixture that others use as well."""
        shared = fixturedef.scope != "function"
        before = self._switch(f"fixture {fixturedef.baseid} {fixturedef.argname}" if shared else self._now)
        made = yield
        self._switch(before)
        return made

    def pytest_sessionfinish(self) -> None:
        """Writes the file."""
        self._coverage.stop()
        data, lines = self._coverage.get_data(), {}
        for name in data.measured_files():
            found = {}
            for line, contexts in data.contexts_by_lineno(name).items():
                tests = {t for c in contexts for t in self._fixtures.get(c, (c,)) if t and not t.startswith("fixture ")}
                if tests:
                    found[str(line)] = sorted(tests)
            lines[str(Path(name).resolve().relative_to(ROOT))] = found
        if not any(lines.values()):
            raise pytest.UsageError("no line was reached by any test: mutants would all be alive")
        self._out.write_text(json.dumps({"seconds": self._seconds, "lines": lines}))


def _cpu_s() -> float:
    times = os.times()
    return sum(times[:4])
