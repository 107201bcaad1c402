"""Calibrates the conformal asker for 1 to 8 gaps and keeps the quantiles. `python -m bench.calibrate [--worlds N]`."""

from __future__ import annotations

import argparse

from bench.sections import ROOT
from mintpilot.benchmark.calibration import COVERAGE, FIRST_SEED, WORLDS, Calibration, calibrate
from mintpilot.benchmark.experiment import Cell
from mintpilot.benchmark.experiments import MOST_GAPS, gap_parameters

FILE = ROOT / "src" / "mintpilot" / "benchmark" / "knowno.json"


def main() -> None:
    """Writes the file; prints each quantile as it is found."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--worlds", type=int, default=WORLDS)
    parser.add_argument("--dry", action="store_true", help="print only")
    args = parser.parse_args()
    quantiles = {}
    for k in range(1, MOST_GAPS + 1):
        cell = Cell(scenario="fire-warehouse", parameters=gap_parameters(k), methods=())
        quantiles[str(k)] = round(calibrate(cell, args.worlds), 6)
        print(f"k = {k}: q = {quantiles[str(k)]}", flush=True)
    made = Calibration(
        command=f"python -m bench.calibrate --worlds {args.worlds}",
        coverage=COVERAGE,
        worlds=args.worlds,
        first_seed=FIRST_SEED,
        quantiles=quantiles,
    )
    if not args.dry:
        FILE.write_text(made.model_dump_json(indent=1) + "\n")


if __name__ == "__main__":
    main()
