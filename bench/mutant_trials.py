"""Tries mutants in children of one warm process: a plug-in for pytest that takes the place of its run of tests.

Everything is imported and collected once. For each mutant the process forks; the child exchanges the code of the
mutated function, runs the tests that reach its line, and ends at the first failure.
"""

from __future__ import annotations

import ast
import gc
import os
import resource
import signal
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from types import CodeType, FunctionType
from typing import Never

import pytest

from bench.mutations import Mutant
from bench.sections import ROOT

HANGS = 5.0
"""A mutant whose tests take so many times the CPU that they take without it, and `GRACE_S` more, has been noticed."""
GRACE_S = 20.0
WALL = 12.0
"""A child that waits so many times longer than it may compute is ended as well."""


@dataclass(frozen=True, kw_only=True)
class Fate:
    """What became of a mutant."""

    killed: bool
    by: str
    """The test that failed, "time", or why it is alive."""


class Trials:
    """Runs ``trial`` for every mutant, with the tests that are wanted for it in their order.

    Args:
        mutants: in the order of trial.
        wanted: a mutant's tests, and the CPU seconds that they take without it.
        done: is told each fate.
    """

    def __init__(
        self,
        mutants: list[Mutant],
        wanted: Callable[[Mutant], tuple[list[str], float]],
        done: Callable[[Mutant, Fate], None],
    ) -> None:
        self._mutants, self._wanted, self._done = mutants, wanted, done
        self._report: int | None = None

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """All trials."""
        from mintpilot.planning.warm import warm_up

        warm_up()
        items = {item.nodeid: item for item in session.items}
        functions = defaultdict(list)
        for thing in gc.get_objects():
            if isinstance(thing, FunctionType) and thing.__code__.co_filename.startswith(str(ROOT / "src")):
                functions[thing.__code__].append(thing)
        gc.freeze()
        for mutant in self._mutants:
            tests, seconds = self._wanted(mutant)
            chosen = [items[test] for test in tests if test in items]
            if not chosen:
                self._done(mutant, Fate(killed=False, by="no test reaches it"))
                continue
            changes = exchanged(mutant, functions)
            self._done(mutant, self._trial(session, chosen, changes, seconds))
        return True

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """In the child: says which test failed."""
        if self._report is not None and report.failed:
            os.write(self._report, f"{report.nodeid}\n".encode())

    def _trial(
        self,
        session: pytest.Session,
        items: list[pytest.Item],
        changes: list[tuple[FunctionType, CodeType]],
        seconds: float,
    ) -> Fate:
        reading, writing = os.pipe()
        child = os.fork()
        if child == 0:
            os.close(reading)
            self._report = writing
            _in_child(session, items, changes, seconds)
        os.close(writing)
        _, status = os.waitpid(child, 0)
        with suppress(ProcessLookupError):
            os.killpg(child, signal.SIGKILL)  # programs that its tests started
        with os.fdopen(reading) as pipe:
            failed = pipe.readline().strip()
        if failed:
            return Fate(killed=True, by=failed)
        if os.WIFSIGNALED(status):
            return Fate(killed=True, by="time" if os.WTERMSIG(status) in (signal.SIGXCPU, signal.SIGALRM) else "crash")
        return Fate(killed=os.waitstatus_to_exitcode(status) != 0, by=f"{len(items)} tests passed")


def _in_child(
    session: pytest.Session, items: list[pytest.Item], changes: list[tuple[FunctionType, CodeType]], seconds: float
) -> Never:
    os.setpgid(0, 0)
    nothing = os.open(os.devnull, os.O_RDWR)
    for stream in (1, 2):
        os.dup2(nothing, stream)
    most_s = int(HANGS * seconds + GRACE_S)
    spent_s = int(sum(os.times()[:2]))
    resource.setrlimit(resource.RLIMIT_CPU, (spent_s + most_s, spent_s + most_s + 5))
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.alarm(int(WALL * most_s))
    for function, code in changes:
        function.__code__ = code
    session.items = items
    session.config.option.maxfail = 1
    failed = True
    try:
        from _pytest.main import pytest_runtestloop

        pytest_runtestloop(session)
        failed = session.testsfailed > 0
    finally:
        os._exit(int(failed))


def exchanged(mutant: Mutant, functions: dict[CodeType, list[FunctionType]]) -> list[tuple[FunctionType, CodeType]]:
    """The living functions that a mutant changes, each with its new code.

    Raises:
        LookupError: no living function has the code; nothing would be tried.
    """
    path = ROOT / mutant.file
    source = path.read_text(encoding="utf-8")
    old, new = (compile(text, str(path), "exec", dont_inherit=True) for text in (source, mutant.applied(source)))
    pairs = [(a, b) for a, b in zip(_functions(old), _functions(new), strict=True) if a.co_code != b.co_code or a != b]
    start = next(line for line in _outermost(ast.parse(source)) if line[0] <= mutant.line <= line[1])
    chosen = [(a, b) for a, b in pairs if start[0] <= a.co_firstlineno <= start[1]]
    found = [(function, b) for a, b in chosen for function in functions.get(a, ())]
    if not found:
        raise LookupError(f"no living function for {mutant}")
    return found


def _outermost(tree: ast.AST) -> Iterator[tuple[int, int]]:
    """First and last lines of functions that are in no other function, with their decorators."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.FunctionDef):
            first = min([node.lineno, *(d.lineno for d in node.decorator_list)])
            yield first, node.end_lineno or node.lineno
        else:
            yield from _outermost(node)


def _functions(code: CodeType) -> Iterator[CodeType]:
    """The code of functions that are in no other function, in their order."""
    for inner in (c for c in code.co_consts if isinstance(c, CodeType)):
        if inner.co_flags & 0x02:  # local names are fast: a function, not the body of a class
            yield inner
        else:
            yield from _functions(inner)
