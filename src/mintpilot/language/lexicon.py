"""The words of the documented instruction language. Tables only."""

from __future__ import annotations

from mintpilot.core.observation import RegionKind


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


ADJECTIVES: dict[str, tuple[str, str]] = {
    **{
        word: ("colour", word)
        for word in (
            "red", "orange", "yellow", "green", "blue", "purple", "violet", "pink", "brown", "black", "white", "grey",
            "golden", "silver",
        )
    },
    "gray": ("colour", "grey"),
    **dict.fromkeys(("small", "little", "tiny"), ("size", "small")),
    **dict.fromkeys(("large", "big", "huge"), ("size", "large")),
    "medium": ("size", "medium"),
    "tall": ("height", "tall"),
    "round": ("shape", "spherical"),
    "spherical": ("shape", "spherical"),
    "cylindrical": ("shape", "cylindrical"),
    "square": ("shape", "cubic"),
    "cubic": ("shape", "cubic"),
    "flat": ("shape", "flat"),
    "long": ("shape", "long"),
    **dict.fromkeys(("injured", "hurt", "wounded", "trapped", "unconscious"), ("condition", "injured")),
    **{word: ("material", word) for word in ("wooden", "metal", "plastic", "cardboard")},
    **{word: ("pattern", word) for word in ("striped", "dotted", "checked")},
    "nearest": ("extreme", "nearest"),
    "closest": ("extreme", "nearest"),
    "farthest": ("extreme", "farthest"),
    "furthest": ("extreme", "farthest"),
    "largest": ("extreme", "largest"),
    "biggest": ("extreme", "largest"),
    "smallest": ("extreme", "smallest"),
    "tallest": ("extreme", "tallest"),
    "highest": ("extreme", "highest"),
    "lowest": ("extreme", "lowest"),
    "leftmost": ("extreme", "leftmost"),
    "rightmost": ("extreme", "rightmost"),
    "left": ("side", "left"),
    "right": ("side", "right"),
}  # fmt: skip
"""Word → name and value of the attribute that it says."""

PEOPLE = _words(
    "person people victim victims survivor survivors casualty casualties patient patients human humans man woman child "
    "men women children worker workers colleague firefighter guard anyone anybody someone somebody everyone everybody "
    "guy guys lady girl boy kid kids"
)
"""Nouns that mean the label ``person``."""

ROLES = _words("nurse medic doctor paramedic fireman caretaker driver operator officer mechanic")
"""Nouns that mean people, who are called by what they do."""

ANYBODY = _words("anyone anybody someone somebody everyone everybody people survivors victims casualties")
"""Nouns that mean whoever is there, not a certain person."""

ROOMS = _words("room rooms chamber chambers office offices")

ROOM_KINDS = _words(
    "kitchen bathroom workshop canteen bedroom classroom storeroom laboratory lab toilet cellar basement"
)
"""Rooms that are called by what they are for; which one it is must be asked."""

PRONOUNS = _words("it them this that him her there")

PERSONAL = _words("him her")
"""Of these, the ones that mean a person."""

DETERMINERS = _words("the a an this that these those my our his her their some any two three four five six")

EVERY = _words("every each all both")

VENUES = _words("warehouse building hall hangar house factory area zone place site depot scene store storehouse")
"""Where it all happens: ``in the burning warehouse`` tells nothing apart."""

IRREGULAR = {"shelves": "shelf", "boxes": "box", "crates": "crate", "people": "person", "men": "man", "women": "woman"}
"""Plurals that do not only add an s."""

MENDED = _words("the and then please avoid without through person injured wounded everyone anyone smoke")
"""Words that are read with a letter lost or two exchanged: no names of things are made of them."""

AVOIDED: dict[str, RegionKind] = {
    "smoke": RegionKind.SMOKE,
    "fumes": RegionKind.SMOKE,
    "clouds": RegionKind.SMOKE,
    "cloud": RegionKind.SMOKE,
    "door": RegionKind.DOOR,
    "doors": RegionKind.DOOR,
    "doorway": RegionKind.DOOR,
    "marked area": RegionKind.AREA,
    "restricted area": RegionKind.AREA,
    "closed area": RegionKind.AREA,
}
"""What a person may ask to stay out of → kind of region."""

NEVER_TOUCHED = _words("fire flames walls wall racks rack shelves obstacles people everything collisions anything")
"""What no plan flies into anyway, so that asking for it changes nothing."""

FUNCTION_WORDS = _words(
    "for of as that which where who whom whose is are be was were been am me you we i us yourself myself but "
    "so because than while without to from into and or not if needs need wants contains holds has have via "
    "past through they he she it when whether brought taken "
)
"""Words that no name of a thing is made of: where one is left over, the phrase was not understood."""

CANNOT = {
    "land": "landing on request",
    "open": "opening things",
    "close": "closing things",
    "push": "pushing things",
    "pull": "pulling things",
    "extinguish": "putting out fires",
    "put out": "putting out fires",
    "spray": "spraying",
    "photograph": "taking photographs on request",
    "take a photo": "taking photographs on request",
    "take a picture": "taking photographs on request",
    "take photos": "taking photographs on request",
    "take pictures": "taking photographs on request",
    "film": "filming",
    "follow": "following somebody",
    "shoot": "weapons",
    "attack": "harm of any kind",
    "ram": "harm of any kind",
    "hit": "harm of any kind",
    "crash": "harm of any kind",
    "break": "breaking things",
    "throw": "throwing things",
    "repair": "repairs",
    "call": "calling somebody",
    "talk": "talking to somebody",
    "swim": "swimming",
    "drive": "driving",
    "dig": "digging",
}
"""What people ask for and this drone does not do → what that is."""
