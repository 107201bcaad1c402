"""Voice at the web page: sound from and to a browser, for the same operator as with a microphone of this machine."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TYPE_CHECKING

from mintpilot.assembly.registry import load
from mintpilot.assembly.talk import Talk
from mintpilot.assembly.voiced import hears_here, speech_for
from mintpilot.core.errors import MintPilotError, MissingPartError
from mintpilot.core.geometry import Floats
from mintpilot.core.inputs import OperatorInput
from mintpilot.core.ports import Operator
from mintpilot.core.query import Question
from mintpilot.voice.audio import from_pcm, to_pcm16
from mintpilot.voice.operator import VoiceOperator, VoiceParts
from mintpilot.voice.ports import RATE_HZ, SoundLink, Speech

if TYPE_CHECKING:
    from mintpilot.console.microphone import Microphone


class PageSound(SoundLink):
    """Sound in and out of the browser that answers; it cancels the echo itself, or is half-duplex."""

    def __init__(self, page: Microphone) -> None:
        self._page = page
        self._until_s = 0.0

    def play(self, samples: Floats, time_s: float) -> None:
        """See `SoundLink.play`."""
        self._until_s = time_s + len(samples) / RATE_HZ
        self._page.play(to_pcm16(samples))

    def stop(self) -> None:
        """See `SoundLink.stop`."""
        self._until_s = 0.0
        self._page.stop()

    def is_playing(self, time_s: float) -> bool:
        """See `SoundLink.is_playing`."""
        return time_s < self._until_s

    def listen(self, time_s: float) -> Sequence[Floats]:  # noqa: ARG002
        """See `SoundLink.listen`."""
        came = self._page.collect()
        return [from_pcm(came)] if came else []

    def close(self) -> None:
        """Nothing to give back."""


class PageVoice(Operator):
    """Sleeps until a browser's microphone is on; then asks and hears beside the page, by the rules for voice.

    Args:
        page: the microphone of the page.
        talk: the mission's words.
        make: the parts that speak and hear; they are loaded on a thread when they are first needed.
    """

    def __init__(
        self, page: Microphone, talk: Talk, *, make: Callable[[SoundLink, str], VoiceParts] | None = None
    ) -> None:
        self._page, self._talk, self._make = page, talk, make or page_parts
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="mintpilot page voice")
        self._loading: Future[VoiceParts] | None = None
        self._operator: VoiceOperator | None = None
        self._open: tuple[Question, float] | None = None
        self._is_awake = False

    @property
    def attended(self) -> bool:
        """False: whether somebody sits there the page itself says."""
        return False

    @property
    def hears_once(self) -> bool:
        """Whether questions are being said there."""
        return self._is_awake

    def show(self, question: Question, patience_s: float) -> None:
        """Said at once, or when the microphone is switched on."""
        self._open = (question, patience_s)
        if self._operator is not None and self._is_awake:
            self._operator.show(question, patience_s)

    def withdraw(self, question: str, why: str) -> None:
        """Falls silent about it."""
        if self._open is not None and self._open[0].id == question:
            self._open = None
        if self._operator is not None:
            self._operator.withdraw(question, why)

    def tell(self, text: str) -> None:
        """Said if the microphone is on."""
        if self._operator is not None and self._is_awake:
            self._operator.tell(text)

    def poll(self, time_s: float) -> tuple[OperatorInput, ...]:
        """What was heard; nothing while the microphone is off, or the recognisers are being loaded."""
        operator = self._ready() if self._page.is_on else None
        if operator is None:
            if self._is_awake and self._operator is not None and self._open is not None:
                self._operator.withdraw(self._open[0].id, "the microphone is off")
            self._is_awake = False
            return ()
        operator.settings.muted = not self._page.is_aloud
        if not self._is_awake:
            self._is_awake = True
            if self._open is not None:
                operator.show(*self._open)
        return operator.poll(time_s)

    def close(self) -> None:
        """Ends threads and processes. Safe to call again."""
        self._pool.shutdown(wait=True, cancel_futures=True)
        if self._operator is not None:
            self._operator.close()

    def _ready(self) -> VoiceOperator | None:
        if self._operator is not None or (self._loading is not None and not self._loading.done()):
            return self._operator
        if self._loading is None:
            self._page.show(problem="Speech recognition is being loaded.")
            self._loading = self._pool.submit(self._make, PageSound(self._page), self._talk.lang)
            return None
        loaded, self._loading = self._loading, None
        try:
            parts = loaded.result()
        except MintPilotError as error:
            self._page.show(problem=f"Nothing can be heard: {error}")
            self._page.switch(False)
            return None
        self._page.show(problem="")
        self._operator = VoiceOperator(
            parts,
            understand=self._talk.understand,
            order_of=self._talk.order_of,
            caption=lambda text: self._page.show(said=text, heard=""),
            heard=lambda text: self._page.show(heard=text),
            lang=self._talk.lang,
            has_screen=True,
        )
        return self._operator


def page_parts(link: SoundLink, lang: str) -> VoiceParts:
    """The installed parts; without speech there are captions only.

    Raises:
        MissingPartError: a recogniser is not installed; the message says how to get it.
        InputError: a model file is not the pinned one.
    """
    ear, activity = hears_here(), load("activity", "silero")()
    try:
        speech: Speech | None = speech_for(lang)
    except MissingPartError:
        speech = None
    return VoiceParts(speech=speech, ear=ear, activity=activity, link=link)
