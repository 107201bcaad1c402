"""Where a command puts the text that it makes."""

from __future__ import annotations

from pathlib import Path

from mintpilot.core.errors import RecordError


def put(text: str, out: Path | None) -> None:
    """Prints the text, or writes it to that file, makes its folder where it is missing, and prints the file's name.

    Raises:
        RecordError: the file cannot be written.
    """
    if out is None:
        print(text, end="")
        return
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        out.write_text(text, encoding="utf-8")
    except OSError as error:
        raise RecordError(f"cannot write {out}: {error.strerror}; choose another file with --out") from error
    print(out)
