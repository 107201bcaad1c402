"""Think about a mission on a map of your own: what is not known, what would be asked, and why. No simulator needed.

python examples/plan_own_map.py
"""

from pathlib import Path

from mintpilot.assembly.api import plan_mission

mission = Path(__file__).parent / "my-building" / "mission.yaml"
report = plan_mission(mission)

for gap in report.gaps:
    weight = "matters" if gap.critical else "does not matter"
    print(f"{gap.description}: {weight}. {gap.why}")

print()
if report.query is None:
    print(f"Nothing to ask: {report.certificate}")
else:
    print(f"First question: {report.query.text}")
    print(f"  yes means: {report.query.yes_means}; no means: {report.query.no_means}")
print(f"Questions to be expected: {report.expected_questions:.2f} for {len(report.gaps)} gaps")
