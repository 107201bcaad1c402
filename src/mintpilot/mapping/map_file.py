"""Files that maps are read from: regular ones, of bounded size."""

from __future__ import annotations

import stat
from pathlib import Path

from mintpilot.core.errors import LimitError, MapError


def check_file(path: Path, most_bytes: int, what: str = "map") -> None:
    """Refuses what is no regular file (a device or pipe could be read for ever), and files that are too large.

    Raises:
        MapError: it is missing, cannot be looked at, or is no regular file.
        LimitError: it has more bytes than that.
    """
    try:
        status = path.stat()
    except FileNotFoundError:
        raise MapError(f"there is no {what} '{path}'; check the name, relative to the file that names it") from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise MapError(f"{what} '{path}' cannot be read: {reason}; give a file that you may read") from None
    if not stat.S_ISREG(status.st_mode):
        raise MapError(f"{what} '{path}' is no regular file; give a file, not a folder, device or pipe")
    if status.st_size > most_bytes:
        raise LimitError(
            f"'{path}' has {status.st_size} bytes, more than the {most_bytes} that are read; "
            "cut the map to the part that is flown, or make it coarser"
        )
