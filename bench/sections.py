"""Sections of docs/results.md: each is made by one command and kept as data beside the page."""

from __future__ import annotations

import json
import platform
import subprocess
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DATA = ROOT / "docs" / "results"
PAGE = ROOT / "docs" / "results.md"


@dataclass(frozen=True, kw_only=True)
class Table:
    """One table: a caption, a header and rows of text."""

    caption: str
    header: Sequence[str]
    rows: Sequence[Sequence[str]]

    def markdown(self) -> str:
        lines = [f"**{self.caption}**", ""] if self.caption else []
        lines.append("| " + " | ".join(self.header) + " |")
        lines.append("|" + "---|" * len(self.header))
        lines += ["| " + " | ".join(row) + " |" for row in self.rows]
        return "\n".join(lines)


@dataclass(frozen=True, kw_only=True)
class Section:
    """What one command measured."""

    name: str
    title: str
    command: str
    how: str
    """How it was measured, and with which parameters."""
    tables: Sequence[Table]
    notes: Sequence[str] = ()
    """What falls short, and why."""
    measured_on: str = field(default_factory=lambda: datetime.now(UTC).strftime("%Y-%m-%d"))
    machine: str = field(default_factory=lambda: machine())

    def markdown(self) -> str:
        parts = [f"## {self.title}", f"`{self.command}` · {self.measured_on} · {self.machine}", self.how]
        parts += [table.markdown() for table in self.tables]
        parts += [f"- {note}" for note in self.notes] and ["\n".join(f"- {note}" for note in self.notes)]
        return "\n\n".join(part for part in parts if part)


def machine() -> str:
    """Processor and interpreter, in a few words."""
    model = "unknown processor"
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.exists():
        names = [line.split(":", 1)[1].strip() for line in cpuinfo.read_text().splitlines() if "model name" in line]
        model = f"{len(names)} × {names[0]}" if names else model
    return f"{model}, Python {platform.python_version()}"


def keep(section: Section) -> None:
    """Stores a section's data and writes the page anew from all that is stored."""
    DATA.mkdir(parents=True, exist_ok=True)
    (DATA / f"{section.name}.json").write_text(json.dumps(asdict(section), indent=1, ensure_ascii=False) + "\n")
    write_page()


def write_page() -> None:
    """docs/results.md from the stored sections."""
    sections = [_read(file) for file in sorted(DATA.glob("*.json"))]
    head = (
        "# Results\n\nEvery figure here was written by the command named with it; `make results` runs them all. "
        "Times are of small shared machines and noisy: judge them by ratios. Intervals are Wilson's for shares and "
        "Student's t for means, 95 %."
    )
    PAGE.write_text("\n\n".join([head, *(section.markdown() for section in sections)]) + "\n")


def _read(file: Path) -> Section:
    data = json.loads(file.read_text())
    tables = [Table(**table) for table in data.pop("tables")]
    return Section(**data, tables=tables)


def revision() -> str:
    """The commit that is measured, where git knows it."""
    done = subprocess.run(
        ["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    return done.stdout.strip() or "unknown"
