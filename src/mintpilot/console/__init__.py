"""The web console: the mission on a page, and the person who answers it there."""

from mintpilot.console.access import Address, Role, Tokens
from mintpilot.console.web_console import WebConsole

__all__ = ["Address", "Role", "Tokens", "WebConsole"]
