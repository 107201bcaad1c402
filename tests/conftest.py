"""For all tests."""

import os
import signal

import pytest
from hypothesis import Phase, settings

settings.register_profile("repeatable", derandomize=True)
"""For the continuous integration: the same examples each time, so that a change is judged by what it changed."""
settings.register_profile("searching", print_blob=True)
"""Other examples each time: what a developer's own runs search through."""
settings.register_profile("mutants", derandomize=True, deadline=None, phases=(Phase.explicit, Phase.generate))
"""For small faults (`bench.mutants`): no limit of time, and no search for a smaller example."""
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "searching"))


def pytest_configure(config: pytest.Config) -> None:
    """Ctrl-C works in the programs that tests start, also where the tests themselves run in the background.

    A shell without job control starts background work with Ctrl-C ignored, and children inherit that.
    """
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    if signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:  # started by nohup
        signal.signal(signal.SIGHUP, signal.SIG_DFL)
    if getattr(config.option, "dist", "no") != "no" and not hasattr(config, "workerinput"):
        _compile_once()


def _compile_once() -> None:
    """Several workers that begin together would each compile the search."""
    from mintpilot.planning.warm import warm_up

    warm_up()
