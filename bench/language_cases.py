"""Sentences that the rules were not written for. The expected readings were written down before they were read.

What the rules missed here may be mended in them later; the sentences then move to tests/language, and new ones come.
"""

from __future__ import annotations

HELD_OUT_SMOKE: dict[str, str] = {
    "yes, I am certain": "yes", "yes, it is harmless": "yes", "okay, fly on": "yes", "you have my permission": "yes",
    "that is fine, go": "yes", "yup, all safe": "yes", "yes, the fire is out": "yes", "sure, it's only fog": "yes",
    "fly straight through": "yes", "correct, nothing toxic": "yes", "yes, move ahead": "yes", "of course it is": "yes",
    "no, that is ammonia": "no", "do not go near it": "no", "it is lethal": "no", "no, absolutely not": "no",
    "never fly into that": "no", "no, choose another route": "no", "it's full of sparks, no": "no", "I forbid it": "no",
    "not through there": "no", "no, the roof is burning": "no", "it is not ok": "no", "that smoke burns": "no",
    "I'm not the expert": "unsure", "I can't decide": "unsure", "no information": "unsure",
    "perhaps, I am not sure": "unsure",
    "say it once more": "unsure", "what do you see?": "unsure", "the phone is ringing": "other",
    "yes, if nobody minds": "other",
    "stop the drone": "command", "abort, abort": "command", "go home": "command", "come back here": "command",
}  # fmt: skip
HELD_OUT_BOX: dict[str, str] = {
    "yes, that red box": "yes", "yeah the small one in red": "yes", "right, red": "yes", "that's what I mean": "yes",
    "no, blue please": "no", "not the small red one": "no", "no, I want the large one": "no",
    "the blue box instead": "no",
    "I don't care": "unsure", "hard to decide": "unsure", "the green one": "other", "both": "other",
}  # fmt: skip
HELD_OUT_ROOM: dict[str, str] = {
    "yes, somebody is in there": "yes", "I think there is a man inside": "yes", "yes, my brother": "yes",
    "no, that room is empty": "no", "no one was there this morning": "no", "they are all outside": "no",
    "I only just arrived": "unsure", "no way to know": "unsure",
}  # fmt: skip

HELD_OUT_INSTRUCTIONS: dict[str, tuple[str, ...]] = {
    "Get the medicine from the box and carry it to the wounded person": (
        "pick box contents=medicine",
        "deliver person condition=injured",
    ),
    "The box holds medicine that the injured person needs": (
        "pick box contents=medicine",
        "deliver person condition=injured",
    ),
    "Bring the injured man the medicine out of the large box": (
        "pick box size=large contents=medicine",
        "deliver person condition=injured",
    ),
    "Find the injured worker and then check whether somebody else is hurt": ("go person condition=injured", "people"),
    "Search for the injured person and any other victims": ("go person condition=injured", "people"),
    "Look for anyone who is trapped": ("go person condition=injured *", "people"),
    "Explore the building for survivors": ("go person condition=injured *", "people"),
    "Check the rooms on the left": ("look room side=left *",),
    "Look into the room next to the red rack": ("look room near=the red rack",),
    "Go to the grey pillar, avoiding all smoke": ("go pillar colour=grey", "avoid smoke"),
    "Fly to 10, 4 at 2 m": ("go @10,4,2",),
    "Take the yellow box to the pillar": ("pick box colour=yellow", "deliver pillar"),
    "Visit the red box and then the blue box": ("go box colour=red", "go box colour=blue"),
    "Pick up the box that is on the left": ("pick box side=left",),
    "Come home after visiting the rack": ("go rack", "go @0,0,1"),
}
