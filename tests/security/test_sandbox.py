"""The demo where nothing is allowed: everything read-only but one folder, no network, no root, no HOME."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow
DEMO = ["-m", "mintpilot", "demo", "--headless", "--vehicle", "kinematic", "--json"]
KEPT = ("PATH", "PYTHONPATH", "LANG")
LONGEST_S = 900
"""Without a cache everything is compiled again."""


def boxed(words: list[str], writable: Path) -> subprocess.CompletedProcess[str]:
    """Runs a program in the sandbox that this machine has."""
    environment = {name: os.environ[name] for name in KEPT if name in os.environ}
    return subprocess.run(
        [*sandbox(writable), *words],
        capture_output=True,
        text=True,
        stdin=subprocess.DEVNULL,
        env=environment,
        cwd="/",
        timeout=LONGEST_S,
        check=False,
    )


def sandbox(writable: Path) -> list[str]:
    """The words before a program's; skips where there is neither bubblewrap nor unshare."""
    made = [
        ["bwrap", "--ro-bind", "/", "/", "--dev", "/dev", "--proc", "/proc", "--tmpfs", "/tmp", "--unshare-all",
         "--uid", "65534", "--gid", "65534", "--bind", str(writable), str(writable), "--die-with-parent"],
        ["unshare", "--user", "--map-root-user", "--net", "--mount", "sh", "-c",
         f"mount --bind {writable} {writable} && mount -o remount,bind,ro / && exec unshare --user \"$@\"", "sh"],
    ]  # fmt: skip
    for words in made:
        if (
            shutil.which(words[0])
            and subprocess.run([*words, "true"], capture_output=True, check=False).returncode == 0
        ):
            return words
    pytest.skip("neither bubblewrap nor unshare works here: apt-get install bubblewrap")


PROBE = """
import os, pathlib, socket
assert os.getuid() != 0 and "HOME" not in os.environ
for path in ("/etc/mintpilot-probe", str(pathlib.Path(os.__file__).parent / "probe")):
    try:
        open(path, "w")
    except OSError:
        continue
    raise SystemExit("written: " + path)
try:
    socket.create_connection(("192.0.2.1", 80), timeout=2)
except OSError:
    print("nothing is allowed")
"""


def test_the_sandbox_is_one(tmp_path: Path) -> None:
    done = boxed([sys.executable, "-c", PROBE], tmp_path)
    assert done.stdout == "nothing is allowed\n", done.stderr


def test_the_demo_flies_where_nothing_is_allowed(tmp_path: Path) -> None:
    done = boxed([sys.executable, *DEMO, "--out", str(tmp_path / "run")], tmp_path)
    assert done.returncode in (0, 1), done.stderr
    assert json.loads(done.stdout)["outcome"] in ("success", "partial")
    assert (tmp_path / "run" / "record.json").is_file()
    assert (tmp_path / "run" / "report.html").is_file()
    assert "Traceback" not in done.stderr
    assert "cannot be kept on this machine" in done.stderr


def test_doctor_says_that_nothing_can_be_kept(tmp_path: Path) -> None:
    done = boxed([sys.executable, "-m", "mintpilot", "doctor"], tmp_path)
    assert "nowhere to keep it" in done.stdout + done.stderr
