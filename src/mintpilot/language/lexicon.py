"""The closed vocabulary of instructions. Tables only.

Words of a map that is given are known besides. Any other word is refused by name, but for the one noun that follows its
article and known adjectives directly: what is not on the map is found out there.
"""

from __future__ import annotations

from mintpilot.core.observation import RegionKind


def word_set(text: str) -> frozenset[str]:
    """The words of a text."""
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

PLAIN_ADJECTIVES = word_set(
    "old new young heavy light thick thin short wide narrow open closed locked broken empty full fallen overturned "
    "burning smoking leaking collapsed flooded "
    "elderly spare thermal missing lost abandoned main front back rear north south east west northern southern eastern "
    "western upper lower middle dark bright rusty dirty clean wet dry warm cold hot steel iron glass paper leather "
    "rubber marked restricted sealed damaged first-aid emergency far"
)
"""Adjectives that say something which no attribute has a name for: they rule nothing out."""

PEOPLE = word_set(
    "person people victim victims survivor survivors casualty casualties patient patients human humans man woman child "
    "men women children worker workers colleague firefighter firefighters guard guards guy guys lady girl boy kid kids "
    "hiker climber skier miner diver driver swimmer soldier tourist visitor pedestrian crowd baby"
)
"""Nouns that mean the label ``person``."""
ANYBODY = word_set("anyone anybody someone somebody everyone everybody")
"""Whoever is there, not a certain person."""
ROLES = word_set("nurse medic doctor paramedic fireman caretaker operator officer mechanic pilot rescuer robot")
"""Nouns that mean somebody who is called by what they do; on a map they are labels of their own."""

ROOMS = word_set("room rooms chamber chambers")
ROOM_KINDS = word_set(
    "kitchen bathroom workshop canteen bedroom classroom storeroom laboratory lab toilet cellar basement office garage "
    "attic lobby closet pantry library laundry foyer cafeteria restroom studio offices bathrooms bedrooms cupboard"
)
"""Rooms that are called by what they are for."""
ENCLOSED = word_set("tent shed hut house cabin barn stairwell lift gym corridor hallway")
"""Things that are looked into like rooms."""
ROOM_WORDS = word_set("storage server meeting living dining control engine boiler waiting conference equipment guest")
"""What stands before ``room``."""

VENUES = word_set("warehouse building hall hangar house factory area zone place site depot scene store storehouse")
"""Where it all happens: ``in the burning warehouse`` tells nothing apart."""
CLOTHES = word_set("helmet mask jacket shirt vest hat coat glasses gloves uniform")
SURFACES = word_set("table desk shelf rack counter floor ground bench chair bed sofa stand roof pallet")
"""From these a thing is taken that stands on them; out of anything else, what it holds."""

ANIMALS = word_set("dog cat horse cow sheep bird goat pig donkey rabbit")
"""Gone to and photographed like things, and never carried or laid upon."""

NOUNS = word_set(
    # containers and goods
    "box package parcel container carton crate case bin barrel drum cask bag backpack suitcase basket bucket can jar "
    "bottle cup mug glass bowl plate pallet tank cylinder drawer cabinet locker pouch sack trolley cart tray envelope "
    # furniture and fittings
    "table desk chair shelf rack counter sofa couch bed bench lamp door gate doorway window stairs staircase stairwell "
    "ladder pillar column post wall floor ceiling roof fridge oven microwave sink stove dishwasher television screen "
    "computer laptop tablet printer sign poster clock mirror carpet plant fence fountain ramp platform corridor "
    # tools and supplies
    "tool toolbox hammer wrench screwdriver drill saw rope cable hose pipe valve pump generator motor machine battery "
    "charger torch flashlight lantern radio phone camera helmet mask glove gloves vest jacket shirt hat coat shoe "
    "extinguisher fire flames smoke kit medicine medication bandage blanket stretcher splint syringe defibrillator "
    "beacon sensor probe medkit lifebuoy tourniquet shovel axe crowbar wheelchair crutch gauge meter insulin oxygen "
    "inhaler vaccine serum tarp megaphone walkie-talkie drum ring life gas pressure fuse sample "
    "flare whistle map key keys wallet glasses book pen pencil paper folder document letter card ball toy umbrella "
    "towel "
    # food and drink
    "water food apple banana orange lemon pear peach tomato potato carrot bread sandwich pizza cake cookie chocolate "
    "chips snack drink juice milk coffee tea soda coke cola beer egg cheese rice sponge soap spoon fork knife "
    # vehicles and outdoors
    "car truck van bus bicycle bike motorcycle ambulance forklift tractor excavator crane boat ship plane helicopter "
    "tree bush rock stone river lake bridge road path tower antenna mast chimney house tent hut shed "
    "cabin barn lift gym hallway silo ridge cliff pier pole "
    "flag cone barrier hydrant pylon statue field garden yard street corner entrance exit dock loading parking point "
    "assembly panel switch station landing control end "
) | ANIMALS  # fmt: skip
"""Nouns, and what stands before nouns in compounds: ``fire extinguisher``, ``loading dock``."""

