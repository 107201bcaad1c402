"""What was understood of an instruction so far: steps, and what pronouns look back to."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field

from mintpilot.core.geometry import Vec3
from mintpilot.core.observation import Attribute, RegionKind
from mintpilot.core.rule import Rule
from mintpilot.core.task import START, Action, KeepAway, Reference, SubGoal
from mintpilot.language import lexicon
from mintpilot.language.phrases import Unread, Words, noun_phrase, refuse

PERSON, ROOM = "person", "room"
HURT_PEOPLE = Reference(
    phrase="anyone hurt", label=PERSON, attributes=(Attribute(name="condition", value="injured"),), every=True
)


@dataclass(slots=True)
class Reading:
    """What was understood so far."""

    words: Words
    home_m: Vec3 | None
    subgoals: list[SubGoal] = field(default_factory=list)
    seeks_people: bool = False
    sought_at: int | None = None
    """Number of steps that stood before the last search for people."""
    avoid: list[RegionKind] = field(default_factory=list)
    rules: list[Rule] = field(default_factory=list)
    entered_later: tuple[Reference, ...] = ()
    """What is not to be entered before a step that is said beside it."""
    back_last: bool = False
    """Whether it comes back at the end, wherever that is said."""
    keep_away: list[KeepAway] = field(default_factory=list)
    slowly: bool = False
    carried: Reference | None = None
    listed: int = 1
    """How many things the last list had."""
    took_off: bool = False
    named: list[Reference] = field(default_factory=list)
    """Everything that was spoken of, oldest first: what pronouns look back to."""
    clause_at: int = 0
    """Where the clause begins that is read."""
    told: Reference | None = None
    """What a sentence only said to be there, until a pronoun takes it up."""

    def attempt(self, rule: Callable[[Reading], None]) -> bool:
        """Whether the rule fits here; where it does not, nothing is changed."""
        before = {name: getattr(self, name) for name in _STATE}
        copies = {name: list(value) if isinstance(value, list) else value for name, value in before.items()}
        at = self.words.at
        try:
            rule(self)
        except Unread:
            for name, value in copies.items():
                setattr(self, name, value)
            self.words.at = at
            return False
        return True

    def add(self, action: Action, reference: Reference, thing: Reference | None = None) -> None:
        """Notes one step."""
        self.subgoals.append(SubGoal(action=action, reference=reference, thing=thing))
        self.named += [r for r in (thing, reference) if r is not None and r not in self.named[-1:]]

    def phrase(self, *, tail: bool = True) -> Reference:
        """A noun phrase or pronoun at the cursor. Raises `Unread`."""
        words = self.words
        if words.next() in ("it", "them", "him", "her", "there") and not self._owns():
            words.move(words.at + 1)
            return self.meant(words.tokens[words.at - 1])
        if words.take("each of them", "all of them", "every one of them"):
            last = self.named[-1] if self.named and self.named[-1].every else None
            return last or words.fail()
        return noun_phrase(words, tail=tail, before=self.named[-1] if self.named else None)

    def phrases(self) -> Iterator[Reference]:
        """One or more of them in a list: ``the gate, the rack and the pillar``."""
        last = self.phrase()
        self.listed = 1
        yield last
        while True:
            at = self.words.at
            joint = self.words.take(",", ", and", "and")
            more = self._listed_next(last) if joint else None
            if more is None:
                self.words.at = at
                return
            if joint == "and" and any(a.name in ("near", "contents") for a in last.attributes):
                self.words.fail()  # the box next to the rack and the gate: of which is the gate a part?
            self.listed += 1
            last = more
            yield more

    def _listed_next(self, last: Reference) -> Reference | None:
        with suppress(Unread):
            if self.words.next() in ("it", "them", "him", "her", "there", "to"):
                return None
            more = noun_phrase(self.words, before=last)
            if self.words.next() not in ("is", "are", "needs", "need", "was", "has", "must", "should"):
                return more
        return None

    def meant(self, pronoun: str) -> Reference:
        """What a pronoun means: the last person or thing. Raises `InstructionError` where that is not certain."""
        if pronoun in ("him", "her", "them"):
            found = list(dict.fromkeys(r for r in self.named if is_person(r)))
            if pronoun == "them" and self.named:
                found += [r for r in self.named if r.every and not is_person(r)]
                found += [r for r in self.named[-1:] if self.listed > 1 and r not in found]
            if len(found) > 1:
                refuse(pronoun, f"may mean {_listed(found)}: name who is meant")
        elif pronoun == "it" and self.carried is not None:
            found = [self.carried]
        else:
            taken = [g.reference for g in self.subgoals if g.action is Action.PICK] if pronoun == "there" else []
            taken += [g.thing for g in self.subgoals if g.thing is not None] if pronoun == "there" else []
            found = [r for r in self.named if not is_person(r) and not r.every and r not in taken][-1:]
        if not found:
            refuse(pronoun, "refers to nothing that was named before: name the person or thing")
        if self.told is found[-1]:
            self.told = None
        return found[-1]

    def home(self) -> Reference:
        """The place of take-off. Raises `InstructionError` where it is not known."""
        if self.home_m is None:
            refuse(START, "is not known here: name the place to come back to")
        return Reference(phrase=START, position_m=self.home_m)

    def _owns(self) -> bool:
        """Whether ``her`` or ``them`` stands before a noun of its own: ``her bottle``."""
        with suppress(Unread):
            ahead = Words(self.words.tokens, self.words.known, self.words.at + 1)
            article = ahead.next() in lexicon.DETERMINERS | lexicon.EVERY
            noun_phrase(ahead)
            return self.words.next() == "her" and not article
        return False


_STATE = (
    "took_off",
    "listed",
    "subgoals",
    "seeks_people",
    "sought_at",
    "avoid",
    "rules",
    "entered_later",
    "back_last",
    "keep_away",
    "slowly",
    "carried",
    "named",
    "told",
)


def is_person(reference: Reference) -> bool:
    """Whether it means a person."""
    return reference.label == PERSON or reference.label in lexicon.ROLES


def is_alive(reference: Reference) -> bool:
    """Whether it means a person or an animal."""
    return is_person(reference) or reference.label in lexicon.ANIMALS


def _listed(references: list[Reference]) -> str:
    return " or ".join(f"'{r.phrase}'" for r in references)
