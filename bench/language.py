"""What a language model adds to the rules. `python -m bench.language [--llm embedded] [--introplan N]`."""

from __future__ import annotations

import argparse
import json
import random
import re
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from importlib.util import module_from_spec, spec_from_file_location
from statistics import mean, quantiles
from types import ModuleType

from bench import language_cases as held_out
from bench.sections import ROOT, Section, Table, keep
from mintpilot.core.errors import InputError, MintPilotError
from mintpilot.core.gap import PASSABLE, PRESENT, Candidate, GapKind, KnowledgeGap
from mintpilot.core.observation import Attribute
from mintpilot.core.ports import LanguageModel
from mintpilot.core.query import Literal, Query, Question, Saying, SayingKind
from mintpilot.core.task import Task
from mintpilot.elicitation.wording import word_question
from mintpilot.language.answers import Reading
from mintpilot.language.doubles import NoModel
from mintpilot.language.embedded import EmbeddedModel
from mintpilot.language.endpoint import EndpointModel
from mintpilot.language.reading import parse_with_model, understand_with_model
from mintpilot.language.wording import ModelWording

INTROPLAN = ROOT.parent / "shared" / "data" / "instructions" / "mobile_manipulation.txt"
MODELS: dict[str, Callable[[], LanguageModel]] = {
    "template": NoModel,
    "embedded": EmbeddedModel,
    "endpoint": EndpointModel,
}
NOTES = (
    "Four sets of held-out answers were written one after the other. When the rules first read them, 76.7, 89.0, "
    "84.7 and 80.4 % were understood (n = 73, 73, 72, 56), none with a false Yes. What was missed was mended and the "
    "first three sets went into the tests; 'held out' here is the fourth, of which some misses are mended too. For "
    "sentences that were never seen, expect 80 to 90 %; what is not understood is asked again.",
    "A Yes about an obstacle is never taken from a model: there it can only find a No.",
)
PATIENT_S = 60.0
"""Figures of quality are measured without hurry; of speed apart from them."""


class Counting(LanguageModel):
    """Notes how often a model was asked, how long it took and what it wrote."""

    def __init__(self, model: LanguageModel) -> None:
        self._model = model
        self.seconds: list[float] = []
        self.tokens = 0

    def complete(self, prompt: str, *, schema: type | None, timeout_s: float):  # type: ignore[no-untyped-def]
        started_s = time.perf_counter()
        completion = self._model.complete(prompt, schema=schema, timeout_s=timeout_s)
        self.seconds.append(time.perf_counter() - started_s)
        self.tokens += completion.tokens
        return completion

    def row(self, name: str) -> tuple[str, ...]:
        if not self.seconds:
            return (name, "0", "–", "–", "0")
        cuts = quantiles(self.seconds, n=20) if len(self.seconds) > 1 else self.seconds * 19
        return (name, str(len(self.seconds)), f"{cuts[9]:.2f} s", f"{cuts[18]:.2f} s", str(self.tokens))


