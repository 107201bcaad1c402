"""Sound that is clipped, silent, odd, truncated or too much; model files that are missing or altered."""

from __future__ import annotations

import os
import wave
from pathlib import Path

import numpy as np
import pytest

from mintpilot.core.errors import InputError, MissingPartError
from mintpilot.core.geometry import Floats
from mintpilot.voice.audio import clean, from_pcm, read_wav, trimmed, write_wav
from mintpilot.voice.devices import link_to
from mintpilot.voice.doubles import ActivityDouble, RecogniserDouble, SpeechDouble
from mintpilot.voice.echo import FRAME, EchoCanceller
from mintpilot.voice.hearing import FLOOD_S, Ear, Listener, Segmenter, Utterance
from mintpilot.voice.models import check, checked_files
from mintpilot.voice.mouth import aloud
from mintpilot.voice.ports import RATE_HZ, Hypothesis, Recogniser
from mintpilot.voice.rotor import mixed, rotor_noise

TONE_HZ = 440.0


def _wav(path: Path, *, rate_hz: int, width: int, channels: int, seconds: float = 0.5) -> Path:
    t_s = np.arange(int(seconds * rate_hz)) / rate_hz
    values = (0.5 * np.sin(2 * np.pi * TONE_HZ * t_s) * (2 ** (8 * width - 1) - 1)).astype(np.int64)
    data = b"".join((int(v) + (128 if width == 1 else 0)).to_bytes(width, "little", signed=width > 1) * channels
                    for v in values)  # fmt: skip
    with wave.open(str(path), "wb") as file:
        file.setparams((channels, width, rate_hz, 0, "NONE", ""))
        file.writeframes(data)
    return path


@pytest.mark.parametrize("rate_hz", [8_000, 16_000, 44_100])
@pytest.mark.parametrize(("width", "channels"), [(1, 1), (2, 2), (3, 1), (3, 2), (4, 1)])
def test_any_usual_wav_becomes_the_same_tone(tmp_path: Path, rate_hz: int, width: int, channels: int) -> None:
    samples = read_wav(_wav(tmp_path / "a.wav", rate_hz=rate_hz, width=width, channels=channels))
    assert len(samples) == pytest.approx(0.5 * RATE_HZ, abs=2)
    strongest = np.argmax(np.abs(np.fft.rfft(samples))) * RATE_HZ / len(samples)
    assert strongest == pytest.approx(TONE_HZ, abs=3)
    assert np.abs(samples[1000:-1000]).max() == pytest.approx(0.5, abs=0.03)


def test_a_truncated_file_is_read_as_far_as_it_goes(tmp_path: Path) -> None:
    path = _wav(tmp_path / "a.wav", rate_hz=RATE_HZ, width=2, channels=1)
    path.write_bytes(path.read_bytes()[:-4001])
    assert 5000 < len(read_wav(path)) < 6001


@pytest.mark.parametrize("data", [b"", b"RIFF", b"not sound at all" * 9])
def test_what_is_no_sound_is_refused_by_name(tmp_path: Path, data: bytes) -> None:
    (tmp_path / "a.wav").write_bytes(data)
    with pytest.raises(InputError, match=r"a\.wav"):
        read_wav(tmp_path / "a.wav")


def test_an_empty_recording_is_refused(tmp_path: Path) -> None:
    write_wav(tmp_path / "a.wav", np.zeros(0))
    with pytest.raises(InputError, match="no sound"):
        read_wav(tmp_path / "a.wav")


def test_samples_that_are_no_numbers_or_beyond_full_scale_are_made_harmless() -> None:
    made = clean(np.array([np.nan, np.inf, -np.inf, 7.0, 0.25]))
    assert made.tolist() == [0.0, 1.0, -1.0, 1.0, 0.25]
    assert len(from_pcm(b"\x00\x01\x02")) == 1


def _listener(texts: tuple[str, ...] = ("yes", "no")) -> Listener:
    return Listener(Ear(first=RecogniserDouble(texts), second=RecogniserDouble(texts)), ActivityDouble())


def _said(text: str, after_s: float = 0.6) -> Floats:
    return np.concatenate([SpeechDouble().say(text), np.zeros(int(after_s * RATE_HZ))])


