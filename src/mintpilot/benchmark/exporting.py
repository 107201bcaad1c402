"""Tables of an experiment as files that papers and notebooks read: CSV and LaTeX."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from typing import Final, Literal, TypeAlias

from mintpilot.benchmark.experiment import Experiment
from mintpilot.benchmark.summary import Interval, Row, Summary
from mintpilot.benchmark.tables import HEADER, row_words

Format: TypeAlias = Literal["csv", "latex"]
_ESCAPED: Final = str.maketrans(
    {
        "\\": r"\textbackslash{}",
        "{": r"\{",
        "}": r"\}",
        "%": r"\%",
        "&": r"\&",
        "#": r"\#",
        "_": r"\_",
        "$": r"\$",
        "~": r"\textasciitilde{}",
        "^": r"\textasciicircum{}",
    }
)


def as_csv(folders: Sequence[tuple[Experiment, Summary]]) -> str:
    """One line for each method and setting, with every figure of it; intervals are two columns, ``_low`` and ``_high``.

    Args:
        folders: experiments with what their records come to.
    """
    lines = [_flat(experiment, row) for experiment, summary in folders for row in summary.rows]
    columns = list(dict.fromkeys(name for line in lines for name in line))
    text = io.StringIO()
    writer = csv.DictWriter(text, columns, restval="", lineterminator="\n")
    writer.writeheader()
    writer.writerows(lines)
    return text.getvalue()


def as_latex(folders: Sequence[tuple[Experiment, Summary]]) -> str:
    """One ``tabular`` for each setting, for the package ``booktabs``; brackets are 95 % intervals."""
    tables = []
    for experiment, summary in folders:
        for cell in experiment.cells:
            rows = [row for row in summary.rows if row.cell == cell.name]
            if rows:
                title = f"{experiment.name}, {experiment.vehicle}" + (f", {cell.name}" if cell.name else "")
                tables.append(_tabular(title, rows))
    return "\n".join(tables)


def _flat(experiment: Experiment, row: Row) -> dict[str, str | int | float]:
    """A row without nesting: what is not known is left empty."""
    flat: dict[str, str | int | float] = {"experiment": experiment.name, "vehicle": experiment.vehicle}
    for name in Row.model_fields:
        value: str | int | float | Interval | dict[str, int] | dict[str, float] | None = getattr(row, name)
        if isinstance(value, tuple):
            flat[f"{name}_low"], flat[f"{name}_high"] = value
        elif isinstance(value, dict):
            flat.update({f"{name}_{key}": entry for key, entry in value.items()})
        elif value is not None:
            flat[name] = value
    return flat


def _tabular(title: str, rows: Sequence[Row]) -> str:
    body = [" & ".join(_escaped(word) for word in row_words(row)) + r" \\" for row in rows]
    return "\n".join(
        (
            f"% {title}",
            rf"\begin{{tabular}}{{l{'r' * (len(HEADER) - 1)}}}",
            r"\toprule",
            " & ".join(_escaped(name) for name in HEADER) + r" \\",
            r"\midrule",
            *body,
            r"\bottomrule",
            r"\end{tabular}",
            "",
        )
    )


def _escaped(text: str) -> str:
    return text.translate(_ESCAPED)
