"""Where the autopilot is reached: ``mavlink://udpin:127.0.0.1:14540``."""

from __future__ import annotations

import math
from dataclasses import dataclass
from urllib.parse import parse_qs, urlsplit

from mintpilot.core.errors import InputError

SCHEME = "mavlink://"
TRANSPORTS = ("udpin", "udpout", "tcpin", "tcpout", "serial")


@dataclass(frozen=True, slots=True, kw_only=True)
class Address:
    """How the autopilot is reached, and how the map is turned where it has no georeference."""

    text: str
    """As it was given."""
    connection: str
    """As the MAVLink library wants it: ``udpin://127.0.0.1:14540``."""
    heading_rad: float = 0.0
    """Compass direction of the map's y axis; 0: north."""

    @property
    def listens(self) -> bool:
        """Whether the autopilot has to come to us."""
        return self.connection.split("://")[0] in ("udpin", "tcpin")


def parse_address(text: str) -> Address:
    """The address in a text such as ``mavlink://serial:/dev/ttyUSB0:57600?heading=30``.

    Raises:
        InputError: it is none; the message says what one looks like.
    """
    form = (
        f"'{text}' is no vehicle: write mavlink://TRANSPORT:PLACE, e.g. mavlink://udpin:127.0.0.1:14540 or "
        f"mavlink://serial:/dev/ttyUSB0:57600; transports are {', '.join(TRANSPORTS)}"
    )
    if not text.startswith(SCHEME):
        raise InputError(form)
    body, _, query = text.removeprefix(SCHEME).partition("?")
    transport, _, place = body.partition(":")
    where, _, number = place.rpartition(":")
    if transport not in TRANSPORTS or not where or not number.isdigit():
        raise InputError(form)
    if transport != "serial" and not 0 < int(number) < 65536:
        raise InputError(f"'{text}': port {number} must be from 1 to 65535")
    return Address(text=text, connection=f"{transport}://{place}", heading_rad=_heading(text, query))


def _heading(text: str, query: str) -> float:
    given = parse_qs(urlsplit(f"?{query}").query, keep_blank_values=True)
    try:
        heading = float(given.pop("heading", ["0"])[0])
    except ValueError:
        heading = math.nan
    if given or not math.isfinite(heading):
        raise InputError(
            f"'{text}': after the question mark only heading=DEGREES may stand, the compass direction of y"
        )
    return math.radians(heading)
