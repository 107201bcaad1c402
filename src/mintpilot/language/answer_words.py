"""What people say when they are asked yes or no. Tables only; the order of the rows is the order of reading."""

from __future__ import annotations

import re
from enum import StrEnum

from mintpilot.core.query import Command


class Sign(StrEnum):
    """What a few words of an answer say."""

    YES = "yes"
    NO = "no"
    UNSURE = "unsure"
    LIKELY = "likely"
    """A yes with a doubt: enough to choose among boxes, not to open a region."""
    UNLIKELY = "unlikely"
    PASSABLE = "passable"
    BLOCKED = "blocked"
    PRESENT = "present"
    ABSENT = "absent"
    CLEAR = "clear"
    """Of smoke: passable. Of a room: empty."""
    NOISE = "noise"
    """Politeness and filling words."""


def _alternatives(text: str) -> list[str]:
    """Splits at the bars that are in no group."""
    parts, depth = [""], 0
    for letter in text:
        depth += (letter == "(") - (letter == ")")
        if letter == "|" and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return parts


def _rows(sign: Sign, *phrases: str) -> list[tuple[re.Pattern[str], Sign]]:
    """One pattern for all the phrases, the longest first."""
    ordered = sorted((p for text in phrases for p in _alternatives(text)), key=len, reverse=True)
    return [(re.compile(rf"(?<![\w'])(?:{'|'.join(ordered)})(?![\w'])"), sign)]


_IT = "(?:it|that|this|the smoke|the way|the path|the area)"
_IS = "(?:is|looks|seems|should be|appears)"
_NOT = "(?:not|never)"
_BAD = "(?:unsafe|dangerous|toxic|poisonous|hazardous|risky|deadly|lethal|blocked|impassable|harmful|thick|hot)"
_VERY = "(?:far |much )?(?:too |very |really |extremely |definitely |certainly |clearly )?"
_TO_FLY = "(?: to (?:fly|go|pass)(?: through)?)?"
_THERE = "(?:there is|there's|there are|i see|i saw|i can see|i heard|i hear|we have)"
_WHO = (
    "(?:(?:two|three|four|five|several|some|many|a few) (?:people|persons|men|women)|one person|a person|person|persons"
    "|people|someone|somebody|a man|a woman|a child|a victim|victims)"
)

_I = "(?:i |we |sorry )?(?:am |are |do |did |can |could |would |will |have |just |really |honestly |simply )*"
_END = r"(?=\s*(?:[,.;!]|$))"

