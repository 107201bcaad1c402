"""The web console: the mission on a page, and the person who answers it there."""

from mintpilot.console.access import Address, Role, Tokens
from mintpilot.console.replay_console import ReplayConsole
from mintpilot.console.web_console import WebConsole

__all__ = ["Address", "ReplayConsole", "Role", "Tokens", "WebConsole"]
