"""The patterns of the documented instruction language, compiled once."""

from __future__ import annotations

import re

from mintpilot.language.lexicon import VENUES


def any_of(*phrases: str) -> str:
    """A group that matches any of the phrases; a phrase may hold alternatives split by ``|``."""
    return f"(?:{'|'.join(phrases)})"


FILLER = re.compile(r"\b(?:um+|uh+|er+|erm+|hm+|uhm+)\b,?")

# What a clause is about -------------------------------------------------------------------------------------------

PICK = any_of("pick up|pick|grab|take|collect|fetch|get|retrieve|lift|bring|carry|deliver|transport")
BRING = any_of("bring|take|carry|deliver|give|hand|transport|get|fly|return")
FROM = any_of("from|out of|off|inside|in")
TO = r"(?<!next )(?<!close )" + any_of("over to|up to|back to|to|onto")
GO = (
    any_of("go and find|go|fly|move|head|navigate|travel|proceed|come|drive|return|hover|wait|continue")
    + any_of(" straight| directly| over| up| back| on")
    + "*"
    + any_of(" to| towards| toward| over| at| above| next to| near| by")
)
FIND = "(?:go )?" + any_of(
    "check for|find|locate|search for|look for|seek|rescue|reach|approach|visit|inspect|look at|check on",
    "check|go and see|see to",
    "attend to|get to|help|save|track down",
)
LOOK = any_of(
    "look into|look inside|look in|peek into|peek in|check|search|inspect|examine|clear|scan|sweep|visit|go through"
)
HOME = (
    any_of("come|go|fly|return|head|get")
    + "(?: straight)? "
    + any_of(
        "back|home|back home|to base|back to base|to the pad|back to the pad|to the start|to start|back to the start"
    )
)
STAY = r"(?: for (?P<seconds>\d+(?:\.\d+)?) ?(?P<unit>s|sec\w*|min\w*))?"
WAIT = any_of("wait|hover|stay|hold|remain") + "(?: there| here)?(?: for)?"
SECONDS = r"(?P<seconds>\d+(?:\.\d+)?) ?(?P<unit>s|sec\w*|min\w*)"
SOMEBODY = any_of(r"him|her|them|the \w+ (?:person|man|woman|victim)|the (?:person|victim|man|woman)")
DROP = any_of("drop|put|place|leave|set|release") + "(?: down| off)?"
AT = any_of("to|at|by|near|next to|beside|with|in front of")

# How an instruction falls into clauses ----------------------------------------------------------------------------

_VERBS = (
    "pick|grab|take|collect|fetch|get|retrieve|lift|bring|carry|deliver|give|hand|transport|drop|put|place",
    "leave|go|fly",
    "move|head|navigate|travel|proceed|come|return|hover|wait|stay|find|locate|search|look|seek|rescue|reach",
    "approach",
    "visit|inspect|check|see|peek|examine|clear|scan|sweep|help|save|make|land|open|close|push|pull|extinguish",
    "photograph|film|follow|shoot|attack|avoid|skip|keep|hold|then|set|tell|turn|explore|determine|verify",
    "continue|do",
    "never|repair|call|spray|throw|break|crash|hit|ram|dig|drive|swim|talk|comb|release|remain|attend|track",
)
_JOINTS = any_of(
    r";|\.(?=\s|$)|,? and (?:then|after that|afterwards|finally|also) |,? then |, and |,? after that |,| and "
)
SPLIT = re.compile(rf"\s*{_JOINTS}\s*(?={any_of(*_VERBS, 'please|finally|afterwards')}\b)|\s*(?:;|\.(?=\s|$))\s*")
POLITE = re.compile(
    "^(?:"
    + any_of(
        "please|kindly|hey|hello|hi|ok|okay|now|first|next|then|also|and|finally|lastly|afterwards",
        "after that|drone|so|go and(?= find| check| see| look| search)",
        "you should|you must|you need to|could you|can you|would you|will you|i want you to|i need you to",
        "i would like you to|i'd like you to|we need you to|we need to|your task is to|your mission is to|try to",
    )
    + r"\b\s*,?\s*)+"
)
TRAILING = re.compile(
    r"\s*,?\s*" + any_of("please|thanks|thank you|first|now|quickly|immediately|as fast as you can|right away") + "$"
)

