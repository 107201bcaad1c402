"""Who was found: people seen in pictures, and rooms in which somebody is said to be."""

from __future__ import annotations

from mintpilot.core.message import Message, Named, message
from mintpilot.core.mission import Sight
from mintpilot.core.observation import PERSON
from mintpilot.recording.frames import FRAMES, frame_name
from mintpilot.recording.record import LookRecord, MissionRecord, Part, SeenRecord
from mintpilot.wording.speech import Speech


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
    people, speech = people_of(record), Speech(record.language)
    lines = []
    if people.found:
        one = message("1 person seen")
        seen = one if people.found == 1 else message("{count} people seen", count=people.found)
        lines.append(": ".join(filter(None, (speech(seen), ", ".join(people.pictures)))))
    if people.reported == 1:
        lines.append(speech(message("somebody is inside of 1 room, by what was answered")))
    elif people.reported:
        rooms = message("somebody is inside of {count} rooms, by what was answered", count=people.reported)
        lines.append(speech(rooms))
    return lines


def look_line(look: LookRecord, lang: str = "en") -> str:
    """What a look into a room came to, as a clause."""
    return ": ".join([look.text, Speech(lang)(_came_to(look)), *filter(None, [", ".join(look.pictures)])])


def _came_to(look: LookRecord) -> Message:
    person, what = look.what == PERSON, Named(look.what)
    match look.result:
        case Sight.UNSEEN:
            return message("it could not be seen (through {share:.0%} of the doorway)", share=look.seen or 0.0)
        case Sight.EMPTY if person:
            return message("nobody is there")
        case Sight.EMPTY if look.what:
            return message("no {what} was seen there", what=what)
        case Sight.EMPTY:
            return message("nothing is there")
        case Sight.FOUND if person and look.count == 1:
            return message("found 1 person")
        case Sight.FOUND if person:
            return message("found {count} people", count=look.count)
    return (
        message("found {count}: {what}", count=look.count, what=what)
        if look.what
        else message("found {count}", count=look.count)
    )


def people_seen(record: MissionRecord) -> list[SeenRecord]:
    """Those that the drone saw."""
    return [seen for seen in record.seen if seen.kind == "object" and seen.state == PERSON]