@pytest.mark.parametrize("piece", [37, 160, 512, 16_000])
def test_words_are_heard_however_the_sound_is_cut(piece: int) -> None:
    sound, listener = np.concatenate([np.zeros(8000), _said("no"), _said("yes")]), _listener()
    heard = [h for i in range(0, len(sound), piece) for h in listener.feed(sound[i : i + piece])]
    assert [(h.text, h.second, h.is_sure) for h in heard] == [("no", "no", True), ("yes", "yes", True)]
    assert heard[0].began == pytest.approx(8000, abs=600)


def test_silence_and_clipped_noise_that_never_ends_give_no_text() -> None:
    assert _listener().feed(np.zeros(5 * RATE_HZ)) == []
    loud = np.sign(np.random.default_rng(1).standard_normal(9 * RATE_HZ))
    (heard,) = _listener().feed(np.concatenate([loud, np.zeros(RATE_HZ)]))
    assert (heard.text, heard.is_sure) == ("", False)


def test_two_people_at_once_are_not_sure_or_not_read_alike() -> None:
    both = SpeechDouble().say("yes") + SpeechDouble().say("no")
    listener = Listener(
        Ear(first=RecogniserDouble(("yes",)), second=RecogniserDouble(("no",))), ActivityDouble()
    )  # fmt: skip
    (heard,) = listener.feed(np.concatenate([both, np.zeros(RATE_HZ)]))
    assert (heard.text, heard.second) == ("yes", "no")


@pytest.mark.parametrize(
    ("text", "lang", "said"),
    [
        ("2.5 m high, 3 s longer.", "en", "2.5 metres high, 3 seconds longer."),
        ("3 s länger", "de", "3 Sekunden länger"),
        ("at 4 m/s, 3 m", "en", "at 4 m/s, 3 metres"),
    ],
)
def test_units_are_said_in_words(text: str, lang: str, said: str) -> None:
    assert aloud(text, lang) == said


def test_silence_around_speech_is_cut_and_silence_alone_is_left() -> None:
    quiet, speech = np.zeros(RATE_HZ), 0.3 * np.ones(1000)
    assert 1000 <= len(trimmed(np.concatenate([quiet, speech, quiet]))) <= 1000 + RATE_HZ // 10
    assert len(trimmed(quiet)) == RATE_HZ
    assert len(trimmed(np.zeros(0))) == 0


def test_a_pipe_is_heard_as_it_fills_and_may_be_odd_or_closed(tmp_path: Path) -> None:
    path = tmp_path / "pipe"
    os.mkfifo(path)
    link = link_to(path)
    assert list(link.listen(0.0)) == []
    writer = os.open(path, os.O_WRONLY)
    try:
        os.write(writer, b"\x00\x40\x00")
        (first,) = link.listen(0.1)
        os.write(writer, b"\xc0")
        (second,) = link.listen(0.2)
        assert (first.tolist(), second.tolist()) == ([0.5], [-0.5])
    finally:
        os.close(writer)
    assert list(link.listen(0.3)) == []
    link.play(np.zeros(RATE_HZ), 1.0)
    assert (link.is_playing(1.5), link.is_playing(2.5)) == (True, False)
    link.close()
    link.close()


def test_a_recording_takes_the_place_of_a_microphone(tmp_path: Path) -> None:
    write_wav(tmp_path / "a.wav", 0.5 * np.ones(RATE_HZ))
    link = link_to(tmp_path / "a.wav")
    heard = np.concatenate([piece for time_s in (0.0, 0.25, 0.5, 5.0) for piece in link.listen(time_s)])
    assert float(heard.sum()) == pytest.approx(0.5 * RATE_HZ, rel=1e-3)
    with pytest.raises(InputError, match=r"missing\.wav"):
        link_to(tmp_path / "missing.wav")


class _Says(Recogniser):
    """Gives a free text, and probabilities of short words."""

    def __init__(self, text: str, **words: float) -> None:
        scored = (Hypothesis(text=word, probability=p) for word, p in words.items())
        self._found = (Hypothesis(text=text, probability=0.9), *scored)

    def hypotheses(self, samples: Floats) -> tuple[Hypothesis, ...]:
        return self._found