SIGNS: tuple[tuple[re.Pattern[str], Sign], ...] = (
    *_rows(
        Sign.UNSURE,
        f"{_I}(?:not|cannot|hardly) (?:really |quite |exactly |fully )?(?:know|say|tell|remember|recall|see|hear|judge"
        "|understand|on site|there|sure|certain)",
        f"{_I}(?:not|never) (?:checked|looked|seen|been)|(?:have not|had not) (?:checked|looked|seen)",
        "not that (?:i|we) know of|(?:it )?does not matter|do not (?:care|mind|know)|(?:it )?makes no difference",
        "(?:i|we) (?:am|are) not (?:on|at|in|near|there)(?: (?:the )?\\w+)?|(?:i|we) (?:have )?forgot(?:ten)?",
        r"(?:i|we) (?:cannot|could not) \w+|(?:i|we) (?:am|are) not (?:the|a|an) \w+",
        "no (?:information|data|news|signal)",
        f"{_I}no (?:way|means) of (?:knowing|telling)|no way (?:to know|to tell|of knowing|of telling)",
        "(?:could|would) not (?:say|tell|know)(?: you)?|(?:give|get) me a (?:minute|second|moment|sec)",
        "beats me|no memory",
    ),
    *_rows(
        Sign.UNSURE,
        "yes and no|i do not know|not certain|not sure|not so sure|not really sure|unsure|uncertain|no idea",
        "no clue|cannot tell",
        "cannot see|cannot say|hard to say|hard to tell|difficult to say|hard to know|maybe|perhaps|possibly",
        "might be|could be",
        "who knows|it depends|depends|let me check|let me see|let me think|let me look|hold on|hang on",
        "one moment|one second",
        "just a moment|just a second|give me a second|give me a moment|wait a moment|wait a second|wait|pardon",
        "sorry what",
        "say again|say that again|come again|repeat|repeat that|please repeat|repeat the question",
        "what was that",
        f"what{_END}|what (?:did you|do you|is that|was it|are you) \\w+",
        "i did not hear|i did not get that|i did not understand|i do not understand|which one|your choice",
        "your call",
        "you decide|either|i have no opinion|i cannot see it|cannot make it out|need to check|dunno|skip",
        "ask (?:me )?(?:again|later)|ask (?:somebody|someone) else|closer look|tough one|hard one",
        "good question|not my call",
        "fifty fifty|do not ask me|i am blind here",
    ),
    *_rows(
        Sign.YES,
        "green light|permission granted|you have permission|granted|all good|no issue|no issues",
        "no reason not to|i would say yes|you are good|no problem|no problem at all|not a problem|no worries",
        "no doubt|without a doubt|no doubt about it",
        "no objection",
        "no objections|no question|why not|i do not see why not|do not worry|do not hesitate",
        "could not agree more",
    ),
    *_rows(
        Sign.BLOCKED,
        f"(?:{_IT} )?(?:{_IS} )?{_NOT} (?:really |at all |very )?(?:safe|passable|clear|harmless|ok|okay|fine|good)",
    ),
    *_rows(
        Sign.PASSABLE,
        f"(?:{_IT} )?(?:{_IS} )?(?:{_NOT}|non) {_BAD}",
        "no danger(?: there| here| at all)?|(?:there is )?nothing (?:dangerous|toxic|harmful)",
    ),
    *_rows(
        Sign.NO,
        "nein|no go|no entry|find another way|another way|(?:that )?would be a mistake",
        "avoid (?:it|that|that cloud)|none of (?:them|these|those)|(?:it is |that is )?a bad idea|bad idea",
        "wait outside|the other one|another one|a different one|some other one|the other way|denied",
        "permission denied|red light",
        "(?:it |that |this )?(?:would|will|could) (?:kill|destroy|burn|damage|melt|wreck|crash)",
        "i forbid (?:it|that)|i do not want (?:that|it|this)|no way|not at all|not really|not yet",
        "not that one|not this one|not that|not this|not it|of course not",
        "absolutely not|definitely not|certainly not|surely not|better not|rather not|i would not",
        "i do not think so",
        "i do not believe so|do not do (?:that|it)|do not go|do not|you cannot|cannot|you must not|you should not",
        "under no circumstances|by no means|no chance|wrong one|wrong|incorrect",
        "that is not (?:right|true|correct|it)",
        "it is not|is not|that is not|they are not|there is not|none of them|neither|not ok|no thanks",
        "no thank you",
        "stay back|stay away|stay out|stay clear|stay where you are|keep away|keep out|keep clear|back off",
        "go around",
        "fly around|take the detour|take the long way|take the other way|avoid it",
    ),
    *_rows(
        Sign.BLOCKED,
        f"(?:{_IT} )?(?:{_IS} )?{_VERY}{_BAD}",
    ),
    *_rows(
        Sign.PASSABLE,
        f"(?:{_IT} )?(?:{_IS} )?(?:perfectly |completely |quite |totally )?(?:safe|passable|harmless){_TO_FLY}",
        "fly through|fly through it|go through|go through it|you can (?:fly|go|pass)(?: through)?(?: it)?",
        "pass through",
    ),
    *_rows(
        Sign.ABSENT,
        f"(?:{_THERE} )?(?:nobody|no one|no {_WHO}|no people|none|not anyone|not anybody)(?: (?:is |was )?"
        "(?:there|inside|in there|in it|left|home|in|here))*",
        "(?:(?:it|the room|that room|the place|room) (?:is |has been |was )|is )?(?:empty|vacant|deserted|unoccupied)",
        "everybody (?:is |got )?out",
        "everyone (?:is |got )?out|all out",
    ),
    *_rows(
        Sign.PRESENT,
        f"{_THERE} {_WHO}(?: (?:is |was )?(?:there|inside|in there|in it|left|in|here|hurt|trapped))*",
        f"{_WHO} (?:is |was |are |were |went |got |still )*(?:there|inside|in there|in it|trapped|in|hurt|stuck)",
        f"i (?:can |could )?(?:heard|hear|saw|see) (?:{_WHO}|screaming|screams|voices|shouting|crying|knocking)",
        "(?:it is |the room is |is )?(?:not empty|occupied)",
    ),
    *_rows(
        Sign.UNLIKELY,
        "probably not|i guess not|i suppose not|hardly|unlikely|i doubt it|i doubt that|not likely|likely not",
    ),
    *_rows(
        Sign.LIKELY,
        "i think so|i think yes|i think|i believe so|i believe|i guess so|i guess|i suppose so|i suppose",
        "probably|likely|presumably",
        "most likely|more or less|kind of|sort of|i would say so|i would say|as far as i know|i hope so|i hope",
        "should be",
        "seems so|seems to be|looks like it|apparently",
    ),
    *_rows(
        Sign.YES,
        "yes please|yes|yeah|yea|yep|yup|ya|aye|affirmative|affirm|positive|correct|that is correct",
        "that is right|that is true",
        "exactly|precisely|right|sure|sure thing|for sure|of course|absolutely|definitely|certainly|indeed",
        "surely|totally",
        "ok|okay|okey|alright|all right|fine|go ahead|go for it|go on|proceed|do it|do that|do so|please do",
        "roger|roger that",
        "copy that|copy|confirmed|confirm|i confirm|i can confirm|true|that is the one|that is it|that one|this one",
        f"(?:it is|they are|there is|there are|it does|it can|you can|you may|you should|i do){_END}",
        "that is fine|that is ok|by all means|go right ahead|you may proceed|looks fine(?: to me)?",
        "looks good(?: to me)?",
        "good to go",
        "sounds good|you got it|bingo|spot on|continue|carry on|thumbs up|yes sir",
        "yes it is|uh huh|mhm",
        "y",
    ),
    *_rows(Sign.CLEAR, "(?:you are |the way is |it is |the path is |the room is |that room is |all )?clear"),
    *_rows(Sign.NO, "no|nope|nah|na|negative|never|not|false|no sir|nay|n|non|it does not|without|uh uh|none"),
    *_rows(
        Sign.NOISE,
        "please|thank you|thanks|sir|drone|well|oh|um|uh|er|hm|hmm|so|then|now|just|really|very|careful",
        "be careful|slowly|only|still|well then|and|the",
        "a|an|one|box|it|that|this|to me|me|i|you|for|of|is|go|take|take it|i mean|mean|in|there|to|with|are",
        "am|was|do",
        "you want|want|need|needed|we|they|at|all|here|got|hey|man|mate|buddy|think|say|said|my friend",
        "please go|on|too",
    ),
)
"""Words → sign. Read in this order; what was read is taken out."""

