"""How the program ends: one table of exit codes, and the one place where errors become words."""

from __future__ import annotations

import errno
import json
import os
import sys
import traceback
from collections.abc import Callable
from enum import IntEnum

from mintpilot.core.errors import DeviceError, MintPilotError, MissingPartError, RecordError


class ExitCode(IntEnum):
    """What the program returns to the shell."""

    SUCCESS = 0
    """Done; a mission that was flown succeeded."""
    NOT_A_SUCCESS = 1
    """The mission was flown, but did not succeed; the report says why."""
    WRONG_INPUT = 2
    """A file, option or name is wrong, or asks for what nothing can fly."""
    MISSING_PART = 3
    """Something is missing on this machine; `mintpilot doctor` says what."""
    FAILED_DEVICE = 4
    """A device, a link or the run folder failed."""
    DEFECT = 70
    """A defect of MintPilot itself; `--debug` shows where."""
    INTERRUPTED = 130
    """Ctrl-C; the run folder is readable."""


EPILOGUE = "Exit codes: " + "; ".join(
    (
        "0 success",
        "1 the mission was flown but did not succeed",
        "2 wrong input",
        "3 something is missing on this machine",
        "4 a device or the run folder failed",
        "70 a defect of MintPilot",
        "130 Ctrl-C.",
    )
)
ERROR_SCHEMA_VERSION = 1
_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EIO)


def guarded(work: Callable[[], ExitCode], *, as_json: bool, debug: bool) -> ExitCode:
    """Runs a command; what goes wrong becomes words on standard error and an exit code, never a traceback.

    Args:
        work: the command.
        as_json: put the error on standard output too, as one JSON object.
        debug: show the traceback as well.
    """
    try:
        return work()
    except BrokenPipeError:
        # Whoever read our output went away (a pager was closed): nothing is left to say, nor anybody to hear it.
        hush()
        return ExitCode.SUCCESS
    except (Exception, KeyboardInterrupt) as error:  # the last resort: a user must never meet a bare traceback
        if debug:
            traceback.print_exc()
        code, message = verdict_on(error)
        return fail(message, as_json=as_json, code=code, kind=type(error).__name__)


def hush() -> None:
    """Nobody reads standard output any more: what is still to come goes nowhere."""
    sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115, PTH123


def verdict_on(error: BaseException) -> tuple[ExitCode, str]:
    """The exit code and the words for whatever went wrong."""
    if isinstance(error, KeyboardInterrupt):
        return ExitCode.INTERRUPTED, f"stopped by {error.args[0] if error.args else 'Ctrl-C'}"
    if isinstance(error, MissingPartError):
        return ExitCode.MISSING_PART, str(error)
    if isinstance(error, DeviceError | RecordError):
        return ExitCode.FAILED_DEVICE, str(error)
    if isinstance(error, MintPilotError):
        return ExitCode.WRONG_INPUT, str(error)
    if isinstance(error, OSError) and error.errno in _FULL:
        return (
            ExitCode.FAILED_DEVICE,
            f"the output cannot be written: {error.strerror}; make room for it",
        )
    if isinstance(error, MemoryError):
        return ExitCode.WRONG_INPUT, "not enough memory; make the map smaller or coarser"
    return (
        ExitCode.DEFECT,
        f"a defect of MintPilot: {type(error).__name__}: {error}; run again with --debug and report what it shows",
    )


def shown(text: str) -> str:
    """Text of others for a terminal: control characters are spelt out, lines stay lines."""
    return "".join(c if c.isprintable() or c == "\n" else c.encode("unicode_escape").decode() for c in text)


def fail(message: str, *, as_json: bool, code: ExitCode = ExitCode.WRONG_INPUT, kind: str = "InputError") -> ExitCode:
    """Says what went wrong on standard error, and with ``as_json`` on standard output as one object."""
    print(f"mintpilot: {shown(message)}", file=sys.stderr)
    if as_json:
        failure = {"kind": kind, "message": message, "exit_code": int(code)}
        report = {"schema_version": ERROR_SCHEMA_VERSION, "outcome": "error", "error": failure}
        print(json.dumps(report, ensure_ascii=False))
    return code
