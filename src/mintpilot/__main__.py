"""``python -m mintpilot``: the program, for environments without its script on the path."""

from __future__ import annotations

import sys

from mintpilot.cli.main import main

if __name__ == "__main__":
    sys.exit(main())
