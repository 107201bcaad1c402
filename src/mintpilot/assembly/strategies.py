"""The one maker of strategies and objectives: by name, with the seed of the run and with arguments of their own."""

from __future__ import annotations

import difflib
import inspect
from collections.abc import Iterable, Mapping
from typing import Any, Final, TypeAlias, get_type_hints

from mintpilot.assembly.registry import load
from mintpilot.core.errors import InputError
from mintpilot.core.ports import QueryObjective, Strategy
from mintpilot.strategies.looking import MayLook
from mintpilot.strategies.priced import CountsPrice
from mintpilot.strategies.waiting import CountsWaiting
from mintpilot.strategies.within_limits import WithinLimits

Argument: TypeAlias = bool | int | float | str
"""What a strategy can be given by a mission file or on the command line."""
_SEED = "seed"
_SIMPLE: Final = {bool: "true or false", int: "a whole number", float: "a number", str: "a word"}


def make_strategy(name: str, *, seed: int, arguments: Mapping[str, Argument] | None = None) -> Strategy:
    """A fresh strategy. Used by missions, plans, the benchmark and the Gymnasium environment alike.

    Whatever bound on the work it meets, it decides on the cautious plan then (`WithinLimits`); it does not ask where
    waiting may lose more than an answer gives (`CountsWaiting`), or no policy is worth its price (`CountsPrice`); and
    it looks where that pays and tells more a second (`MayLook`).

    Args:
        name: as it is registered.
        seed: of the run; a strategy that draws at random takes it.
        arguments: the strategy's own, by the names of its constructor, e.g. ``{"quantile": 0.8}``.

    Raises:
        UnknownNameError: nobody registered that strategy.
        InputError: it takes no such argument, or not that value.
    """
    made: Strategy = _made("strategy", name, seed, arguments or {})
    return WithinLimits(MayLook(CountsWaiting(CountsPrice(made))))


def make_objective(name: str, *, seed: int) -> QueryObjective:
    """A fresh query objective; one that draws at random takes the seed of the run.

    Raises:
        UnknownNameError: nobody registered that objective.
    """
    made: QueryObjective = _made("objective", name, seed, {})
    return made


def strategy_label(name: str, arguments: Mapping[str, Argument] | None = None) -> str:
    """The strategy with its arguments, for records: ``knowno``, ``knowno quantile=0.8``."""
    return " ".join((name, *(f"{key}={value}" for key, value in sorted((arguments or {}).items()))))


def parse_arguments(words: Iterable[str]) -> dict[str, Argument]:
    """Arguments of a command line: each ``NAME=VALUE``; numbers and ``true`` or ``false`` are read as such.

    Raises:
        InputError: one of them is not of that form, or names an argument twice.
    """
    found: dict[str, Argument] = {}
    for word in words:
        name, equals, value = word.partition("=")
        if not equals or not name.isidentifier():
            raise InputError(f"--strategy-arg '{word}': write NAME=VALUE, e.g. quantile=0.8")
        if name in found:
            raise InputError(f"--strategy-arg '{word}': '{name}' is given twice; give it once")
        found[name] = _value(value)
    return found


def _value(text: str) -> Argument:
    if text in ("true", "false"):
        return text == "true"
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


def _made(port: str, name: str, seed: int, arguments: Mapping[str, Argument]) -> Any:
    kind = load(port, name)
    # A class that inherits its constructor from a protocol shows *args and **kwargs until it was called once.
    named = (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)
    taken = {key: one for key, one in inspect.signature(kind).parameters.items() if one.kind in named}
    hints = _hints(kind)
    known = [key for key in taken if key != _SEED and hints.get(key, str) in _SIMPLE]
    for key, value in arguments.items():
        _check(f"{port} '{name}'", key, value, known, hints.get(key))
    seeded = {_SEED: seed} if _SEED in taken else {}
    try:
        return kind(**seeded, **arguments)
    except (TypeError, ValueError) as error:
        if not arguments:
            raise
        raise InputError(f"{strategy_label(name, arguments)}: {error}; give other arguments") from error


def _check(what: str, key: str, value: Argument, known: list[str], wanted: object) -> None:
    if key == _SEED:
        raise InputError(f"{what} takes its seed from --seed; give no argument 'seed'")
    if key not in known:
        near = difflib.get_close_matches(key, known, n=1)
        hint = f" Did you mean '{near[0]}'?" if near else ""
        raise InputError(f"{what} takes no argument '{key}'.{hint} It takes: {', '.join(known) or '(none)'}.")
    fits = isinstance(value, int | float) and not isinstance(value, bool) if wanted is float else type(value) is wanted
    if wanted in _SIMPLE and not fits:
        raise InputError(f"{what}: argument {key} = {value!r}: must be {_SIMPLE[wanted]}")


def _hints(kind: type) -> dict[str, Any]:
    """Types of the constructor's parameters, as far as they can be told."""
    try:
        return get_type_hints(kind.__init__ if inspect.isclass(kind) else kind)
    except (NameError, TypeError, AttributeError):  # a stranger's annotations may be anything
        return {}
