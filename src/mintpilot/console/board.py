"""What browsers show, as named panes and growing streams: each browser gets the newest of whatever it has not got."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

from pydantic import BaseModel

LONGEST_STREAM = 4000
"""Items kept of a stream; a browser that comes later gets those."""


Text = str | bytes
"""What is sent over the WebSocket."""


class Panes(Protocol):
    """Where panes and streams are shown, or kept."""

    def put(self, name: str, pane: BaseModel, payload: bytes | None = None) -> None:
        """Replaces a pane."""
        ...

    def append(self, name: str, item: BaseModel) -> None:
        """Adds an item to a stream."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class _Pane:
    version: int
    message: Text


@dataclass(slots=True)
class _Stream:
    begun: int = 0
    """How many items were thrown away."""
    items: list[str] = field(default_factory=list)


@dataclass(slots=True)
class Cursor:
    """How far one browser has got."""

    panes: dict[str, int] = field(default_factory=dict)
    streams: dict[str, int] = field(default_factory=dict)


class Board:
    """Thread-safe. Writers never wait for readers: a slow reader skips versions of a pane, and never the last one."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._panes: dict[str, _Pane] = {}
        self._streams: dict[str, _Stream] = {}
        self._version = 0
        self._wakers: dict[int, Callable[[], object]] = {}

    def put(self, name: str, pane: BaseModel, payload: bytes | None = None) -> None:
        """Replaces a pane. With a payload (a picture) it is sent as one binary message: length, head, payload."""
        self.put_message(name, message_of(name, pane, payload))

    def put_message(self, name: str, message: Text) -> None:
        """Replaces a pane by a message that was made before."""
        with self._lock:
            self._version += 1
            self._panes[name] = _Pane(version=self._version, message=message)
        self._wake()

    def append(self, name: str, item: BaseModel) -> None:
        """Adds an item to a stream."""
        with self._lock:
            stream = self._streams.setdefault(name, _Stream())
            stream.items.append(item.model_dump_json())
            if len(stream.items) > LONGEST_STREAM:
                half = len(stream.items) // 2
                stream.begun += half
                del stream.items[:half]
        self._wake()

    def put_stream(self, name: str, items: list[str]) -> None:
        """Replaces a stream by more or fewer of its items; browsers that have more drop the rest."""
        with self._lock:
            self._streams[name] = _Stream(items=items)
        self._wake()

    def news(self, cursor: Cursor) -> str | bytes | None:
        """The next thing that this browser has not got, the question before all else; None: it has everything."""
        with self._lock:
            waiting = [name for name, pane in self._panes.items() if cursor.panes.get(name, 0) < pane.version]
            if waiting:
                name = min(waiting, key=lambda name: (_URGENCY.get(name, 1), self._panes[name].version))
                cursor.panes[name] = self._panes[name].version
                return self._panes[name].message
            for name, stream in self._streams.items():
                had = cursor.streams.get(name, 0)
                at = min(max(had, stream.begun), stream.begun + len(stream.items))
                fresh = stream.items[at - stream.begun :]
                if fresh or at < had:
                    cursor.streams[name] = at + len(fresh)
                    return f'{{"stream":{json.dumps(name)},"from":{at},"items":[{",".join(fresh)}]}}'
        return None

    def join(self, key: int, wake: Callable[[], object]) -> None:
        """``wake`` is called, in any thread, whenever something changes."""
        with self._lock:
            self._wakers[key] = wake

    def leave(self, key: int) -> None:
        """That reader is gone."""
        with self._lock:
            self._wakers.pop(key, None)

    def _wake(self) -> None:
        with self._lock:
            wakers = tuple(self._wakers.values())
        for wake in wakers:
            wake()


def message_of(name: str, pane: BaseModel, payload: bytes | None) -> Text:
    """A pane as it is sent: text, or with a payload length, head and payload."""
    head = f'{{"pane":{json.dumps(name)},"data":{pane.model_dump_json()}}}'
    if payload is None:
        return head
    encoded = head.encode()
    return len(encoded).to_bytes(4, "big") + encoded + payload


_URGENCY = {"question": 0, "mission": 0, "told": 0, "pose": 2, "camera": 3}
