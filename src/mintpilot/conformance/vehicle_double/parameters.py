"""The parameters of the double, with the defaults and the types of the firmware that it stands for."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field
from enum import StrEnum


class Flavour(StrEnum):
    """Whose ways the double has."""

    PX4 = "px4"
    ARDUPILOT = "ardupilot"


REAL32, INT32, INT8, INT16 = 9, 6, 2, 4

_PX4: dict[str, tuple[float, int]] = {
    "MIS_TAKEOFF_ALT": (2.5, REAL32),
    "COM_OF_LOSS_T": (1.0, REAL32),
    "COM_OBL_RC_ACT": (0, INT32),
    "COM_FAIL_ACT_T": (5.0, REAL32),
    "COM_DL_LOSS_T": (10, INT32),
    "NAV_DLL_ACT": (0, INT32),
    "COM_LOW_BAT_ACT": (0, INT32),
    "GF_ACTION": (2, INT32),
    "GF_MAX_VER_DIST": (0.0, REAL32),
    "RTL_RETURN_ALT": (30.0, REAL32),
    "RTL_CONE_ANG": (45, INT32),
    "RTL_TYPE": (0, INT32),
    "NAV_RCL_ACT": (2, INT32),
    "COM_FLTT_LOW_ACT": (3, INT32),
    "MAV_SYS_ID": (1, INT32),
}
_ARDUPILOT: dict[str, tuple[float, int]] = {
    "MAV_GCS_SYSID": (255, INT16),
    "FS_GCS_ENABLE": (0, INT8),
    "FS_GCS_TIMEOUT": (5.0, REAL32),
    "GUID_TIMEOUT": (3.0, REAL32),
    "BATT_FS_LOW_ACT": (0, INT8),
    "BATT_FS_CRT_ACT": (0, INT8),
    "FENCE_ACTION": (1, INT8),
    "FENCE_ALT_MAX": (100.0, REAL32),
    "FENCE_TYPE": (7, INT8),
    "FENCE_ENABLE": (0, INT8),
    "RTL_ALT_M": (15.0, REAL32),
    "RTL_CONE_SLOPE": (3.0, REAL32),
    "FS_THR_ENABLE": (1, INT8),
    "FS_DR_ENABLE": (2, INT8),
    "FS_EKF_ACTION": (1, INT8),
    "BATT_LOW_VOLT": (10.5, REAL32),
    "BATT_LOW_MAH": (0.0, REAL32),
    "PILOT_TKOFF_ALT": (0.0, REAL32),
}


@dataclass(slots=True)
class Parameters:
    """Name → value and MAVLink type. Whole numbers go as bytes on PX4, as a float's value on ArduPilot."""

    flavour: Flavour
    values: dict[str, float] = field(default_factory=dict)
    types: dict[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        table = _PX4 if self.flavour is Flavour.PX4 else _ARDUPILOT
        self.values = {name: value for name, (value, _) in table.items()}
        self.types = {name: kind for name, (_, kind) in table.items()}

    def __getitem__(self, name: str) -> float:
        return self.values[name]

    @property
    def names(self) -> list[str]:
        """In the order of their index."""
        return list(self.values)

    def encoded(self, name: str) -> float:
        """The value as the message's float field carries it."""
        value = self.values[name]
        if self.types[name] == REAL32 or self.flavour is Flavour.ARDUPILOT:
            return value
        return float(struct.unpack("<f", struct.pack("<i", int(value)))[0])

    def put(self, name: str, carried: float, kind: int) -> bool:
        """Takes a value over from a message; False where there is no such parameter, or it is of another type."""
        if name not in self.values:
            return False
        if self.flavour is Flavour.PX4 and kind != self.types[name]:
            return False
        if self.types[name] != REAL32 and self.flavour is Flavour.PX4:
            carried = struct.unpack("<i", struct.pack("<f", carried))[0]
        self.values[name] = float(carried) if self.types[name] == REAL32 else float(round(carried))
        return True
