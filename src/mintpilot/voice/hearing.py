"""From pieces of sound to what was heard: voice activity, two recognisers, and rejection."""

from __future__ import annotations

from collections import deque
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.voice.audio import clean
from mintpilot.voice.ports import RATE_HZ, WORDS, Activity, Hypothesis, Recogniser

_CONFIRMS = frozenset(("confirm", "confirmed"))
FLOOD_S = 30.0
"""Sound that waits to be looked at; what is older is dropped and counted, seconds."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HearingSettings:
    """When sound counts as an utterance, and when its text counts."""

    starts_at: float = 0.5
    """Probability of speech from which an utterance begins."""
    ends_at: float = 0.3
    """Probability below which it may end."""
    silence_s: float = 0.4
    """It ends after so much without speech."""
    shortest_s: float = 0.12
    """Shorter ones are noises."""
    longest_s: float = 6.0
    """Longer ones are no answer: the television, or a microphone that floods."""
    before_s: float = 0.25
    """Sound kept from before its beginning."""
    confidence: float = 0.02
    """Least product of both recognisers' probabilities of one of `mintpilot.voice.ports.WORDS`."""
    freely: float = 0.4
    """Least probability of each recogniser's free text, which must be read alike."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Utterance:
    """One stretch of speech."""

    samples: Floats
    """(n,) at `RATE_HZ`."""
    began: int
    """Number of its first sample of speech, counted from the beginning of listening."""
    is_too_long: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Hearing:
    """What was heard of one utterance. Both texts must be read alike for it to mean anything."""

    text: str
    """Of the first recogniser; empty where nothing was recognised."""
    second: str
    """Of the second recogniser, whose disagreement is a veto. The same word where both find it likely enough."""
    probability: float
    """The product of both recognisers' probabilities."""
    is_sure: bool
    """Whether that is enough, and the utterance is not too long."""
    began: int
    """Number of its first sample of speech, counted from the beginning of listening."""
    duration_s: float
    written: tuple[str, str] = ("", "")
    """What each wrote down by itself, whatever was decided: an order to hold counts if one of them did."""


