"""What `make setup` installs is pinned by hash, and covers what the package declares."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

DECLARED = tomllib.loads(Path("pyproject.toml").read_text(encoding="utf-8"))["project"]
EXTRAS = {"run": ("sim", "console"), "dev": ("sim", "dev", "bench", "docs")}
PIN = re.compile(r"^([A-Za-z0-9_.-]+)==\S+.* \\\n((?:    --hash=sha256:[0-9a-f]{64}(?: \\)?\n)+)", re.MULTILINE)


def named(requirement: str) -> str:
    return re.sub(r"[-_.]+", "-", re.split(r"[\[<>=!~; ]", requirement, maxsplit=1)[0]).lower()


@pytest.mark.parametrize("level", EXTRAS)
def test_every_package_is_pinned_by_hash(level: str) -> None:
    text = Path(f"requirements/{level}.txt").read_text(encoding="utf-8")
    pins = {named(pin[1]) for pin in PIN.finditer(text)}
    assert not PIN.sub("", text).strip(), "something stands there that is not pinned by hash"
    wanted = {named(one) for one in DECLARED["dependencies"]} | {"hatchling", "editables"}
    for extra in EXTRAS[level]:
        wanted |= {named(one) for one in DECLARED["optional-dependencies"][extra]}
    assert wanted <= pins


def test_setup_installs_nothing_else() -> None:
    text = Path("scripts/setup.sh").read_text(encoding="utf-8")
    assert re.findall(r"install --\S+", text) == ["install --quiet", "install --require-hashes", "install --no-deps"]
