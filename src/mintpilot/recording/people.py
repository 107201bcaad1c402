"""Who was found: people seen in pictures, and rooms in which somebody is said to be."""

from __future__ import annotations

from mintpilot.core.mission import Sight
from mintpilot.core.observation import PERSON
from mintpilot.recording.frames import FRAMES, frame_name
from mintpilot.recording.record import LookRecord, MissionRecord, Part, SeenRecord
from mintpilot.recording.spoken import PERSONS, SIGHTS


class PeopleSummary(Part):
    """People of one mission."""

    found: int
    """Seen by the drone, each counted once. Doubtful ones are questions, and are not counted."""
    reported: int
    """Rooms in which somebody is by what an operator said; whether the drone saw them or not."""
    pictures: tuple[str, ...]
    """The best picture of each who was found, in the run folder; none where no run folder was written."""


def people_of(record: MissionRecord) -> PeopleSummary:
    """Counts the people of a record."""
    found = people_seen(record)
    return PeopleSummary(
        found=len(found),
        reported=sum(seen.kind == "room" and seen.state == "yes" for seen in record.seen),
        pictures=tuple(f"{FRAMES}/{frame_name(s.view[0])}" for s in found if s.view) if record.run_dir else (),
    )


def people_lines(record: MissionRecord) -> list[str]:
    """Who was found, in sentences, with the pictures that show them; nothing where nobody was."""
    people = people_of(record)
    lines = []
    if people.found:
        shown = f": {', '.join(people.pictures)}" if people.pictures else ""
        lines.append(f"{people.found} {'person' if people.found == 1 else 'people'} seen{shown}")
    if people.reported:
        rooms = "1 room" if people.reported == 1 else f"{people.reported} rooms"
        lines.append(f"somebody is inside of {rooms}, by what was answered")
    return lines


def look_line(look: LookRecord, lang: str = "en") -> str:
    """What a look into a room came to, as a clause."""
    person = look.what == PERSON
    if lang in SIGHTS:
        what = PERSONS[lang][look.count > 1] if person else look.what
        said = SIGHTS[lang][look.result].format(count=look.count, what=what, share=f"{look.seen or 0:.0%}").strip()
        return f"{look.text}: {': '.join([said, *([', '.join(look.pictures)] if look.pictures else [])])}"
    match look.result:
        case Sight.UNSEEN:
            found = f"it could not be seen (through {look.seen or 0:.0%} of the doorway)"
        case Sight.EMPTY:
            found = (
                "nobody is there" if person else f"no {look.what} was seen there" if look.what else "nothing is there"
            )
        case Sight.FOUND:
            what = ("person" if look.count == 1 else "people") if person else look.what or "thing"
            shown = f": {', '.join(look.pictures)}" if look.pictures else ""
            found = f"found {look.count} {what}{'s' if look.count > 1 and not person else ''}{shown}"
    return f"{look.text}: {found}"


def people_seen(record: MissionRecord) -> list[SeenRecord]:
    """Those that the drone saw."""
    return [seen for seen in record.seen if seen.kind == "object" and seen.state == PERSON]
