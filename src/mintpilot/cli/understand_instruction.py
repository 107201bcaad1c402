"""``mintpilot understand instruction``: the steps as the drone reads them."""

from __future__ import annotations

import json as jsons
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeAlias, TypedDict

from cyclopts import Parameter

from mintpilot.cli.exits import ExitCode, guarded

if TYPE_CHECKING:
    from mintpilot.assembly.understanding import UnderstoodInstruction

_Flag: TypeAlias = Annotated[bool, Parameter(negative="")]


class _Refused(TypedDict):
    word: str
    reason: str


class _Row(TypedDict):
    text: str
    steps: list[dict[str, int | str]]
    keep_out: list[str]
    rules: list[str]
    slowly: bool
    needs_confirmation: bool
    refused: _Refused | None


def instruction(
    text: str | None = None,
    mission: Path | None = None,
    /,
    *,
    file: Path | None = None,
    llm: Annotated[str | None, Parameter(name="--llm")] = None,
    json: Annotated[bool, Parameter(name="--json", negative="")] = False,
    debug: _Flag = False,
) -> ExitCode:
    """Read an instruction and show the steps, what is stayed out of, or the word that refuses it.

    Args:
        text: The instruction. With --file, the mission may stand here instead.
        mission: A mission file: its map says which things there are, and its start where "come back" leads.
        file: Instructions to read, one a line; what follows a tab, and lines that begin with #, are left out.
        llm: Language model that may put what is refused into steps: embedded, endpoint, or a plug-in's. Default: none.
        json: Print one JSON object (with --file a list of them), and nothing else, on standard output.
        debug: Show the traceback of an error.
    """

    def work() -> ExitCode:
        from mintpilot.assembly.understanding import understand_instructions
        from mintpilot.core.errors import InputError

        where = mission if mission is not None or file is None or text is None else Path(text)
        if file is None and text is None:
            raise InputError("what is to be read? Give an instruction, or --file with one a line")
        read = understand_instructions(_lines(file) if file is not None else [text or ""], mission=where, llm=llm)
        if json:
            rows = [_row(one) for one in read]
            print(jsons.dumps(rows if file is not None else rows[0], ensure_ascii=False))
        else:
            print("\n".join(line for one in read for line in _told(one, with_text=file is not None)))
        return ExitCode.SUCCESS if file is not None or read[0].task is not None else ExitCode.WRONG_INPUT

    return guarded(work, as_json=json, debug=debug)


def _lines(file: Path) -> list[str]:
    from mintpilot.core.errors import InputError

    try:
        lines = file.read_text("utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"instructions {file} cannot be read ({error}): give a text file with one a line") from error
    texts = [line.partition("\t")[0].strip() for line in lines if not line.startswith("#")]
    return [text for text in texts if text]


def _row(one: UnderstoodInstruction) -> _Row:
    task = one.task
    steps = task.steps if task is not None else ()
    return _Row(
        text=one.text,
        steps=[
            {"n": s.n, "action": s.action, "target": s.target, "place": s.place, "text": str(s.text)} for s in steps
        ],
        keep_out=list(task.keep_out) if task is not None else [],
        rules=[str(rule.text) for rule in task.rules] if task is not None else [],
        slowly=task is not None and task.slowly,
        needs_confirmation=task is not None and task.needs_confirmation,
        refused=None if task is not None else _Refused(word=one.word, reason=one.reason),
    )


def _told(one: UnderstoodInstruction, *, with_text: bool) -> Iterator[str]:
    from mintpilot.core.task import step_lines

    if with_text:
        yield f"{one.text}"
    indent = "  " if with_text else ""
    if one.task is None:
        yield f"{indent}refused: {one.reason}"
        return
    yield from (f"{indent}{line}" for line in step_lines(one.task))
    if one.task.needs_confirmation:
        yield f"{indent}read by a language model: it is flown only after your yes"
