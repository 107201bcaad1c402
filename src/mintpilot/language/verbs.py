"""What instructions are made of besides names: verbs and their companions, as phrases. Tables only."""

from __future__ import annotations

from mintpilot.language.lexicon import ANYBODY, word_set


def _phrases(text: str) -> tuple[str, ...]:
    """Phrases that are written with ``|`` between them."""
    return tuple(" ".join(phrase.split()) for phrase in text.split("|"))


SLOWLY = _phrases("""slowly | carefully | gently | slowly and carefully""")
GO = _phrases(
    """go | fly | move | head | travel | proceed | navigate | come | get | return | continue | hover | make your way |
    fly yourself"""
)
TO = _phrases("""to | towards | toward | over to | up to | back to | over""")
FIND = _phrases(
    """find | locate | search for | look for | seek | track down | go and find | go find | go look for | go and look
    for | have a look for | go and search for | go and locate | we are looking for |
    we're looking for | i am looking for"""
)
VISIT = _phrases(
    """approach | visit | reach | check | check on | inspect | examine | look at | have a look at | take a look at | go
    and check | go and inspect | head for"""
)
LOOK_INTO = _phrases(
    """look into | look in | look inside | peek into | check inside | have a look into | take a look into | have a look
    in | look through | go and look into | search | scan | sweep | check | inspect | examine | explore | go and
    check | go and search | visit | search through | have a look inside"""
)
PICK = _phrases("""pick up | grab | take | collect | fetch | get | retrieve | lift | lift up | go and get | pick""")
BRING = _phrases(
    """bring | take | carry | deliver | transport | give | hand | get | fetch | return | move | hand over | fly"""
)
DROP = _phrases("""drop | put | place | leave | set down | put down | drop off | unload | lay""")
AT = _phrases("""at | next to | near | by | beside | in front of | to""")
UPON = _phrases("""on | onto | in | into | on top of""")
STARTS = _phrases(
    """the start | the start position | the starting point | the home position | base | the base | launch | the launch
    point | the take off point | start | home | the pad | where you started"""
)
HOME = ("home", "back", "back home", *(f"{back}to {start}" for back in ("", "back ") for start in STARTS))
NOBODY = _phrases("""nobody | no one | nobody else | no one else""")
CHECK = _phrases("""check | see | find out | look | determine | verify""")
ENSURE = _phrases("""make sure | make sure that | make certain | ensure | ensure that | check that | see that""")
STATES = _phrases(
    """hurt | injured | wounded | trapped | in danger | left behind | in need of help | unconscious | stuck | in
    trouble"""
)
HELP = _phrases(
    """who needs help | needing help | in need of help | needs help | who need help | need help | who is hurt | who is
    injured | who is trapped | who might be hurt | who may be hurt | who are hurt | who are injured | who is wounded"""
)
SEEN = _phrases("""what you see | what you can see | what is there | what's there | what is visible | the situation""")
WISH = _phrases("""if possible | if you can | where possible | when possible | wherever possible | if it is possible""")
ENTER = _phrases(
    """go through | fly through | pass through | go into | fly into | enter | cross | go near | fly near | come near |
    get near | get close to | go close to | fly close to | go in | come close to"""
)
ENTERING = _phrases(
    """going through | flying through | passing through | going into | flying into | entering | crossing | going near |
    flying near | getting near | coming near"""
)
METRES = _phrases("""m | metre | metres | meter | meters""")
ADVERBS = _phrases("straight | directly | over | up | back | on | out")
LAUNCH = _phrases("take off | launch | lift off")
RISE = tuple(f"{verb} {up}" for verb in ("go", "fly", "move", "climb", "rise") for up in ("up", "down")) + _phrases(
    "ascend | climb | rise | descend"
)
LOOKS = _phrases("what do you see | what can you see | what is there")
TELL = _phrases("report | tell me | describe | say | tell us | and report")
AROUND = _phrases("at | near | by | next to | around")
HOW_MANY = _phrases("how many | tell me how many | report how many | find out how many | i need to know how many")
ARE = _phrases("are there | there are | do you see | can you see | you see | are")
HOLD = _phrases("wait | hover | stay | hold | remain | hold position")
OVER = _phrases("at | over | above | near | next to | by")
HERE = _phrases("here | inside | in here")
SCAN = _phrases("search | scan | look through | explore | sweep")
THERE_IS = _phrases("there is | there's")
BY = _phrases("behind | near | next to | at | by")
AVOID = _phrases("avoid | avoiding | bypass | skip | skipping")
NEVER = _phrases("do not | don't | never")
STAY = _phrases("stay | staying | keep | keeping | steer | steering | remain")
OUT_OF = _phrases("out of | away from | clear of | outside of | outside | off")
ALWAYS = _phrases("always | at all times | all the time | the whole time | for the whole flight")
WITHIN = _phrases("within | inside | in | inside of")
BEFORE = _phrases("before you | until you | before | until")
AT_END = _phrases("at the end | in the end | at the very end")
OFF_LIMITS = _phrases("is off limits | are off limits | is forbidden | are forbidden | must be avoided")
SOMEBODY = tuple(
    f"{there}{who}{other}"
    for there in ("", "there is ", "there's ", "there are ")
    for who in (*sorted(ANYBODY - {"everyone", "everybody"}), "any people", "people", "any person")
    for other in ("", " else")
)
EVERYBODY = (*SOMEBODY, "everyone", "everybody", "everyone else", "everybody else")
PICTURE = tuple(
    f"{verb} {me}{one}{picture}"
    for verb in ("take", "make", "get", "snap", "shoot", "show", "send", "we need", "i need")
    for me in ("", "me ", "us ")
    for one in ("a ", "", "some ")
    for picture in _phrases("picture | photo | photograph | image | snapshot | pictures | photos | photographs")
)
NUMBERS = {"one": 1.0, "two": 2.0, "three": 3.0, "four": 4.0, "five": 5.0, "ten": 10.0, "a": 1.0, "half a": 0.5}
SECONDS = {"s": 1.0, "sec": 1.0, "second": 1.0, "seconds": 1.0, "min": 60.0, "minute": 60.0, "minutes": 60.0}
JOINTS = _phrases(
    """, | and | then | finally | next | also | afterwards | after that | after this | later | lastly | when you are
    done | when done | once done | once you are done | as well"""
)
POLITE = _phrases(
    """please | could you | can you | would you | will you | i need you to | i want you to | i would like you to | i'd
    like you to | let's | let us | ok | okay | so | drone | hey | hello | your task is to | kindly | try to | your
    mission is to | mission | task | make sure to | be sure to | you should | you must | we need you to | go and |
    make sure you | be sure you"""
)
AFTERTHOUGHTS = _phrases("""please | too | as well | thanks | thank you | , in that order | in that order""")
_GOING = word_set(
    """going flying visiting finding checking picking bringing taking looking searching carrying moving reaching
    photographing counting delivering inspecting heading"""
)
GERUNDS = {word: {"moving": "move", "taking": "take"}.get(word, word.removesuffix("ing")) for word in _GOING}
"""A verb in -ing → the plain verb."""
NEAR = _phrases(
    """next to | close to | in front of | on top of | beside | near | by | at | behind | under | underneath | above |
    on | opposite"""
)
THAT_IS = _phrases(
    """that is | which is | who is | that's | who's | that are | who are | lying | standing | located | sitting | which
    lies | that lies"""
)
HOLDING = _phrases("""that contains | that holds | which contains | which holds | containing | holding | with""")
DRESSED = _phrases("""wearing | dressed in | in""")
SIDES = tuple(
    f"{to} {the} {side}{hand}"
    for to in ("on", "to", "at")
    for the in ("the", "your", "its")
    for side in ("left", "right")
    for hand in (" hand side", "-hand side", " side", "")
)
