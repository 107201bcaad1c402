"""The paper's real-world task through the whole chain. `python -m bench.boxes [--trials 20] [--seed 0] [--jobs 1]`."""

from __future__ import annotations

from statistics import median

from bench.experiments import Measured, arguments, failures, measure, results_table
from bench.sections import Section, Table, keep
from mintpilot.benchmark.experiments import boxes
from mintpilot.benchmark.records import Stages
from mintpilot.benchmark.summary import latency_s

STAGES = tuple(Stages.model_fields)
HOW = (
    "Scenario `medicine-boxes` with its defaults: three to eight boxes, one of which holds the medicine. The whole "
    "chain in MuJoCo: a survey flight with rendered RGB-D, perception, map, gaps, question, a scripted person who "
    "knows the truth, trajectory, flight. *Latency* runs from the instruction to the finished trajectories: one more "
    "picture perceived and drawn into the map, all deliberations, all wordings, the person's thinking (3 s for each "
    "question, stated, not waited for), the planning of all legs. The survey flight comes before the instruction and "
    "is not in it, nor is speech. The paper's 20.7 s is from start to completion of "
    "planned trajectories on a real drone, with speech and large models in the loop: only the order of magnitude "
    "compares."
)


def section(measured: Measured, command: str) -> Section:
    """The section of docs/results.md."""
    rows = []
    for method in (m.name for m in measured.experiment.cells[0].methods):
        flown = [t for t in measured.of(method) if t.flown_m > 0]
        if flown:
            shares = [[getattr(t.stages_s, stage) for t in flown] for stage in STAGES]
            totals = [latency_s(t.stages_s) for t in flown]
            rest = [latency_s(t.stages_s) - t.stages_s.answer for t in flown]
            words = [f"{median(values):.2f} / {max(values):.2f}" for values in (*shares, totals, rest)]
            rows.append((method, str(len(flown)), *words))
    latency = Table(
        caption="Seconds from instruction to finished trajectories: median / worst",
        header=("method", "n", *STAGES, "all", "all without thinking"),
        rows=rows,
    )
    mint = measured.of("mint")
    worst = max((latency_s(t.stages_s) - t.stages_s.answer for t in mint), default=0.0)
    notes = [
        f"`mint`: {sum(t.success for t in mint)} of {len(mint)} succeed; at most {worst:.2f} s from instruction to "
        "trajectories without thinking time.",
        "The passive baseline takes the first of the equally likely boxes, `passive-mixture` draws one: both find the "
        "right one with one over the number of boxes. The paper's 35 % would be about three boxes in each arrangement.",
        *failures(measured, "mint"),
    ]
    notes += [measured.throughput] if measured.throughput else []
    return Section(
        name="31-boxes",
        title="Which box holds the medicine",
        command=command,
        how=HOW,
        tables=[results_table(measured), latency],
        notes=notes,
    )


def main() -> None:
    """Measures, and keeps the section."""
    args = arguments(__doc__, (("trials", 20),))
    measured = measure(boxes(trials=args.trials, seed=args.seed, vehicle="mujoco"), args.jobs)
    made = section(measured, f"python -m bench.boxes --trials {args.trials} --seed {args.seed} --jobs {args.jobs}")
    print(made.markdown()) if args.dry else keep(made)


if __name__ == "__main__":
    main()