@pytest.mark.parametrize(
    ("first", "second", "text", "is_sure"),
    [
        (_Says("In front.", confirm=0.12), _Says("confirm.", confirm=0.9), "confirm", True),
        (_Says("Confirm.", confirm=0.9), _Says("Comfort.", confirm=0.001), "Confirm.", False),
        (_Says("Confirm.", confirm=0.9), _Says("No.", confirm=0.3, no=0.6), "Confirm.", False),
        (_Says("Can form.", confirm=0.09, no=0.3), _Says("No.", confirm=0.02, no=0.9), "no", True),
        (_Says("Yes.", yes=0.9), _Says("Yes, but it is hot.", yes=0.0), "Yes.", False),
        (_Says("the red one", yes=0.0), _Says("The red one.", yes=0.0), "the red one", True),
    ],
)
def test_a_short_word_is_heard_where_both_find_it_likely_and_no_other_more_so(
    first: _Says, second: _Says, text: str, is_sure: bool
) -> None:
    heard = Ear(first=first, second=second).hear(Utterance(samples=np.zeros(RATE_HZ), began=0))
    assert (heard.text, heard.is_sure) == (text, is_sure)


def test_what_was_written_down_is_kept_so_that_stop_is_never_lost() -> None:
    ear = Ear(first=_Says("Yes.", yes=0.9), second=_Says("Stop.", yes=0.3, stop=0.6))
    heard = ear.hear(Utterance(samples=np.zeros(RATE_HZ), began=0))
    assert (heard.text, heard.written) == ("yes", ("Yes.", "Stop."))


def test_a_microphone_that_floods_is_bounded_and_counted() -> None:
    segmenter = Segmenter(ActivityDouble())
    segmenter.feed(np.zeros(int((FLOOD_S + 60) * RATE_HZ)))
    assert segmenter.dropped_s == pytest.approx(60)
    assert [u.is_too_long for u in segmenter.feed(_said("yes"))] == [False]


@pytest.mark.parametrize("snr_db", [20.0, 0.0])
def test_rotor_noise_has_the_power_and_the_harmonics_that_it_should(snr_db: float) -> None:
    rng = np.random.default_rng(5)
    speech = 0.05 * rng.standard_normal(RATE_HZ)
    noise = mixed(speech, snr_db, np.random.default_rng(2)) - speech
    measured = 10 * np.log10(np.mean(speech**2) / np.mean(noise**2))
    assert measured == pytest.approx(snr_db, abs=0.01)
    power = np.abs(np.fft.rfft(rotor_noise(4 * RATE_HZ, rng))) ** 2
    hz = np.arange(len(power)) / 4
    assert power[(hz > 140) & (hz < 220)].mean() > 20 * power[(hz > 3000) & (hz < 6000)].mean()


def test_model_files_that_are_missing_or_altered_are_refused_by_name(tmp_path: Path) -> None:
    with pytest.raises(MissingPartError, match="mintpilot"):
        checked_files("no_such_speech_package", {})
    with pytest.raises(MissingPartError, match=r"model\.bin"):
        check(tmp_path, {"model.bin": "0" * 64})
    (tmp_path / "model.bin").write_bytes(b"altered")
    with pytest.raises(InputError, match=r"SHA-256 is [0-9a-f]{64}, 0{64} it must be"):
        check(tmp_path, {"model.bin": "0" * 64})


def test_without_a_canceller_the_drone_is_deaf_while_it_speaks_and_shortly_after() -> None:
    echo, voice = EchoCanceller(is_full_duplex=False), 0.3 * np.ones(FRAME)
    assert not echo.process(voice, voice).any()
    assert not echo.process(voice, np.zeros(FRAME)).any()
    for _ in range(40):
        heard = echo.process(voice, np.zeros(FRAME))
    assert heard.any()


@pytest.mark.long
@pytest.mark.parametrize("delay_ms", [20, 60, 120])
def test_the_drones_own_speech_is_taken_out_of_the_microphone(delay_ms: int) -> None:
    pytest.importorskip("livekit")
    rng, frames = np.random.default_rng(4), 300
    own = 0.2 * rng.standard_normal(frames * FRAME) * np.repeat(rng.uniform(0.2, 1, frames), FRAME)
    leak = 0.5 * np.concatenate([np.zeros(delay_ms * RATE_HZ // 1000), own])[: len(own)]
    echo = EchoCanceller(is_full_duplex=True)
    left = np.concatenate(
        [echo.process(leak[i : i + FRAME], own[i : i + FRAME]) for i in range(0, len(own), FRAME)]
    )  # fmt: skip
    late = slice(200 * FRAME, None)
    assert np.mean(left[late] ** 2) < 0.01 * np.mean(leak[late] ** 2)
