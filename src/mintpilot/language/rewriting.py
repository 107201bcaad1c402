"""Ways of saying an instruction that are the documented language in other clothes, put back into it.

Each rule turns one construction into plain steps and keeps the words for things. What no rule knows stays as it is, and
is refused later where it is not understood.
"""

from __future__ import annotations

import re

from mintpilot.language.lexicon import VENUES
from mintpilot.language.patterns import any_of

_VENUE = rf"(?:the|this|that|our) (?:\w+ ){{0,2}}{any_of(*sorted(VENUES))}"
_HURT = any_of("hurt|injured|wounded|trapped|in need of help|missing|in trouble|alive")
_MAY_BE = any_of("is|are|might be|may be|could be|was|has been")
_WHO = any_of(
    rf"(?:any|every|some) ?(?:one|body)(?: else)?(?: who {_MAY_BE})?(?: {_HURT})*",
    rf"(?:any|all|the) (?:other |more |further )?(?:victims|survivors|casualties|{_HURT} (?:people|persons)|people)",
    rf"{_HURT} (?:people|persons)|survivors|victims|casualties|people",
)
_ELSE = any_of(
    rf"(?:any|every|some) ?(?:one|body) else(?: who {_MAY_BE} {_HURT}| {_HURT})?",
    rf"any (?:other|more|further) (?:victims|survivors|casualties|{_HURT} (?:people|persons)|people)",
)
_ROOMS = r"(?:every|all|each|the|all the)(?: of the)? (?:\w+ )?rooms?(?: on the (?:left|right)(?:[- ]hand side)?)?"
_LOOK_FOR_HURT = "check whether anyone else is hurt"
_GERUNDS = {
    "picking": "pick", "checking": "check", "visiting": "visit", "finding": "find", "bringing": "bring", "going": "go",
    "flying": "fly", "looking": "look", "searching": "search", "getting": "get", "taking": "take", "fetching": "fetch",
    "collecting": "collect", "inspecting": "inspect", "reaching": "reach", "moving": "move", "grabbing": "grab",
    "delivering": "deliver", "passing": "pass", "heading": "head", "locating": "locate", "scanning": "scan",
}  # fmt: skip
_GERUND = any_of(*_GERUNDS)
_DONE = {
    "found": "find", "reached": "reach", "picked up": "pick up", "checked": "check", "visited": "visit", "got": "get",
    "delivered": "deliver", "collected": "collect", "located": "locate", "grabbed": "grab", "are at": "go to",
    "arrive at": "go to", "get to": "go to", "reach": "reach", "find": "find", "have": "get", "see": "find",
}  # fmt: skip
_AFTER = rf"(?:when|once|after|as soon as) (?:you have|you've|you) (?P<done>{any_of(*_DONE)}) (?P<first>[^,;.]+?)"
_VERB = any_of(
    "find|go|fly|check|look|search|pick|get|bring|avoid|stay|skip|visit|inspect|move|head|take|fetch|collect|locate",
    "deliver|reach|grab|carry",
)
_SPARE = any_of("avoid|stay out of|keep out of|stay clear of|keep clear of|skip")

