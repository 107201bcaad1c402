"""``mintpilot doctor --audio``: whether questions can be asked aloud here, and answers heard."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict

import numpy as np

from mintpilot.assembly.registry import load
from mintpilot.cli.doctor import Finding
from mintpilot.cli.exits import ExitCode
from mintpilot.core.errors import MintPilotError
from mintpilot.core.geometry import Floats
from mintpilot.voice.audio import level_db
from mintpilot.voice.devices import PortAudioLink
from mintpilot.voice.echo import EchoCanceller

_WORD = "Confirm."
_LISTENS_S = 1.0
_QUIET_DB = -80.0
"""A microphone below this gives nothing: it is muted, decibels against full scale."""


def examine_audio(*, as_json: bool) -> ExitCode:
    """Tries each part and prints what was found; the exit code says whether something does not work."""
    findings = list(look())
    well = all(finding.ok for finding in findings)
    if as_json:
        report = {"schema_version": 1, "ok": well, "findings": [asdict(finding) for finding in findings]}
        print(json.dumps(report, ensure_ascii=False))
        return ExitCode.SUCCESS if well else ExitCode.MISSING_PART
    for finding in findings:
        print(f"{'ok     ' if finding.ok else 'absent '}  {finding.name:<22} {finding.found}")
        if finding.advice and not finding.ok:
            print(f"{'':<9}→ {finding.advice}")
    return ExitCode.SUCCESS if well else ExitCode.MISSING_PART


def look() -> Iterator[Finding]:
    """Speech, both recognisers with the word that was spoken, voice activity, echo, and the devices."""
    sound: Floats = np.zeros(0)

    def spoken() -> str:
        nonlocal sound
        sound = load("speech", "hibari")().say(_WORD)
        return f"hibari, {level_db(sound):.0f} dB"

    def heard(name: str) -> str:
        found = load("recogniser", name)().hypotheses(sound) if len(sound) else ()
        return f"{name} heard '{found[0].text}'" if found else f"{name} loads"

    yield _tried("speech", spoken)
    yield _tried("first recogniser", lambda: heard("moonshine"))
    yield _tried("second recogniser", lambda: heard("whisper"))
    yield _tried("voice activity", lambda: f"{load('activity', 'silero')().window} samples at a time")
    duplex = "cancelled" if EchoCanceller().is_full_duplex else "no canceller: deaf while the drone speaks"
    yield Finding(name="echo", ok=True, needed=False, found=duplex)
    yield _tried("microphone, speaker", lambda: _devices(sound))


def _tried(name: str, work: Callable[[], str]) -> Finding:
    try:
        return Finding(name=name, ok=True, needed=False, found=work())
    except MintPilotError as error:
        return Finding(name=name, ok=False, needed=False, found="does not work", advice=str(error))


def _devices(sound: Floats) -> str:
    link = PortAudioLink()
    try:
        link.play(sound, 0.0)
        time.sleep(_LISTENS_S)
        taken = link.listen(0.0)
    finally:
        link.close()
    level = level_db(np.concatenate(taken)) if taken else -120.0
    muted = " (muted?)" if level < _QUIET_DB else ""
    return f"open; the microphone gives {level:.0f} dB{muted}"