FIXED = word_set(
    "door gate doorway window wall floor ceiling roof stairs staircase stairwell pillar column corridor "
    "platform ramp road  path bridge tower antenna mast chimney house tent hut shed cabin barn lift gym "
    "hallway silo ridge cliff pier river lake field "
    "garden yard street corner entrance  exit dock point station fountain fence statue elevator car truck van "
    "bus ambulance forklift tractor excavator crane  boat ship plane helicopter tree smoke fire flames end way "
    "route lift line side "
) | VENUES  # fmt: skip
"""What nobody carries, so that taking it means something else: ``take the stairs``."""
OWN_PARTS = word_set("battery motor camera sensor propeller rotor")
"""What the drone has itself: to check it is no flight to it."""
LIGHT_VERBS = word_set("take get give put place leave make hand move return drop have count check")
"""Verbs that make another meaning of a noun that is not known: ``take a selfie``."""

DETERMINERS = word_set("the a an this that these those my our your his her its their some")
EVERY = word_set("every each all")

IRREGULAR = {
    "shelves": "shelf", "boxes": "box", "crates": "crate", "people": "person", "men": "man", "women": "woman",
    "children": "child", "knives": "knife", "stairs": "stairs", "glasses": "glasses", "gloves": "gloves",
    "flames": "flames", "offices": "office", "keys": "key", "branches": "branch",
}  # fmt: skip
"""Plurals that do not only add an s, and nouns that are none."""

AVOIDED: dict[str, RegionKind] = {
    **dict.fromkeys(("smoke", "fume", "fumes", "cloud"), RegionKind.SMOKE),
    **dict.fromkeys(("door", "doorway"), RegionKind.DOOR),
    **dict.fromkeys(("area", "zone"), RegionKind.AREA),
}
"""What a person may ask to stay out of → kind of region."""

GRAMMAR = word_set(
    """go fly move head travel proceed navigate come get return walk hover continue to over straight directly back up
    on towards toward above near by at inside into in out off from and then next finally also later afterwards
    find locate search look for seek track down spot check inspect examine scan sweep visit approach reach see
    whether is are there was be been does do did has have pick grab take collect fetch retrieve lift bring deliver
    transport give hand drop put place leave set release onto beside behind under with wearing containing wait
    stay hold remain half launch rtl home base start count how photograph snap picture photo image shoot report
    describe say what can possible avoid avoiding skip bypass keep keeping staying steer clear away of through
    going flying passing entering enter pass limits height altitude metre metres meter meters slowly carefully
    gently please could would will need want like should must it them him her there this that these those which
    who whom whose where while until than so very too first last open turn rotate set make try use let lets its
    his your yours mine ours am were being having had may might shall"""
)
"""Words with a part in the grammar: no unknown noun is any of them."""

_REASONS = {
    "conditions are not understood": "if unless until till when whenever while otherwise as because whether once",
    "exceptions are not understood": "except only but apart besides instead rather excluding other than just",
    "it names a choice: say which one is meant": "or either neither nor whichever any",
    "it points at something that was not said here": "same previous former latter remaining wrong correct",
    "negations are only understood for what is to be stayed out of": (
        "not no never none nothing nobody don't doesn't isn't aren't won't can't cannot didn't wasn't "
        "shouldn't mustn't ain't"
    ),
    "only what is to be stayed out of is said with it; say what becomes of the thing, as in 'put it on the table'": (
        "without"
    ),
    "repetitions are not understood": "again twice thrice times repeat repeatedly once-more another",
    "time limits and times are not understood": (
        "second seconds minute minutes hour hours within before after less quickly fast faster hurry soon now "
        "immediately"
    ),
    "numbers of things are not understood: name one thing, or all of them": (
        "one two three four five six seven eight nine ten both couple few several many half most least second third"
    ),
    "what this means is not known here: name the place or the thing": "me us here you wherever whoever whatever",
    "landing on request is not among what the drone does": "land",
    "that is not among what the drone does": (
        "close push pull extinguish spray film follow shoot attack ram hit crash break throw repair call talk "
        "drive dig ask lead guide"
    ),
}
REASONS = {word: reason for reason, words in _REASONS.items() for word in words.split()}
"""Word → why a clause that holds it, and is not understood, is refused."""


def singular(noun: str) -> str:
    """The noun in the singular, as far as a few rules go."""
    if noun in IRREGULAR:
        return IRREGULAR[noun]
    if noun.endswith(("sses", "shes", "ches", "xes")):
        return noun[:-2]
    if noun.endswith("ies") and len(noun) > 4:
        return f"{noun[:-3]}y"
    return noun[:-1] if noun.endswith("s") and not noun.endswith(("ss", "us")) else noun
