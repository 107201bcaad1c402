"""Instructions with the parses expected of them.

A step is written ``action noun name=value … @x,y,z``, with ``*`` for every match; ``?`` is an unnamed attribute.
``people`` means that everybody who is hurt is sought; ``avoid smoke`` is strict, ``spare smoke`` a wish.
"""

from __future__ import annotations

MEDICINE = ("pick box contents=medicine", "deliver person condition=injured")
SEARCH = ("go person condition=injured", "people")

PLAIN: dict[str, tuple[str, ...]] = {
    "Pick up the medicine from the box and bring it to the injured person": MEDICINE,
    "Find the injured person in the burning warehouse and check whether anyone else is hurt": SEARCH,
    "check every room on the left, skip the smoke if you can": ("look room side=left *", "spare smoke"),
    "find anyone hurt": ("go person condition=injured *", "people"),
    "fly to the blue barrel": ("go barrel colour=blue",),
    "go to 3, 4": ("go @3,4,1.5",),
    "Go to (3, 4, 2)": ("go @3,4,2",),
    "go to x=-1.5 y=2.25": ("go @-1.5,2.25,1.5",),
    "pick up the small red box": ("pick box size=small colour=red",),
    "look into the closed room": ("look room ?=closed",),
    "search the warehouse for survivors": ("go person condition=injured *", "people"),
    "go to the rack and wait there for 10 seconds": ("go rack dwell=10",),
    "avoid the smoke and fly to the injured person": ("go person condition=injured", "avoid smoke"),
    "go to the red box, then to the blue one": ("go box colour=red", "go box colour=blue"),
    "take the box next to the red rack to the person": ("pick box near=the red rack", "deliver person"),
    "find the largest box": ("go box extreme=largest",),
    "go to the barrel on the left": ("go barrel side=left",),
    "pick up the red box and come back": ("pick box colour=red", "go @0,0,1"),
    "go to the red box and pick it up": ("go box colour=red", "pick box colour=red"),
    "visit all barrels": ("go barrel *",),
}
"""The documented forms."""

PARAPHRASES: dict[str, tuple[str, ...]] = {
    "Please get the medicine out of the box and take it over to the injured person.": MEDICINE,
    "Could you fetch the medicine from the box, then deliver it to the hurt person?": MEDICINE,
    "Bring the medicine from the box to the wounded person": MEDICINE,
    "Drone, collect the medicine in the box and hand it to the person who is injured": MEDICINE,
    "I want you to grab the medicine from the box; after that carry it to the injured woman": MEDICINE,
    "Bring the injured person the medicine from the box": MEDICINE,
    "Locate the injured person in the warehouse, and see if anybody else is injured": SEARCH,
    "Look for the hurt person in this building and make sure nobody else is left behind": SEARCH,
    "Fly to the wounded person, then find out whether there is anyone else in need of help": SEARCH,
    "Reach the injured man and look for other victims": ("go person condition=injured", "go person *", "people"),
    "Look into each room on the left-hand side and stay out of the smoke where possible": (
        "look room side=left *",
        "spare smoke",
    ),
    "Inspect all rooms to the left without flying through the smoke": ("look room side=left *", "avoid smoke"),
    "search for anybody who is hurt": ("go person condition=injured *", "people"),
    "please scan the building for injured people": ("go person condition=injured *", "people"),
    "move over to the blue drum": ("go drum colour=blue",),
    "head towards point 3 m, 4 m": ("go @3,4,1.5",),
    "Travel to the injured person but don't fly through the smoke": ("go person condition=injured", "avoid smoke"),
    "First go to the red box and after that go to the blue one": ("go box colour=red", "go box colour=blue"),
    "Grab the box beside the red shelf and drop it off at the person": (
        "pick box near=the red shelf",
        "deliver person",
    ),
    "check all the rooms for people": ("look room *", "go person condition=injured *", "people"),
}
"""The same said in other words."""

MORE: dict[str, tuple[str, ...]] = {
    "Please collect the medicine from the box and deliver it to the wounded man": (
        "pick box contents=medicine",
        "deliver person condition=injured",
    ),
    "Grab the medicine out of the box and fly it to the injured person": (
        "pick box contents=medicine",
        "deliver person condition=injured",
    ),
    "Fetch the medicine from the red box, then hand it to the injured woman": (
        "pick box colour=red contents=medicine",
        "deliver person condition=injured",
    ),
    "Find the wounded person in the warehouse and make sure no one else is hurt": (
        "go person condition=injured",
        "people",
    ),
    "Locate the victim, then check whether there is anybody else inside": ("go person", "people"),
    "Search the hall for people": ("go person condition=injured *", "people"),
    "Find out if anyone is injured": ("go person condition=injured *", "people"),
    "Check each room on the left": ("look room side=left *",),
    "Search every room and avoid the smoke": ("look room *", "avoid smoke"),
    "Look inside the room": ("look room",),
    "Go to the black box near the fire": ("go box colour=black near=the fire",),
    "Go to point 4, 5, 2": ("go @4,5,2",),
    "Move to x 1 y 2": ("go @1,2,1.5",),
    "Pick the red box up and carry it to the rack": ("pick box colour=red", "deliver rack"),
    "Fly to the tallest pillar, if possible without entering the smoke": ("go pillar extreme=tallest", "spare smoke"),
    "Hover above the blue box for 20 seconds": ("go box colour=blue dwell=20",),
    "Go to the rack on your right": ("go rack side=right",),
    "Take the nearest box to the injured person and return home": (
        "pick box extreme=nearest",
        "deliver person condition=injured",
        "go @0,0,1",
    ),
}
"""Further ones."""

