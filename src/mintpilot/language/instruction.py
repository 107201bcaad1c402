"""Instruction [I] → task, by one small grammar (method, section 1).

An instruction is a list of clauses; each becomes typed steps or says what is stayed out of. Every word must have its
part in the reading. One that has none refuses the whole instruction and is named: nothing is guessed, nothing left out.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from itertools import product

from mintpilot.core.geometry import Vec3
from mintpilot.core.task import Action, SubGoal, Task
from mintpilot.language import lexicon, verbs
from mintpilot.language.clauses import HURT_PEOPLE, Reading, is_person
from mintpilot.language.phrases import InstructionError, Words, refuse, words_of
from mintpilot.language.rule_phrases import come_back, ordered
from mintpilot.language.rules import enters_later, keeps_out, not_entered_before, read_clause

_LONGEST = 600
_MARKS = (".", ";", "!", "?", ":")
_DOING = {
    Action.GO: "go to", Action.PICK: "pick up", Action.DELIVER: "deliver to", Action.LOOK: "look into",
    Action.COUNT: "count", Action.PHOTOGRAPH: "photograph", Action.REPORT: "report",
}  # fmt: skip


@dataclass(frozen=True, slots=True, kw_only=True)
class Capabilities:
    """What the vehicle can do; the instruction is checked against it."""

    actions: frozenset[Action] = frozenset(Action)
    """Without a gripper: all but `Action.PICK` and `Action.DELIVER`."""


def parse_instruction(
    text: str,
    capabilities: Capabilities | None = None,
    *,
    home_m: Vec3 | None = None,
    known: Collection[str] = (),
) -> Task:
    """Turns an instruction into ordered sub-goals.

    Args:
        text: the words of the person, in English.
        capabilities: what the vehicle can do; None: everything that `Action` names.
        home_m: where ``come back`` leads, metres; None: such an instruction is refused.
        known: words that the mission's map uses for things, in lower case; they count as known here.

    Raises:
        InputError: the instruction is empty, unclear, or asks for what the vehicle cannot do; as `InstructionError` it
            names the word that is in the way.
    """
    words = Words(words_of(text), known)
    if not any(token[0].isalpha() for token in words.tokens):
        raise InstructionError(f"instruction '{text[:40]}' has no words: say what to do, as in 'go to the red box'")
    if len(text) > _LONGEST:
        raise InstructionError(
            f"an instruction of {len(text)} characters: keep it under {_LONGEST}, one step after another"
        )
    reading = Reading(words=words, home_m=home_m)
    while _skip_joints(words):
        _read_sentence(reading)
    return _task(text, reading, capabilities or Capabilities())


def _read_sentence(reading: Reading) -> None:
    """Clauses up to the end of a sentence."""
    words = reading.words
    begun, words.open = words.at, True
    if words.take("before you", "before"):
        _swapped(reading, begun)
    elif words.take("after"):
        _plain(words)
        if not read_clause(reading) or not words.take(","):
            raise _refusal(reading, begun)
    while words.next() and words.next() not in _MARKS:
        at, is_first = words.at, not reading.subgoals
        words.take("first" if is_first else "")
        _skip_joints(words)
        words.open = words.next() not in lexicon.LIGHT_VERBS
        if not _read_one(reading):
            raise _refusal(reading, begun)
        words.take("first" if is_first else "", "for me" if reading.carried is None else "")
        if not _at_joint(reading):
            raise _refusal(reading, at)
        if words.take("after"):
            _put_first(reading, begun)
        elif words.take("before you", "before"):
            _before(reading, begun)
        _skip_joints(words)


def _read_one(reading: Reading) -> bool:
    words = reading.words
    if not_entered_before(reading):
        _plain(words)
        earlier = _step_for(reading)
        ordered(reading, earlier, earlier + 1)
        return True
    if keeps_out(reading):
        if words.take("while"):
            _plain(words)
            return read_clause(reading)
        return True
    if words.take("while", "but"):
        return keeps_out(reading)
    return read_clause(reading)


def _at_joint(reading: Reading) -> bool:
    """Whether the clause is over: no word of it is left. What only rounds it off is taken."""
    words = reading.words
    while words.take(*verbs.AFTERTHOUGHTS):
        pass
    if words.next() in ("", *_MARKS, ",", "and", "then", "after", "before", "finally", "afterwards"):
        return True
    at = words.at
    words.take("but", "while")
    if reading.attempt(_keeps_out_ahead):
        words.at = at + (words.tokens[at] == "but")
        return True
    words.at = at
    return False


def _keeps_out_ahead(reading: Reading) -> None:
    at, before = reading.words.at, (reading.avoid[:], reading.keep_away[:], reading.rules[:])
    if not keeps_out(reading):
        reading.words.fail()
    reading.words.at = at
    reading.avoid, reading.keep_away, reading.rules = before


def _swapped(reading: Reading, begun: int) -> None:
    """``before you go to the van, go to the gate``."""
    _plain(reading.words)
    later = Reading(words=reading.words, home_m=reading.home_m, named=reading.named)
    is_read = enters_later(reading) or read_clause(later)
    if not is_read or not reading.words.take(",") or not read_clause(reading):
        raise _refusal(reading, begun)
    if not _at_joint(reading) or later.carried is not None:
        raise _refusal(reading, begun)
    count = len(reading.subgoals)
    reading.subgoals += later.subgoals
    reading.seeks_people |= later.seeks_people
    ordered(reading, count - 1, count)
    _skip_joints(reading.words)


def _before(reading: Reading, begun: int) -> None:
    """``look into the room before you go through the smoke``; a step that follows is done after."""
    _plain(reading.words)
    count = len(reading.subgoals)
    if not enters_later(reading) and not read_clause(reading):
        raise _refusal(reading, begun)
    if not _at_joint(reading):
        raise _refusal(reading, begun)
    ordered(reading, count - 1, count)


def _step_for(reading: Reading) -> int:
    """Place of the step that the next clause says: one that was said already, or a new one."""
    said = Reading(words=reading.words, home_m=reading.home_m, named=reading.named)
    if not read_clause(said) or len(said.subgoals) != 1:
        raise _refusal(reading, reading.clause_at)
    (goal,) = said.subgoals
    known = [i for i, g in enumerate(reading.subgoals) if replace(g, id="") == goal]
    if not known:
        reading.subgoals.append(goal)
    return known[0] if known else len(reading.subgoals) - 1


def _put_first(reading: Reading, begun: int) -> None:
    """``… after visiting the tank``: said last and done first. Only where one clause and no other stands before it."""
    _plain(reading.words)
    earlier = Reading(words=reading.words, home_m=reading.home_m, named=reading.named)
    if len(reading.subgoals) != 1 or reading.carried is not None or not read_clause(earlier):
        raise _refusal(reading, begun)
    reading.subgoals = [*earlier.subgoals, *reading.subgoals]
    reading.carried = earlier.carried
    if not _at_joint(reading) or reading.words.next() == "after":
        raise _refusal(reading, begun)
    ordered(reading, len(earlier.subgoals) - 1, len(earlier.subgoals))


def _plain(words: Words) -> None:
    """A verb in -ing at the cursor, as the plain verb."""
    if words.next() in verbs.GERUNDS:
        words.tokens[words.at] = verbs.GERUNDS[words.next()]


def _skip_joints(words: Words) -> bool:
    """Takes marks, joining words and politeness between clauses. Whether anything follows."""
    while words.take(*verbs.JOINTS, *verbs.POLITE, *_MARKS, '"', "'"):
        pass
    return bool(words.next())


def _task(text: str, reading: Reading, capabilities: Capabilities) -> Task:
    if reading.told is not None:
        raise InstructionError(
            f"'{reading.told.phrase}' is said to be there, but no step takes it up: say what is to be done with it"
        )
    if reading.sought_at is not None and reading.sought_at < len(reading.subgoals):
        later = reading.subgoals[reading.sought_at].reference.phrase
        refuse(later, "would be done before or after the search for people, whichever is shorter: say the search last")
    if reading.seeks_people and not any(is_person(g.reference) for g in reading.subgoals):
        reading.add(Action.GO, HURT_PEOPLE)
    come_back(reading)
    if not reading.subgoals and reading.took_off:
        reading.add(Action.GO, reading.home())
    if not reading.subgoals:
        raise InstructionError(
            f"'{text.strip()}' says nothing that is to be done: add a step, as in 'go to the red box'"
        )
    for subgoal, keep in product(reading.subgoals, reading.keep_away):
        same = keep.reference.label == subgoal.reference.label != "person"
        if same and keep.reference.attributes == subgoal.reference.attributes:
            refuse(keep.reference.phrase, "cannot be gone to and stayed away from: leave one of them out")
    for subgoal in reading.subgoals:
        _check_capable(subgoal, capabilities)
    return Task(
        instruction=text,
        subgoals=tuple(reading.subgoals),
        seeks_people=reading.seeks_people,
        avoid=tuple(dict.fromkeys(reading.avoid)),
        keep_away=tuple(dict.fromkeys(reading.keep_away)),
        rules=tuple(dict.fromkeys(reading.rules)),
        slowly=reading.slowly,
    )


def _check_capable(subgoal: SubGoal, capabilities: Capabilities) -> None:
    if subgoal.action not in capabilities.actions:
        raise InstructionError(
            f"'{_DOING[subgoal.action]} {subgoal.reference.phrase}' cannot be done: the vehicle can only "
            f"{', '.join(sorted(_DOING[a] for a in capabilities.actions))}. Change the instruction or the vehicle.",
            word=_DOING[subgoal.action].split()[0],
        )


def _refusal(reading: Reading, begun: int) -> InstructionError:
    """Names the word in the way: one that is known to be beyond the grammar, else the first that fits nowhere."""
    words = reading.words
    tokens = words.tokens
    end = next((i for i in range(max(words.at, begun), len(tokens)) if tokens[i] in _MARKS), len(tokens))
    clause = tokens[begun:end] or tokens[begun:] or tokens
    word = next((w for w in clause if w in lexicon.REASONS), "")
    reason = lexicon.REASONS.get(word, "it has no part in anything that is understood here")
    if not word:
        word = tokens[max(begun, min(words.furthest, len(tokens) - 1))]
    said = " ".join(clause)
    done = ", then ".join(f"{_DOING[g.action]} {g.reference.phrase}" for g in reading.subgoals) or "nothing yet"
    return InstructionError(
        f"'{said}' is not understood because of '{word}': {reason}. Understood so far: {done}. Say it with one of: "
        "go to, find, pick up, bring … to, look into, search … for, count, photograph, report what you see, "
        "check whether anyone is hurt.",
        word=word,
        reason=reason,
    )