_RULES: tuple[tuple[re.Pattern[str], str], ...] = tuple(
    (re.compile(pattern), said)
    for pattern, said in (
        (r"^(?:(?:your|our|the|my) )?(?:mission|task|job|orders?)(?: (?:is|are))?\s*[:,]?\s*(?:to )?", ""),
        (r",? ?\bas (?:quickly|fast|soon|carefully|safely) as (?:possible|you can)\b", ""),
        (r"\b(?:very )?(?:carefully|slowly|quickly|immediately|swiftly|safely|cautiously)\b ?", ""),
        (r" for (?:me|us)\b", ""),
        (r"\bthere's\b", "there is"),
        (r"\bget (?:a )?hold of\b", "pick up"),
        (r"\b(?:that's|that is|which is) (?:lying |sitting |standing )?"
         r"(?=(?:next to|near|in|on|by|behind|under|beside)\b)", ""),
        (r", (?:it|he|she|they)(?:'s| is| are| should be| must be| will be)(?: somewhere)? "
         r"(?=(?:in|on|near|next to|by|behind|under|beside|inside) the\b)", " "),
        (rf"^((?:if you can,? |please )*{_SPARE} (?:the )?[a-z ]+?) while (?:you )?(?:are )?"
         rf"(?={_VERB}|{_GERUND})", r"\1, "),
        (r"\b((?:look|check|search|peek) [^.;]*?),? (?:and )?then (?=(?:in|into|inside) )", r"\1, then look "),
        (rf"\b(?:make|be) sure (?:that you |you |to |that we )(?={_VERB})", ""),
        (rf"\b(?:remember|do not forget|don't forget|try|take care|manage) to (?={_VERB})", ""),
        (r"\bgo (?:and )?(?=(?:get|fetch|grab|find|pick|collect|bring|check|see|look|search)\b)", ""),
        (r"\b(?:have|take) a (?:good |quick )?look (?:into|in|at|inside|around)\b", "look into"),
        (r"\b(?:head|make) for (?=the\b)|\b(?:make your way|hurry|rush|get yourself|get over) to\b ?",
         "go to "),
        (rf"(?:^|(?<=[.;,] ))(?:in|inside|within|throughout) {_VENUE},? (?={_VERB}|please)", ""),
        (rf"\b(?:search|scan|explore|comb) {_VENUE} (?:and|to) (?=find|look for|locate)", ""),
        (r"\bif (?:you can|possible), (?=skip|avoid|stay)", "if you can "),
        (rf"^there (?:is|are) (?:a|an|some) ([\w ]+?)(?: (?:in|inside) {_VENUE})?\s*[.;,]\s*(?:and |so )?(?:please )?"
         r"(find|locate|go to|fly to|look for|rescue|help|reach) (?:it|them|him|her)\b", r"\2 the \1"),
        (rf"^some ?(?:one|body) is {_HURT}(?: (?:in|inside) {_VENUE})?\s*[.;,]\s*(?:and |so )?(?:please )?"
         r"(?:find|locate|look for|rescue|help) (?:them|him|her)\b", "find anyone hurt"),
        (r"^(the [\w ]+?) needs? (the [\w ]+? (?:from|in|out of|inside) the [\w ]+)$", r"bring \2 to \1"),
        (r"^(the [\w ]+?) (?:holds|contains|has) (?:the |some )?(\w+) (?:that|which) (the [\w ]+?) needs?$",
         r"bring the \2 from \1 to \3"),
        (r"^(?:we need |i need )?(the [\w ]+?) (?:must be |should be |needs to be |has to be |is to be |to be )?"
         r"(?:brought|taken|delivered|carried|handed) (?:over )?to (the .+)$", r"bring \1 to \2"),
        (r"\b(get|grab|fetch|take|collect|pick up) (the [\w ]+? (?:from|out of|in) the [\w ]+?) for (the [\w ]+)$",
         r"bring \2 to \3"),
        (rf"\bwould you mind (?={_GERUND})", ""),
        (r"\bto (?:where|the place where) (the [\w ]+?) is\b", r"to \1"),
        (r"\b(?:that|which) (?:contains|holds|carries|has|is holding) ", "containing "),
        (rf"\bwho(?:so)?ever is ({_HURT})", r"anyone \1"),
        (r"(the [\w ]+), the one (?=near|next to|by|with|on|at|in|behind|beside)", r"\1 "),
        (rf"\b(?:look|search|check)(?: in| into| through| inside)? ({_ROOMS}) for {_WHO}",
         rf"look into \1 and {_LOOK_FOR_HURT}"),
        (rf"\b(?:look|search|check) for {_WHO} in ({_ROOMS})", rf"look into \1 and {_LOOK_FOR_HURT}"),
        (rf"\b(?:check|see|find out|look) (?:if|whether) (?:there (?:is|are) )?(?:any|some) ?(?:one|body)"
         rf"(?: is| are)?(?: (?:in|inside)) ({_ROOMS})", rf"look into \1 and {_LOOK_FOR_HURT}"),
        (rf"(?<=\w),? and (?:also |for |then )?(?:to )?(?:find |look for |search for )?{_ELSE}(?=$|[.;,])",
         f" and {_LOOK_FOR_HURT}"),
    )
)  # fmt: skip
"""Construction → plain words; each is tried once, in order."""
_ORDERS: tuple[tuple[re.Pattern[str], str], ...] = (
    (re.compile(rf"^(?:please )?after (?P<first>{_GERUND} [^,;]+), (?:please )?(?P<then>.+)$"), "{first}, then {then}"),
    (re.compile(rf"^(?P<then>[^,;]+?) after (?P<first>{_GERUND} [^,;]+)$"), "{first}, then {then}"),
    (
        re.compile(rf"^(?:please )?before (?:you )?(?P<then>[^,;]+), (?:please )?(?P<first>{_VERB} .+)$"),
        "{first}, then {then}",
    ),
    (
        re.compile(rf"^(?P<first>{_VERB} [^,;]+?),? before (?:you )?(?P<then>(?:{_GERUND}|{_VERB}) [^,;]+)$"),
        "{first}, then {then}",
    ),
    (re.compile(rf"^{_AFTER}, (?P<then>.+)$"), "{done} {first}, then {then}"),
    (
        re.compile(r"^(?:on|along) (?:your|the) way to (?P<then>[^,;]+), (?P<first>[^.;]+)$"),
        "{first}, then go to {then}",
    ),
    (
        re.compile(rf"^(?P<first>{_VERB} [^,;]+?),? on (?:your|the) way to (?P<then>[^,;]+)$"),
        "{first}, then go to {then}",
    ),
)
"""Steps that are told in another order than they are done."""


def rewritten(words: str) -> str:
    """The instruction in the documented language, as far as the rules know how.

    Args:
        words: in lower case, blanks single.
    """
    for pattern, said in _RULES:
        words = pattern.sub(said, words).strip(" ,.;")
    for pattern, order in _ORDERS:
        found = pattern.match(words)
        if found is not None:
            parts = {**found.groupdict()}
            parts["done"] = _DONE.get(parts.get("done") or "", "")
            words = order.format(**parts)
    words = re.sub(rf"(?:^|(?<=, then )|(?<=and )|(?<=, ))({_GERUND})\b", lambda m: _GERUNDS[m[1]], words)
    return " ".join(words.split())
