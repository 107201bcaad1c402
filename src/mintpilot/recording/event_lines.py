"""Lines of an event log: one JSON object each, chained by a running digest.

Every line ends in ``"chain"``: BLAKE2b over the chain of the line before and the bytes of this one. Lines that were
changed, removed, moved or put in are so found where they stand. It guards against mishaps and careless hands, not
against somebody who computes the chain anew.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Mapping

from pydantic import JsonValue

from mintpilot.core.errors import RecordError

MAX_LINE_BYTES = 32 * 2**20
"""A longer line is neither written nor read."""
_ENDING = re.compile(rb',"chain":"([0-9a-f]{32})"\}\Z')
_ENDING_BYTES = len(',"chain":""}') + 32


def sealed(fields: Mapping[str, JsonValue], last: bytes) -> tuple[bytes, bytes]:
    """A line with its line feed, and its chain.

    Args:
        fields: what the line says.
        last: chain of the line before; empty for the first.

    Raises:
        RecordError: the line would be too long.
    """
    body = json.dumps(fields, ensure_ascii=False, allow_nan=False, separators=(",", ":"))[:-1].encode()
    chain = _chain(last, body)
    line = body + b',"chain":"' + chain + b'"}\n'
    if len(line) > MAX_LINE_BYTES:
        raise RecordError(f"an event of {len(line)} bytes: a line of the log has at most {MAX_LINE_BYTES}")
    return line, chain


def opened(line: bytes, last: bytes) -> tuple[dict[str, JsonValue], bytes] | None:
    """The fields of a line (without line feed) and its chain; None where it is not what was written after ``last``."""
    ending = _ENDING.search(line, max(0, len(line) - _ENDING_BYTES))
    if ending is None or ending[1] != _chain(last, line[: ending.start()]):
        return None
    fields = plain_json(line[: ending.start()] + b"}")
    return None if fields is None else (fields, ending[1])


def _chain(last: bytes, body: bytes) -> bytes:
    return hashlib.blake2b(last + body, digest_size=16).hexdigest().encode()


def plain_json(text: bytes) -> dict[str, JsonValue] | None:
    """The object in that text; None where there is none, whatever the text is."""
    try:
        data = json.loads(text, parse_constant=_refuse)
    except (ValueError, RecursionError):
        return None
    return data if isinstance(data, dict) else None


def _refuse(constant: str) -> None:
    raise ValueError(constant)