CORRECTION = re.compile(
    r"\b(?:actually|no wait|wait no|i mean|sorry|correction|scratch that|rather|on second thought)\b"
)
"""What comes after counts."""

CONDITION = re.compile(
    r"\b(?:if|unless|until|only (?:if|when|for)|but|except|as long as|provided|when|once|after|before|though|however)\b"
)
"""An answer with a condition is no answer."""

GENTLE = re.compile(r"\bbut (?:be |go |fly )?(?:careful|carefully|slow|slowly|gently|watch out|quick|quickly)\b")
"""A condition that changes nothing."""

COMMANDS: tuple[tuple[re.Pattern[str], Command], ...] = (
    (
        re.compile(r"\b(?:abort|cancel (?:the )?(?:mission|flight|task)|call it off|end the mission|mayday|give up)\b"),
        Command.ABORT,
    ),
    (
        re.compile(
            r"\b(?:come|go|fly|get|head) (?:straight )?(?:back|home)\b"
            r"|\breturn\b(?: to (?:base|home|me|start|the pad))?|\brtl\b"
        ),
        Command.RETURN,
    ),
    (
        re.compile(
            r"\b(?:stop|halt|freeze|pause|emergency)\b|\bhold (?:position|it|there|still|your position)\b"
            r"|^hold$|\bstay (?:put|there|right there|where you are)\b|\bdo not move\b"
        ),
        Command.HOLD,
    ),
)
"""Orders, the strongest first. They are obeyed at once, so that only a plain negation before them takes them back."""
