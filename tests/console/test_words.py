"""The page's own words: the same in every language."""

from __future__ import annotations

import re
from importlib.resources import files

TEXT = files("mintpilot.console").joinpath("static", "words.js").read_text("utf-8")


def languages() -> dict[str, dict[str, str]]:
    parts = re.split(r"^  (en|de|fr|es): \{$", TEXT, flags=re.MULTILINE)[1:]
    pairs = zip(parts[::2], parts[1::2], strict=True)
    return {
        name: dict(re.findall(r'"?([\w-]+)"?: "((?:[^"\\]|\\.)*)"', body.split("\n  },")[0])) for name, body in pairs
    }


def test_every_language_says_everything_with_the_same_places():
    said = languages()
    assert sorted(said) == ["de", "en", "es", "fr"]
    for words in said.values():
        assert words.keys() == said["en"].keys()
        assert all(words.values())
        for key, text in words.items():
            assert sorted(re.findall(r"\{\d?\}", text)) == sorted(re.findall(r"\{\d?\}", said["en"][key])), key


def test_the_page_asks_for_no_word_that_is_missing():
    static = files("mintpilot.console").joinpath("static")
    used = {key for file in static.iterdir() if file.name.endswith(".js")
            for key in re.findall(r'say\("([\w-]+)"', file.read_text("utf-8"))}  # fmt: skip
    used |= set(re.findall(r'data-word="([\w-]+)"', static.joinpath("index.html").read_text("utf-8")))
    assert used - languages()["en"].keys() == set()
