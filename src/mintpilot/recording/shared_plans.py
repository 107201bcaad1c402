"""Plans, each written once in a log: the nodes of a tree repeat the same few many times."""

from __future__ import annotations

import hashlib
import json

from pydantic import JsonValue

from mintpilot.core.plan import Plan
from mintpilot.recording.codec import Codec
from mintpilot.recording.codec_parts import Budget, CodecError, TypeCodec, shown

_PLAIN = Codec()


class SharedPlans:
    """Both ways for the plans of one log: in full with a number at first, later by the number."""

    def __init__(self) -> None:
        self._count = 0
        self._numbers: dict[bytes, int] = {}
        self._lately: dict[int, tuple[Plan, int]] = {}
        self._plans: dict[int, Plan] = {}

    def type_codec(self) -> TypeCodec:
        """For `mintpilot.recording.codec.Codec`."""
        return TypeCodec(encode=self._encode, decode=self._decode)

    def forget(self) -> None:
        """Plans are written in full again: what was encoded last did not reach the record."""
        self._numbers.clear()
        self._lately.clear()

    def begin(self) -> None:
        """A new event: objects of the one before may be gone."""
        self._lately.clear()

    def _encode(self, value: object) -> JsonValue:
        if not isinstance(value, Plan):
            raise CodecError(f"{shown(value)}: Plan is expected")
        held = self._lately.get(id(value))
        if held is not None:
            return {"same": held[1]}
        document = _PLAIN.type_codec(Plan).encode(value)
        key = hashlib.blake2b(json.dumps(document).encode(), digest_size=16).digest()
        number = self._numbers.get(key)
        known = number is not None
        if number is None:
            number = self._numbers[key] = self._count
            self._count += 1
        self._lately[id(value)] = (value, number)
        return {"same": number} if known else {"number": number, "plan": document}

    def _decode(self, document: JsonValue, budget: Budget) -> Plan:
        if isinstance(document, dict) and document.keys() == {"number", "plan"}:
            number = document["number"]
            plan = _PLAIN.type_codec(Plan).decode(document["plan"], budget)
            if type(number) is not int or number in self._plans or not isinstance(plan, Plan):
                raise CodecError(f"{shown(number)}: the number of a new plan is a whole number that no other has")
            self._plans[number] = plan
            return plan
        number = document.get("same") if isinstance(document, dict) and len(document) == 1 else None
        if type(number) is not int or number not in self._plans:
            raise CodecError(f"{shown(number)}: no plan of this number is in the record so far")
        return self._plans[number]
