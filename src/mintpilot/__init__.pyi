from mintpilot.assembly.api import plan_mission as plan_mission
from mintpilot.assembly.api import run_mission as run_mission
from mintpilot.assembly.deliberation_report import DeliberationReport as DeliberationReport
from mintpilot.assembly.validation import check_mission as check_mission
from mintpilot.mission_file.reader import read_mission as read_mission
from mintpilot.mission_file.schema import MissionFile as MissionFile
from mintpilot.recording.record import MissionRecord as MissionRecord
from mintpilot.recording.record import read_record as read_record

__version__: str
