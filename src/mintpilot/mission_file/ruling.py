"""The rules of a mission file: patterns → core's rules, and every mistake in them (method, section 14)."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

from mintpilot.core import rule_patterns as patterns
from mintpilot.core.errors import MintPilotError
from mintpilot.core.message import verbatim
from mintpilot.core.observation import RegionKind
from mintpilot.core.rule import About, Rule
from mintpilot.mission_file.form_checks import nearest
from mintpilot.mission_file.schema import MissionFile, RuleSpec
from mintpilot.mission_file.schema_world import MapWorld, SceneWorld
from mintpilot.mission_file.yaml_places import Fault, Path_
from mintpilot.rules.formula import propositions_of
from mintpilot.rules.parsing import parse, proposition
from mintpilot.rules.satisfying import conflicting, is_trivial
from mintpilot.uncertainty.ruling import labels_of

_DRAWN = re.compile(rf"(?:{'|'.join(RegionKind)}|room)-[1-9]\d*")
"""Ids that a drone gives to what it draws into its own map; which there will be is not known before."""
_PATTERNS: dict[frozenset[str], Callable[[RuleSpec], Rule]] = {
    frozenset({"never"}): lambda s: patterns.never(proposition(s.never or "")),
    frozenset({"always"}): lambda s: patterns.always(proposition(s.always or "")),
    frozenset({"never", "before"}): lambda s: patterns.never_before(
        proposition(s.never or ""), proposition(s.before or "")
    ),
    frozenset({"first", "then"}): lambda s: patterns.first_then(proposition(s.first or ""), proposition(s.then or "")),
    frozenset({"after", "eventually"}): lambda s: patterns.after_eventually(
        proposition(s.after or ""), proposition(s.eventually or "")
    ),
    frozenset({"end"}): lambda s: patterns.at_end(proposition(s.end or "")),
    frozenset({"formula"}): lambda s: _written(s.formula or ""),
}


def _written(text: str) -> Rule:
    """A rule as somebody wrote it in LTLf. Raises as `mintpilot.rules.parsing.parse`."""
    parse(text)
    return Rule(text=verbatim(text.strip()), formula=text.strip())


def rules_of(file: MissionFile) -> tuple[Rule, ...]:
    """The rules of a mission file that was checked."""
    return tuple(_PATTERNS[_keys(spec)](spec) for spec in file.rules)


def rule_faults(file: MissionFile) -> Iterator[Fault]:
    """Every mistake in the rules: patterns, formulas, names, and rules that cannot be kept or say nothing."""
    rules: list[Rule] = []
    for index, spec in enumerate(file.rules):
        path: Path_ = ("rules", index)
        if _keys(spec) not in _PATTERNS:
            known = "; ".join(" with ".join(sorted(keys)) for keys in _PATTERNS)
            yield _fault(path, f"{' with '.join(sorted(_keys(spec))) or 'nothing'} is no rule; known: {known}")
            continue
        try:
            rule = _PATTERNS[_keys(spec)](spec)
            faults = list(_name_faults(file, rule, path))
            if not faults and is_trivial(rule):
                faults = [_fault(path, f"'{rule.text}' is kept by every flight: it says nothing; remove it")]
        except MintPilotError as error:
            faults = [_fault(path, str(error))]
        yield from faults
        rules += [] if faults else [rule]
    if len(rules) == len(file.rules):
        yield from _conflict(rules)


def _conflict(rules: list[Rule]) -> Iterator[Fault]:
    try:
        found = conflicting(rules)
    except MintPilotError as error:
        yield _fault(("rules",), str(error))
        return
    if found:
        words = " and ".join(f"'{rule.text}'" for rule in found)
        together = "contradict each other" if len(found) > 1 else "contradicts itself"
        yield _fault(
            ("rules", rules.index(found[-1])), f"{words} {together}: no flight can keep this; change or remove one"
        )


def _name_faults(file: MissionFile, rule: Rule, path: Path_) -> Iterator[Fault]:
    goals = [goal.id for goal in file.goals or () if goal.id is not None]
    looks = [goal.id for goal in file.goals or () if goal.id is not None and goal.action == "look"]
    kinds = [str(kind) for kind in RegionKind]
    on_map = isinstance(file.world, MapWorld)
    regions, rooms = _places(file)
    regions += kinds
    for what in sorted(propositions_of(parse(rule.formula))):
        noun, known = "region", regions
        match what.about:
            case About.AT | About.DID:
                noun, known = "goal with the id", goals
            case About.LOOKED:
                noun, known = "room", [*rooms, *looks]
            case About.WITHIN:
                noun, known = "thing, region or people", ["people", *regions, *_things(file)]
                if any(label in known for label in labels_of(what.subject)):
                    continue
            case About.CARRYING:
                noun, known = "thing", _things(file)
            case _:
                pass
        if not on_map and what.about not in (About.AT, About.DID):
            if what.about in (About.WITHIN, About.CARRYING) or _DRAWN.fullmatch(what.subject):
                continue  # told only by the map that the drone will draw
            known = [*known, *(f"{kind}-1" for kind in (kinds if noun == "region" else ["room"]))]
        if what.subject not in known:
            yield _fault(path, f"{what}: there is no {noun} '{what.subject}'; {nearest(what.subject, known)}")


def _places(file: MissionFile) -> tuple[list[str], list[str]]:
    """Ids of the regions and of the rooms that the file itself names."""
    match file.world:
        case MapWorld():
            return [r.id for r in file.world.regions], [r.id for r in file.world.rooms]
        case SceneWorld():
            return [s.id for s in file.world.scene.smokes], [r.id for r in file.world.scene.rooms]
        case _:
            return [], []


def _things(file: MissionFile) -> list[str]:
    """What things may be called: ids and labels of a given map, labels and words of the goals and the instruction."""
    goals = [word for goal in file.goals or () for word in (goal.label or "", *(goal.phrase or "").split())]
    objects = [name for o in file.world.objects for name in (o.id, o.label)] if isinstance(file.world, MapWorld) else []
    words = (word.strip(".,;:!").lower() for word in file.instruction.split())
    return sorted({*objects, *goals, *words} - {""})


def _keys(spec: RuleSpec) -> frozenset[str]:
    return frozenset(key for key in RuleSpec.model_fields if getattr(spec, key) is not None)


def _fault(path: Path_, message: str) -> Fault:
    return Fault(path=path, line=None, message=message)