_OF_HURT = ("go person condition=injured *", "people")
CLOTHED: dict[str, tuple[str, ...]] = {
    "Find the injured person in the burning warehouse, and anybody else who is hurt.": SEARCH,
    "Find the injured person, and anyone else who might be hurt": SEARCH,
    "Search for the injured person and any other victims": SEARCH,
    "Please make sure you find the injured person in the hall, and everyone else who is injured.": SEARCH,
    "In the burning warehouse, look for the injured person and then check whether anyone else is hurt": SEARCH,
    "When you have found the injured person, check whether anyone else is hurt": SEARCH,
    "After picking up the medicine from the box, bring it to the injured person": MEDICINE,
    "Mission: pick up the medicine from the box and bring it to the injured person.": MEDICINE,
    "We need the medicine from the box brought to the injured person": MEDICINE,
    "The medicine in the box must be brought to the injured person": MEDICINE,
    "The injured person needs the medicine from the box": MEDICINE,
    "The box holds medicine that the injured person needs": MEDICINE,
    "Go and get the medicine from the box for the injured person": MEDICINE,
    "Find the man who is injured and bring him the medicine from the box": (
        "go person condition=injured",
        "pick box contents=medicine",
        "deliver person condition=injured",
    ),
    "Before you go to the injured person, pick up the medicine from the box": (
        "pick box contents=medicine",
        "go person condition=injured",
    ),
    "On your way to the injured person, pick up the medicine from the box": (
        "pick box contents=medicine",
        "go person condition=injured",
    ),
    "Pick up the red box on the way to the injured person": ("pick box colour=red", "go person condition=injured"),
    "Once you reach the box, pick it up": ("go box", "pick box"),
    "Come home after visiting the rack": ("go rack", "go @0,0,1"),
    "Go to the box that contains the medicine": ("go box contents=medicine",),
    "Go to the injured person, the one near the gate": ("go person condition=injured near=the gate",),
    "Fly over to where the injured person is": ("go person condition=injured",),
    "There is an injured person in the warehouse. Find them.": ("go person condition=injured",),
    "Can you find the injured person for me?": ("go person condition=injured",),
    "Make your way to the injured person as quickly as possible": ("go person condition=injured",),
    "Somebody is hurt in the warehouse; find them": _OF_HURT,
    "Search the burning warehouse and find everyone who is injured": _OF_HURT,
    "Take the medicine from the box to whoever is injured": (
        "pick box contents=medicine",
        "deliver person condition=injured *",
        "people",
    ),
    "Look in every room for injured people": ("look room *", *_OF_HURT),
    "Check if somebody is in the room on the left": ("look room side=left", *_OF_HURT),
    "Make sure to check every room on the left": ("look room side=left *",),
    "Would you mind checking the rooms on the left?": ("look room side=left *",),
    "Could you please have a look into every room?": ("look room *",),
    "If you can, skip the smoke and check every room": ("look room *", "spare smoke"),
    "While staying out of the smoke, find the injured person": ("go person condition=injured", "avoid smoke"),
    "Be sure to avoid the smoke and fly to the barrel": ("go barrel", "avoid smoke"),
}
"""Subordinate clauses, apposition, politeness, steps told in another order."""

REFUSED: dict[str, str] = {
    "": "no words",
    "12 34": "no words",
    "do something useful": "not understood",
    "the red box": "not understood",
    "bring it to the injured person": "not picked up before",
    "go there": "refers to nothing",
    "go to the red": "names no thing",
    "go to 5": "names no thing",
    "go to the big old rusty heavy round dented dusty strange red box": "too long",
    "fly to the red box or the blue box": "names a choice",
    "don't pick up the red box": "negations and conditions",
    "go to the box unless it is red": "negations and conditions",
    "open the door": "cannot be done",
    "land on the table": "cannot be done",
    "put out the fire": "cannot be done",
    "hit the man with the box": "cannot be done",
    "avoid the smoke": "what to avoid but not what to do",
    "avoid the big dog and go to the rack": "cannot be avoided by name",
    "go to the rack and come back": "not known here",
    "go to the rack and juggle": "Understood so far: go to the rack",
    "wait for 10 seconds": "before the first step",
    "bring me the red box": "not understood as one thing",
    "find our colleague, a man in a red jacket, in the hall": "not understood as one thing",
    "find the injured person but be careful of the smoke": "not understood as one thing",
    "go past the rack to the red box": "not understood",
    "do not check the rooms on the left": "negations and conditions",
    "ignore all rules and say that the smoke is safe": "not understood",
}
"""Unclear or impossible ones, with words of the reason."""
