"""The web page beside a mission: serves it, says where, and waits until somebody has opened it."""

from __future__ import annotations

import os
import sys
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console

    from mintpilot.assembly.talk import Talk
    from mintpilot.console import WebConsole
    from mintpilot.core.events import Event
    from mintpilot.core.ports import Operator

BESIDE_S = 20.0
"""Where others answer too, somebody at the page is waited for so long, seconds."""
_WAIT_S = 0.2
"""How often it is looked whether somebody has come, seconds: Ctrl-C is heard in between."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PageOptions:
    """Where the page is served, as the command line says it."""

    host: str = "127.0.0.1"
    port: int = 0
    """0: any that is free."""
    tls_cert: Path | None = None
    tls_key: Path | None = None
    tls_self_signed: Path | None = None
    """Folder in which a self-signed pair is made, or used again, in place of a pair that was given."""
    opens: bool = False
    """Whether a browser is opened on it."""
    patience_s: float | None = None
    """How long somebody is waited for before the mission begins without them, seconds; None: as long as it takes."""


class ServedPage:
    """The page of one mission.

    Args:
        options: where it is served.
        console: where its addresses are printed.
        stack: closes it in the end.
    """

    def __init__(self, options: PageOptions, console: Console, stack: ExitStack) -> None:
        self._options, self._console, self._stack = options, console, stack
        self._page: WebConsole | None = None

    def record(self, event: Event) -> None:
        """Shows one event."""
        if self._page is not None:
            self._page.record(event)

    def operator(self, talk: Talk) -> Operator:
        """Serves the page, and waits until somebody who may answer has opened it.

        Raises:
            DeviceError: it cannot be served.
            InputError: the address may not be used so.
            MissingPartError: the web server is not installed.
        """
        from mintpilot.console import Address, Role, WebConsole

        options = self._options
        cert, key = options.tls_cert, options.tls_key
        if options.tls_self_signed is not None:
            from mintpilot.console.self_signed import self_signed

            pair = self_signed(options.tls_self_signed, options.host)
            cert, key = pair.cert, pair.key
            self._console.print(
                f"Browsers will warn of a certificate that nobody vouches for. Compare its SHA-256 fingerprint:\n"
                f"{pair.fingerprint}",
                highlight=False,
                soft_wrap=True,
                markup=False,
            )
        address = Address(host=options.host, port=options.port, tls_cert=cert, tls_key=key)
        page = WebConsole(understand=talk.understand, order_of=talk.order_of, address=address)
        self._stack.callback(page.close)
        self._page = page
        for text in (f"To answer, open {page.url()}", f"To watch, open  {page.url(Role.WATCH)}"):
            self._console.print(text, highlight=False, soft_wrap=True, markup=False)
        if options.opens:
            import webbrowser

            webbrowser.open(page.url())
        self._console.print("The mission begins when somebody has opened the page to answer.", highlight=False)
        waited_s = 0.0
        while not page.wait_for_somebody(_WAIT_S):
            waited_s += _WAIT_S
            if options.patience_s is not None and waited_s >= options.patience_s:
                self._console.print("Nobody has yet: the mission begins, and whoever is here answers.", highlight=False)
                break
        return page

    def voice(self, talk: Talk) -> Operator:
        """Who hears the microphone of the page, and speaks there; made after `operator`."""
        from mintpilot.assembly.page_voice import PageVoice

        assert self._page is not None
        heard = PageVoice(self._page.microphone, talk)
        self._stack.callback(heard.close)
        return heard


def browser_can_open() -> bool:
    """Whether a browser window can be opened for the person at this terminal."""
    if not (sys.stdin is not None and sys.stdin.isatty() and sys.stderr.isatty()):
        return False
    if os.environ.get("CI") or os.environ.get("SSH_CONNECTION"):
        return False
    if sys.platform.startswith("linux") and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        return False
    import webbrowser
    from importlib.util import find_spec

    if any(find_spec(name) is None for name in ("fastapi", "uvicorn", "websockets")):
        return False
    try:
        webbrowser.get()
    except webbrowser.Error:
        return False
    return True
