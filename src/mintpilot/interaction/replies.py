"""What typed words mean. Few forms are accepted on purpose: a guess here would be a guess about somebody's safety."""

from __future__ import annotations

from mintpilot.core.query import Command, Reply

REPLIES: dict[str, Reply] = {
    "y": Reply.YES,
    "yes": Reply.YES,
    "n": Reply.NO,
    "no": Reply.NO,
    "?": Reply.UNSURE,
    "u": Reply.UNSURE,
    "unsure": Reply.UNSURE,
    "not sure": Reply.UNSURE,
    "i'm not sure": Reply.UNSURE,
    "don't know": Reply.UNSURE,
    "dont know": Reply.UNSURE,
    "i don't know": Reply.UNSURE,
    "i dont know": Reply.UNSURE,
    "no idea": Reply.UNSURE,
}
"""Accepted words in lower case, without a full stop at the end."""

COMMANDS: dict[str, Command] = {
    "stop": Command.HOLD,
    "hold": Command.HOLD,
    "abort": Command.ABORT,
    "return": Command.RETURN,
}
"""Orders. ``stop`` stops the motion: the drone holds."""

ACCEPTED = "y (yes), n (no), ? (don't know), or an order: hold, return, abort"
"""What to tell somebody who typed something else."""


def understand(text: str) -> Reply | Command | None:
    """The reply or the order that the words mean; None when they mean neither for certain.

    Case, surrounding space, repeated space and a closing ``.`` or ``!`` make no difference.
    """
    words = " ".join(text.lower().replace("\N{RIGHT SINGLE QUOTATION MARK}", "'").split()).rstrip(".!").strip()
    return COMMANDS.get(words) or REPLIES.get(words)