# What is to be avoided --------------------------------------------------------------------------------------------

AVOID = re.compile(
    "(?:,? ?(?:and|but|while|then)? ?)(?P<wish>if possible |if you can |where possible |when possible |preferably )?"
    + any_of(
        "skip|skipping|avoid|avoiding|stay out of|staying out of|stay away from|staying away from|stay clear of",
        "keep out of|keep away from|keep clear of|keeping clear of",
        "(?:do not|don't|never) (?:fly|go|pass) (?:through|into)",
        "(?:do not|don't|never) enter|without (?:flying|going|passing) (?:through|into)|without entering",
    )
    + " (?:the |any |all |every )?(?P<what>[a-z ]+?)"
    + "(?P<soft> (?:if|when|where|whenever) (?:you can|possible|it is possible|you are able to)| as far as possible)?"
    + "(?=$|[,.;]| and | then | but | while )"
)

# Who is sought ----------------------------------------------------------------------------------------------------

_WHO = any_of(
    "any ?one|any ?body|some ?one|some ?body|other people|others|any other people",
    "any (?:other |more )?(?:victims|survivors|casualties|people)|no ?body|no one",
)
SEEK = re.compile(
    any_of("check|see|find out|make sure|look|determine|verify")
    + "(?: to see)?(?: whether| if| for| that)? (?:there (?:is|are|might be) )?"
    + _WHO
    + "(?: else)?(?: (?:is|are|may be|might be|was|has been|who is|was left|is left))?"
    + "(?: (?:hurt|injured|wounded|there|left|trapped|left behind|behind|missing|in need of help|still inside|inside))*"
    + r"(?: (?:in|inside) the (?:\w+ )?\w+)?"
)
SEEK_IN = re.compile(
    any_of("search|scan|sweep|check|comb|look through|explore")
    + " (?P<where>.+?) for "
    + any_of(
        "any ?one|any ?body|some ?one|some ?body|(?:any )?(?:survivors|victims|casualties|people)",
        "(?:any )?(?:injured people|hurt people|injured)",
    )
    + "(?: (?:hurt|injured|else|who is hurt))*"
)

# Inside a noun phrase ---------------------------------------------------------------------------------------------

_NUMBER = r"(-?\d+(?:\.\d+)?)(?:\s*(?:m|metres?|meters?))?"
POSITION = re.compile(
    r"^(?:(?:the )?(?:point|position|place|coordinates?|waypoint) )?"
    rf"\(?\s*(?:x\s*=?\s*)?{_NUMBER}\s*[,;\s]\s*(?:y\s*=?\s*)?{_NUMBER}"
    rf"(?:\s*(?:[,;\s]|at)\s*(?:z\s*=?\s*)?{_NUMBER}(?: (?:high|up|altitude))?)?\s*\)?$"
)
VENUE = re.compile(
    r"\s+(?:in|inside|within|of|around|throughout)\s+(?:the|this|that)\s+(?:\w+ ){0,2}" + any_of(*sorted(VENUES)) + "$"
)
HERE = re.compile(r"\s+(?:in here|in there|over there|nearby|inside|around)$")
SIDE = re.compile(r"\s+(?:on|to|at) (?:the|your|our|its) (left|right)(?:[- ]hand)?(?: side)?$")
NEAR = re.compile(
    r"(?:\s+(?:lying|sitting|standing|located|placed|parked))?"
    r"\s+(?:next to|near|beside|by|close to|under|underneath|in front of|behind|at|on|inside|in) (.+)$"
)
WITH = re.compile(r"\s+(?:with|containing|that has|that have|wearing) (?:the |a |an |some )?(.+)$")
STATE = re.compile(r"\s+(?:who|that|which) (?:is|are|was|were|may be|might be) (\w+)$")
RELATIVE = re.compile(r"\s+(?:who|that|which) (?:is|are|was|were)$")
