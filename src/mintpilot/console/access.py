"""Who may look, who may answer, and how fast: tokens, hosts, origins, rates."""

from __future__ import annotations

import hmac
import ipaddress
import secrets
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path

from mintpilot.core.errors import InputError

_TOKEN_BYTES = 16


class Role(StrEnum):
    """What a token opens."""

    ANSWER = "answer"
    """Looking, answering, and giving orders."""
    WATCH = "watch"
    """Looking."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Tokens:
    """Drawn anew for each run; they stand in the fragment of the address, which no browser sends to a server."""

    answer: str = field(default_factory=lambda: secrets.token_urlsafe(_TOKEN_BYTES), repr=False)
    watch: str = field(default_factory=lambda: secrets.token_urlsafe(_TOKEN_BYTES), repr=False)

    def role(self, token: str) -> Role | None:
        """What that token opens, compared in constant time; None: nothing."""
        given = token.encode()
        may_answer = hmac.compare_digest(given, self.answer.encode())
        may_watch = hmac.compare_digest(given, self.watch.encode())
        if may_answer:
            return Role.ANSWER
        return Role.WATCH if may_watch else None


@dataclass(frozen=True, slots=True, kw_only=True)
class Address:
    """Where the page is served.

    Raises:
        InputError: another machine could reach it and there is no TLS, or only half of a pair is given.
    """

    host: str = "127.0.0.1"
    port: int = 0
    """0: any that is free."""
    tls_cert: Path | None = None
    tls_key: Path | None = None

    def __post_init__(self) -> None:
        if (self.tls_cert is None) is not (self.tls_key is None):
            raise InputError("TLS needs both --tls-cert and --tls-key: one of them is missing")
        for file in (self.tls_cert, self.tls_key):
            if file is not None and not file.is_file():
                raise InputError(f"there is no file {file}: give the certificate and its key as PEM files")
        if not 0 <= self.port <= 65535:
            raise InputError(f"port {self.port}: it must be from 0 (any that is free) to 65535")
        if not self.is_local and not self.is_safe:
            raise InputError(
                f"--host {self.host} is reached by other machines: give --tls-cert and --tls-key, or --tls-self-signed "
                "and a folder, or leave --host out"
            )

    @property
    def is_safe(self) -> bool:
        """Whether what is said is encrypted."""
        return self.tls_cert is not None

    @property
    def is_local(self) -> bool:
        """Whether only this machine reaches it."""
        if self.host == "localhost":
            return True
        try:
            return ipaddress.ip_address(self.host).is_loopback
        except ValueError:
            return False

    def hosts(self, port: int) -> frozenset[str]:
        """The values of a Host header that are served."""
        names = {self.host}
        if self.is_local:
            names |= {"127.0.0.1", "localhost", "[::1]"}
        bracketed = {f"[{name}]" if ":" in name and not name.startswith("[") else name for name in names}
        return frozenset(f"{name}:{port}" for name in bracketed)

    def origins(self, port: int) -> frozenset[str]:
        """The values of an Origin header from which a WebSocket is opened."""
        scheme = "https" if self.is_safe else "http"
        return frozenset(f"{scheme}://{host}" for host in self.hosts(port))


class Rate:
    """A bound on how often something may happen: so many at once, and so many a second in the long run."""

    def __init__(self, *, burst: int, per_second: float, clock: Callable[[], float] = time.monotonic) -> None:
        self._burst, self._per_second, self._clock = burst, per_second, clock
        self._left = float(burst)
        self._at = clock()

    def allows(self) -> bool:
        """Whether it may happen now; counts it if so."""
        now = self._clock()
        self._left = min(float(self._burst), self._left + (now - self._at) * self._per_second)
        self._at = now
        if self._left < 1:
            return False
        self._left -= 1
        return True
