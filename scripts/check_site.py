"""Fails where a built page would make a browser load something from another place: `check_site.py FOLDER`."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path

LOADING = {
    "audio": ("src",),
    "embed": ("src",),
    "iframe": ("src",),
    "image": ("href", "xlink:href"),
    "img": ("src", "srcset"),
    "input": ("src",),
    "link": ("href",),
    "object": ("data",),
    "script": ("src",),
    "source": ("src", "srcset"),
    "track": ("src",),
    "use": ("href", "xlink:href"),
    "video": ("src", "poster"),
}
"""Tag → attributes whose address a browser loads by itself. Links that a reader follows are not among them."""
NOT_LOADED = {"canonical", "alternate", "author", "license", "next", "prev"}
"""Values of ``rel`` of a ``link`` that only names a place."""
_ELSEWHERE = re.compile(r"(?:^|[\s,])(?:[a-z]+:)?//", re.IGNORECASE)
_IN_CSS = re.compile(r"(?:url\(\s*['\"]?|@import\s+['\"])((?:[a-z]+:)?//[^'\")\s]+)", re.IGNORECASE)


class _Page(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []
        self._in_style = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        self._in_style = tag == "style"
        self.found += _IN_CSS.findall(given.get("style", ""))
        if tag == "link" and set(given.get("rel", "").lower().split()) <= NOT_LOADED and given.get("rel"):
            return
        for name in LOADING.get(tag, ()):
            if _ELSEWHERE.search(given.get(name, "")):
                self.found.append(given[name])

    def handle_endtag(self, tag: str) -> None:
        self._in_style = self._in_style and tag != "style"

    def handle_data(self, data: str) -> None:
        if self._in_style:
            self.found += _IN_CSS.findall(data)


def outside_requests(text: str, *, suffix: str) -> list[str]:
    """Addresses elsewhere that a browser would load for a page (``.html``) or a style sheet (``.css``)."""
    if suffix == ".css":
        return _IN_CSS.findall(text)
    page = _Page()
    page.feed(text)
    page.close()
    return page.found


def scan(site: Path) -> Iterator[str]:
    """Every such address below a folder, with the file that holds it."""
    for file in sorted(site.rglob("*")):
        if file.suffix in (".html", ".css"):
            for address in outside_requests(file.read_text(encoding="utf-8"), suffix=file.suffix):
                yield f"{file.relative_to(site)} would load {address}; keep a copy in docs/ instead"


def main() -> int:
    """The number of findings, at most 1, as exit code."""
    site = Path(sys.argv[1])
    if not (site / "index.html").is_file():
        print(f"{site} holds no built site; run make docs", file=sys.stderr)
        return 2
    found = list(scan(site))
    print("\n".join(found), file=sys.stderr) if found else None
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
