"""The one tree of errors. A class per thing a caller can do about it.

    MintPilotError
    ├── InputError            the user gave something wrong: change the input
    │   ├── MissionError      … in a mission file, with the place of the mistake
    │   ├── MapError          … in a map, scene or picture
    │   ├── UnknownNameError  … a name nobody registered; the nearest known one is given
    │   └── ConformanceError  … a plug-in that breaks the contract of its port
    ├── InfeasibleError       the input is sound, but nothing can be flown
    ├── LimitError            the work would pass a stated bound: raise the bound or shrink the work
    ├── MissingPartError      an optional part is not installed: install it
    ├── DeviceError           a sensor, vehicle or operator link failed: mend the link
    └── RecordError           the run folder cannot be written or read

Every message gives the offending value, the rule that it broke and the next step.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable

from mintpilot.core.message import Message, verbatim


class MintPilotError(Exception):
    """Root of all errors that MintPilot raises on purpose. Where people may hear of one, its text is a `Message`."""

    @property
    def said(self) -> Message:
        """What went wrong, to be said in any language; a text that is no message is said as it is."""
        first = self.args[0] if self.args else None
        return first if isinstance(first, Message) else verbatim(str(self))


class InputError(MintPilotError):
    """Something that the user gave is wrong."""


class MissionError(InputError):
    """A mission is malformed or contradicts itself.

    Attributes:
        place: where in the file, e.g. ``mission.yaml:12 (regions[0].prior)``; may be empty.
    """

    def __init__(self, message: str, *, place: str = "") -> None:
        super().__init__(f"{place}: {message}" if place else message)
        self.place = place


class MapError(InputError):
    """A map, scene or picture cannot be used."""


class UnknownNameError(InputError):
    """A name that nobody registered; ``now`` is what a former name was changed to."""

    def __init__(self, kind: str, name: str, known: Iterable[str], *, now: str = "") -> None:
        names = sorted(known)
        near = difflib.get_close_matches(name, names, n=1, cutoff=0.4)
        hint = f" It is called '{now}' now." if now else f" Did you mean '{near[0]}'?" if near else ""
        super().__init__(f"unknown {kind} '{name}'.{hint} Known: {', '.join(names) or '(none)'}.")


class ConformanceError(InputError):
    """A plug-in breaks the contract of its port."""


class InfeasibleError(MintPilotError):
    """No plan exists, whatever the answers are."""


class LimitError(MintPilotError):
    """The work asked for would pass a stated bound."""


class MissingPartError(MintPilotError):
    """An optional part is not installed."""


class DeviceError(MintPilotError):
    """A sensor, a vehicle or an operator's link failed."""


class RecordError(MintPilotError):
    """A run folder or record cannot be written or read."""
