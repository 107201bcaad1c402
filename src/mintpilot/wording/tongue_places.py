"""Where things are in a hall, in three more languages. Tables only."""

from __future__ import annotations

import re
from collections.abc import Mapping

PLACES: Mapping[str, Mapping[str, str]] = {
    "de": {
        "in the north-east corner": "in der Nordostecke", "in the north-west corner": "in der Nordwestecke",
        "in the south-east corner": "in der Südostecke", "in the south-west corner": "in der Südwestecke",
        "on the north side": "auf der Nordseite", "on the south side": "auf der Südseite",
        "on the east side": "auf der Ostseite", "on the west side": "auf der Westseite",
        "in the middle of the hall": "in der Hallenmitte",
        "the northern one": "weiter im Norden", "the southern one": "weiter im Süden",
        "the eastern one": "weiter im Osten", "the western one": "weiter im Westen",
        "the northernmost one": "ganz im Norden", "the southernmost one": "ganz im Süden",
        "the easternmost one": "ganz im Osten", "the westernmost one": "ganz im Westen",
    },
    "fr": {
        "in the north-east corner": "dans l'angle nord-est", "in the north-west corner": "dans l'angle nord-ouest",
        "in the south-east corner": "dans l'angle sud-est", "in the south-west corner": "dans l'angle sud-ouest",
        "on the north side": "du côté nord", "on the south side": "du côté sud",
        "on the east side": "du côté est", "on the west side": "du côté ouest",
        "in the middle of the hall": "au milieu du hall",
        "the northern one": "plus au nord", "the southern one": "plus au sud",
        "the eastern one": "plus à l'est", "the western one": "plus à l'ouest",
        "the northernmost one": "tout au nord", "the southernmost one": "tout au sud",
        "the easternmost one": "tout à l'est", "the westernmost one": "tout à l'ouest",
    },
    "es": {
        "in the north-east corner": "en la esquina noreste", "in the north-west corner": "en la esquina noroeste",
        "in the south-east corner": "en la esquina sureste", "in the south-west corner": "en la esquina suroeste",
        "on the north side": "en el lado norte", "on the south side": "en el lado sur",
        "on the east side": "en el lado este", "on the west side": "en el lado oeste",
        "in the middle of the hall": "en el centro de la nave",
        "the northern one": "más al norte", "the southern one": "más al sur",
        "the eastern one": "más al este", "the western one": "más al oeste",
        "the northernmost one": "al extremo norte", "the southernmost one": "al extremo sur",
        "the easternmost one": "al extremo este", "the westernmost one": "al extremo oeste",
    },
}  # fmt: skip
"""Language → place as the map words it → the same."""

_TAIL = re.compile(
    r"^(.*?),? ((?:in|on) the [\w-]+ (?:corner|side|of the hall)|in the middle of the hall|the \w+ one)$"
)


def split_places(english: str) -> tuple[str, list[str]]:
    """What a description names, and the places that follow it: ``the smoke``, [``on the west side``]."""
    places: list[str] = []
    while found := _TAIL.match(english):
        english = found[1]
        places.insert(0, found[2])
    return english, places