def test_module(name: str) -> ModuleType:
    """A module of cases from tests/language."""
    spec = spec_from_file_location(f"cases_{name}", ROOT / "tests" / "language" / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def written(task: Task) -> tuple[str, ...]:
    """A task in the notation of the cases."""
    rows = []
    for subgoal in task.subgoals:
        reference = subgoal.reference
        words = [str(subgoal.action), reference.label, *(f"{a.name or '?'}={a.value}" for a in reference.attributes)]
        if reference.position_m is not None:
            words.append("@" + ",".join(f"{x:g}" for x in reference.position_m))
        words += [f"dwell={subgoal.dwell_s:g}"] * (subgoal.dwell_s != 2.0) + ["*"] * reference.every
        rows.append(" ".join(word for word in words if word))
    avoided = [f"{'avoid' if a.strict else 'spare'} {a.kind}" for a in task.avoid]
    return (*rows, *["people"] * task.seeks_people, *avoided)


def parse_share(cases: dict[str, tuple[str, ...]], model: LanguageModel) -> tuple[int, int]:
    """How many instructions are parsed as expected, and how many into something else than expected or a refusal."""
    right = wrong = 0
    for text, expected in cases.items():
        try:
            task = parse_with_model(text, model, home_m=(0.0, 0.0, 1.0), timeout_s=PATIENT_S)
        except InputError:
            continue
        right += written(task) == expected
        wrong += written(task) != expected
    return right, wrong


def answer_share(cases: Sequence[tuple[str, Question, str]], model: LanguageModel) -> tuple[int, int, int]:
    """Answers read as expected; false Yes; Yes and No exchanged.

    Where a person was unsure or said something else, both readings lead to asking again: they count as right.
    """
    again = {Reading.UNSURE, Reading.OTHER}
    right = false_yes = flipped = 0
    for text, question, expected in cases:
        got = understand_with_model(text, question, model, timeout_s=PATIENT_S).reading
        right += got == expected or (got in again and expected in again)
        false_yes += got is Reading.YES and expected != "yes"
        flipped += got is Reading.NO and expected == "yes"
    return right, false_yes, flipped


def questions() -> Iterator[Question]:
    """Questions as missions ask them, worded by template."""
    clouds = (
        "the grey smoke near the gate",
        "the dark smoke next to the blue rack",
        "the smoke",
        "the thin smoke by the fire",
    )
    for number, description in enumerate(clouds):
        yield _one(f"obstacle:{number}", GapKind.OBSTACLE, description, (PASSABLE, "blocked"))
    for number, description in enumerate(
        ("the closed room", "the closed room with the brown door", "the room in the far corner")
    ):
        yield _one(f"presence:{number}", GapKind.PRESENCE, description, (PRESENT, "absent"))
    looks = (("small", "red"), ("large", "blue"), ("small", "green"), ("large", "white"))
    candidates = tuple(
        Candidate(
            id=f"box-{i}",
            position_m=(float(i), 0.0, 0.0),
            attributes=(Attribute(name="size", value=size), Attribute(name="colour", value=colour)),
            description=f"the {size} {colour} box",
        )
        for i, (size, colour) in enumerate(looks)
    )
    gap = KnowledgeGap(
        id="target:1:box", kind=GapKind.TARGET, subject="the box", description="the box",
        values=tuple(c.id for c in candidates),
        prior=(0.25,) * 4, position_m=(0.0, 0.0, 0.0), candidates=candidates,
    )  # fmt: skip
    for i, (_, colour) in enumerate(looks):
        yield _worded(gap, {f"box-{i}"}, Saying(kind=SayingKind.VALUE, value=f"box-{i}"))
        yield _worded(gap, {f"box-{i}"}, Saying(kind=SayingKind.ATTRIBUTE, name="colour", value=colour))
    for size, ids in (("small", {"box-0", "box-2"}), ("large", {"box-1", "box-3"})):
        yield _worded(gap, ids, Saying(kind=SayingKind.ATTRIBUTE, name="size", value=size))


def _one(name: str, kind: GapKind, description: str, values: tuple[str, str]) -> Question:
    gap = KnowledgeGap(
        id=name, kind=kind, subject=name, description=description, values=values, prior=(0.5, 0.5),
        position_m=(0.0, 0.0, 0.0),
    )  # fmt: skip
    return _worded(gap, {values[0]}, Saying(kind=SayingKind.VALUE, value=values[0]))


def _worded(gap: KnowledgeGap, values: set[str], saying: Saying) -> Question:
    return word_question(Query(literals=(Literal(gap=gap.id, values=frozenset(values), saying=saying),)), (gap,), None)


FITS = """\
Does the thing fit the request? Answer yes or no.
Request: Bring me something to write with.
Thing: pencil
Answer: yes
Request: I want a warm drink.
Thing: hammer
Answer: no
Request: Can you pass me the green vegetable?
Thing: carrot
Answer: no
Request: Put the tool in the box.
Thing: screwdriver
Answer: yes
Request: {task}
Thing: {thing}
Answer:"""


@dataclass(frozen=True, kw_only=True)
class Scene:
    """One instruction of IntroPlan's set."""

    category: str
    objects: tuple[str, ...]
    task: str
    possible: frozenset[str]


def introplan_scenes() -> list[Scene]:
    """All instructions whose possible objects are among the scene's."""
    found = []
    for block in re.split(r"\n\s*\n", INTROPLAN.read_text()):
        row = dict(line.split(": ", 1) for line in block.splitlines() if ": " in line)
        if "Task category" not in row:
            continue
        objects = tuple(x.strip() for x in row["Scene objects"].split(","))
        possible = frozenset(x.strip() for x in row["Possible objects"].split(","))
        if possible and possible <= set(objects):
            found.append(Scene(category=row["Task category"], objects=objects, task=row["Task"], possible=possible))
    return found


def meant_by_rules(scene: Scene) -> frozenset[str]:
    """Objects whose name, else whose last word, is in the instruction; all of them where none is."""
    text = f" {re.sub(r'[^a-z ]', ' ', scene.task.lower())} "
    whole = {o for o in scene.objects if f" {o.lower()} " in text}
    if whole:
        # In "put X next to Y" the first one named is meant.
        return frozenset({min(whole, key=lambda o: (text.index(f" {o.lower()} "), -len(o)))})
    heads = {o for o in scene.objects if f" {o.lower().split()[-1].rstrip('s')}" in text}
    return frozenset(heads or scene.objects)


def meant_by_model(scene: Scene, model: LanguageModel) -> frozenset[str]:
    """Where the instruction names nothing: the objects that fit, each asked by itself; all where none does."""
    by_rules = meant_by_rules(scene)
    if len(by_rules) < len(scene.objects):
        return by_rules
    fits = set()
    for thing in scene.objects:
        try:
            completion = model.complete(FITS.format(task=scene.task, thing=thing), schema=None, timeout_s=PATIENT_S)
        except MintPilotError:
            return by_rules
        if completion.text.lower().strip().startswith("yes"):
            fits.add(thing)
    return frozenset(fits) or by_rules


def introplan_row(name: str, scenes: Sequence[Scene], meant: Callable[[Scene], frozenset[str]]) -> tuple[str, ...]:
    """Exact set; asks though one thing is possible; acts though several are; acts on something not possible."""
    exact = over_ask = over_step = unsafe = 0
    for scene in scenes:
        found = meant(scene)
        exact += found == scene.possible
        over_ask += len(found) > 1 and len(scene.possible) == 1
        over_step += len(found) == 1 and len(scene.possible) > 1
        unsafe += len(found) == 1 and not found <= scene.possible
    return (name, str(len(scenes)), *(f"{100 * x / len(scenes):.1f} %" for x in (exact, over_ask, over_step, unsafe)))


def all_answers() -> dict[str, list[tuple[str, Question, str]]]:
    """Answers from the tests and held-out ones, with their questions."""
    fitted, asked = test_module("answers"), test_module("questions")
    pairs = ((asked.SMOKE, "SMOKE"), (asked.ROOM, "ROOM"), (asked.BOX, "BOX"))
    return {
        "tests": [(text, q, r) for q, n in pairs for text, r in getattr(fitted, n).items()],
        "held out": [(text, q, r) for q, n in pairs for text, r in getattr(held_out, f"HELD_OUT_{n}").items()],
    }


def measure(name: str, model: LanguageModel, introplan: int) -> Section:
    """All figures, for the rules alone and with the model."""
    ways: list[tuple[str, LanguageModel]] = [("rules", NoModel())]
    counting = Counting(model)
    if name != "template":
        ways.append((f"rules + {name}", counting))
    cases = test_module("instructions")
    instructions = {
        "tests": {**cases.PLAIN, **cases.PARAPHRASES, **cases.MORE},
        "held out": held_out.HELD_OUT_INSTRUCTIONS,
    }
    parsed, answered, speed = [], [], []
    for way, used in ways:
        for kind, texts in instructions.items():
            right, wrong = parse_share(texts, used)
            parsed.append((way, kind, str(len(texts)), f"{100 * right / len(texts):.0f} %", str(wrong)))
        for kind, answers in all_answers().items():
            right, false_yes, flipped = answer_share(answers, used)
            answered.append(
                (way, kind, str(len(answers)), f"{100 * right / len(answers):.1f} %", str(false_yes), str(flipped))
            )
    speed.append(counting.row("instructions and answers"))
    worded, lengths, wordings = _measure_wording(counting)
    speed.append(wordings.row("wordings"))
    tables = [
        Table(caption="Instructions", header=("way", "set", "n", "as expected", "as something else"), rows=parsed),
        Table(caption="Answers", header=("way", "set", "n", "understood", "false Yes", "No for Yes"), rows=answered),
        Table(
            caption="Wordings",
            header=("n", "accepted by the check, and other words", "words, template", "words, model"),
            rows=[(worded, *lengths)],
        ),
    ]
    if INTROPLAN.exists():
        tables.append(_measure_introplan(ways, introplan))
    tables.append(Table(caption="The model's time", header=("for", "calls", "p50", "p95", "tokens"), rows=speed))
    return Section(
        name=f"50-language-{name}",
        title=f"Language: the rules alone, and with '{name}'",
        command=f"python -m bench.language --llm {name} --introplan {introplan}",
        how="Cases from tests/language (the rules were written for them) and from bench/language_cases.py (held out). "
        "An answer that was unsure or beside the point counts as understood when it is asked again. IntroPlan: a "
        "seeded "
        "sample for the model, all for the rules; objects only, not places.",
        tables=tables,
        notes=NOTES,
    )


def _measure_wording(model: Counting) -> tuple[str, tuple[str, str, str], Counting]:
    inner = Counting(model._model)
    wording = ModelWording(template=word_question, model=inner, timeout_s=PATIENT_S)
    asked = list(questions())
    for question in asked:
        wording.improve(question)
    template = mean(len(q.text.split()) for q in asked)
    used = [trial for trial in wording.trials if not trial.doubt]
    other = [trial for trial in used if trial.proposed != trial.template]
    share = f"{100 * len(used) / len(asked):.0f} %, {100 * len(other) / len(asked):.0f} %"
    words = f"{mean(len(t.proposed.split()) for t in used):.1f}" if used else "–"
    for trial in wording.trials:
        print(f"  {trial.template!r} -> {trial.proposed!r} {trial.doubt}")
    return str(len(asked)), (share, f"{template:.1f}", words), inner


def _measure_introplan(ways: Sequence[tuple[str, LanguageModel]], most: int) -> Table:
    scenes = introplan_scenes()
    sample = random.Random(0).sample(scenes, min(most, len(scenes)))
    rows = [introplan_row("rules", scenes, meant_by_rules)]
    if len(ways) > 1:
        rows.append(introplan_row("rules", sample, meant_by_rules))
        model = ways[1][1]
        rows.append(introplan_row(ways[1][0], sample, lambda scene: meant_by_model(scene, model)))
    header = ("way", "n", "exact set", "over-ask", "over-step", "unsafe")
    return Table(caption="IntroPlan's instructions", header=header, rows=rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--llm", choices=sorted(MODELS), default="template")
    parser.add_argument("--introplan", type=int, default=100, help="instructions for the model, drawn with seed 0")
    parser.add_argument("--dry", action="store_true", help="print only; leave docs/results.md alone")
    options = parser.parse_args()
    model = MODELS[options.llm]()
    if isinstance(model, EmbeddedModel):
        model.wait()
    try:
        section = measure(options.llm, model, options.introplan)
    finally:
        if isinstance(model, EmbeddedModel):
            model.close()
    print(section.markdown())
    print(json.dumps({"command": section.command}))
    if not options.dry:
        keep(section)


if __name__ == "__main__":
    main()