@dataclass(slots=True)
class Segmenter:
    """Cuts utterances out of pieces of sound of any length. Keeps a bounded amount."""

    activity: Activity
    settings: HearingSettings = HearingSettings()
    dropped_s: float = 0.0
    """Sound that was thrown away because it came faster than it could be looked at, seconds."""
    _rest: Floats = field(default_factory=lambda: np.zeros(0))
    _seen: int = 0
    _before: deque[Floats] = field(default_factory=deque)
    _current: list[Floats] = field(default_factory=list)
    _began: int = 0
    _quiet_s: float = 0.0
    _spoken_s: float = 0.0

    @property
    def is_speech(self) -> bool:
        """Whether an utterance is going on that is more than a click."""
        return self._spoken_s >= self.settings.shortest_s

    def feed(self, samples: Floats) -> list[Utterance]:
        """The utterances that end in this piece."""
        piece = np.concatenate([self._rest, clean(samples)])
        extra = len(piece) - int(FLOOD_S * RATE_HZ)
        if extra > 0:
            self.dropped_s += extra / RATE_HZ
            self._seen += extra
            self._reset()
            piece = piece[extra:]
        found = []
        window = self.activity.window
        whole = len(piece) // window * window
        for start in range(0, whole, window):
            ended = self._window(piece[start : start + window])
            found += [ended] if ended is not None else []
        self._rest = piece[whole:]
        return found

    def _window(self, window: Floats) -> Utterance | None:
        settings, seconds = self.settings, len(window) / RATE_HZ
        probability = self.activity.probability(window)
        begins = not self._current and probability >= settings.starts_at
        if begins:
            self._began, self._current = self._seen, [*self._before]
        self._seen += len(window)
        self._before.append(window)
        while len(self._before) * seconds > settings.before_s:
            self._before.popleft()
        if not self._current and not begins:
            return None
        if sum(map(len, self._current)) < settings.longest_s * RATE_HZ:
            self._current.append(window)
        is_quiet = probability < settings.ends_at
        self._quiet_s = self._quiet_s + seconds if is_quiet else 0.0
        self._spoken_s += 0.0 if is_quiet else seconds
        if self._quiet_s < settings.silence_s:
            return None
        samples, spoken_s, began = np.concatenate(self._current), self._spoken_s, self._began
        is_too_long = (self._seen - began) / RATE_HZ - self._quiet_s > settings.longest_s
        self._reset()
        if spoken_s < settings.shortest_s:
            return None
        return Utterance(samples=samples, began=began, is_too_long=is_too_long)

    def _reset(self) -> None:
        self._current, self._quiet_s, self._spoken_s = [], 0.0, 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Ear:
    """Recognises utterances twice, and says how sure it is.

    A short word is heard where the product of its two probabilities is enough and greater than that of every other
    word: each recogniser can veto, and neither has to write the word down; but nothing is confirmed where one of them
    writes another short word. Any other text must come freely from both.
    """

    first: Recogniser
    second: Recogniser
    settings: HearingSettings = HearingSettings()

    def hear(self, utterance: Utterance) -> Hearing:
        """What was heard. Too long an utterance is not looked at.

        Raises:
            DeviceError: a recogniser failed.
        """
        ours, theirs = ((), ()) if utterance.is_too_long else self._both(utterance.samples)
        text, second, probability, is_sure = self._decided(ours, theirs)
        return Hearing(
            text=text,
            second=second,
            probability=probability,
            is_sure=is_sure,
            began=utterance.began,
            duration_s=len(utterance.samples) / RATE_HZ,
            written=(ours[0].text if ours else "", theirs[0].text if theirs else ""),
        )

    def _both(self, samples: Floats) -> tuple[tuple[Hypothesis, ...], tuple[Hypothesis, ...]]:
        """Of both recognisers, at the same time; nothing of the second where the first heard nothing."""
        with ThreadPoolExecutor(1, thread_name_prefix="mintpilot second recogniser") as pool:
            second = pool.submit(self.second.hypotheses, samples)
            ours = self.first.hypotheses(samples)
            theirs = second.result()
        return ours, theirs if ours else ()

    def _decided(self, ours: tuple[Hypothesis, ...], theirs: tuple[Hypothesis, ...]) -> tuple[str, str, float, bool]:
        mine, other = _of_words(ours), _of_words(theirs)
        both = {word: mine[word] * other[word] for word in mine.keys() & other.keys()}
        best = max(sorted(both), key=lambda word: both[word], default="")
        free = [found[0] if found else Hypothesis(text="", probability=0.0) for found in (ours, theirs)]
        written = {_word(h.text) for h in free} & {*WORDS}
        is_confirmation = best in _CONFIRMS
        if best and both[best] >= self.settings.confidence and not (is_confirmation and written - _CONFIRMS):
            return best, best, both[best], True
        is_sure = not written and all(h.probability >= self.settings.freely for h in free)
        return free[0].text, free[1].text, free[0].probability * free[1].probability, is_sure


def _of_words(found: tuple[Hypothesis, ...]) -> dict[str, float]:
    """The probability of each short word; where it was not scored, that of the free text that it is."""
    scored: dict[str, float] = {}
    for hypothesis in found:
        word = _word(hypothesis.text)
        if word in WORDS:
            scored[word] = hypothesis.probability
    return scored


def _word(text: str) -> str:
    return text.strip(" .,!").casefold()


class Listener:
    """Takes sound at `RATE_HZ` in pieces of any length, and gives what was heard: for a browser's microphone.

    Args:
        ear: recognises.
        activity: tells speech from other sound.

    Call `feed` on a thread that may wait: it recognises at once, which takes up to about a second.
    """

    def __init__(self, ear: Ear, activity: Activity) -> None:
        self._ear = ear
        self._segmenter = Segmenter(activity, ear.settings)

    @property
    def is_speech(self) -> bool:
        """Whether somebody is speaking at the end of what came."""
        return self._segmenter.is_speech

    def feed(self, samples: Floats) -> list[Hearing]:
        """What was heard of the utterances that end in this piece; see `mintpilot.voice.audio.from_pcm` for packets.

        Raises:
            DeviceError: a recogniser failed.
        """
        return [self._ear.hear(utterance) for utterance in self._segmenter.feed(samples)]
