"""Free answers: what may be taken plainly, what is read back, what is asked again (method, section 12)."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mintpilot.assembly.sample_question import sample_question
from mintpilot.core.errors import UnknownNameError
from mintpilot.core.gap import GapKind
from mintpilot.core.query import Order, Reply
from mintpilot.core.reading import AnsweredBy, Reading, ReadingKind, guarded_replies, possible_values
from mintpilot.language.answer_text import LONGEST
from mintpilot.language.answer_words import ANSWER_WORDS, LISTED
from mintpilot.language.answers import read_answer

LANGS = ("en", "de", "fr", "es")
QUESTIONS = {(kind, lang): sample_question(GapKind(kind), lang=lang)
             for kind in ("obstacle", "presence", "target") for lang in LANGS}  # fmt: skip
GUARDED = {"obstacle": {Reply.YES}, "presence": {Reply.NO}, "target": {Reply.YES, Reply.NO}}
VETO_WORDS = {
    "en": "not never toxic dangerous burning maybe probably think unless if only yesterday soon some half heard says "
    "why but careful without wasn't don't kidding wrong",
    "de": "nicht nie giftig gefährlich brennt vielleicht glaube wenn falls nur gestern bald halb angeblich warum aber",
    "fr": "pas jamais toxique dangereux peut-être crois si sauf seulement hier bientôt moitié paraît pourquoi mais",
    "es": "nunca tóxico peligroso quizás creo salvo solo ayer pronto mitad dicen quién pero casi",
}
"""Written out here, not taken from the package: the words that a person would stumble over."""


def read(
    text: str, kind: str = "obstacle", lang: str = "en", by: str = "typed", pending: Reply | None = None
) -> Reading:
    return read_answer(
        text, QUESTIONS[kind, lang], guarded=GUARDED[kind], lang=lang, by=AnsweredBy(by), pending=pending
    )


def takes_guarded(reading: Reading, kind: str) -> bool:
    plain = reading.kind in (ReadingKind.YES, ReadingKind.NO, ReadingKind.READ_BACK)
    return plain and reading.reply in GUARDED[kind]


kinds, langs = st.sampled_from(sorted(GUARDED)), st.sampled_from(LANGS)
ways = st.sampled_from(["typed", "voice"])


def closed(lang: str) -> list[str]:
    known = ANSWER_WORDS[lang]
    return "|".join((known.yes, known.no, known.passable, known.absent)).split("|")


@st.composite
def said(draw: st.DrawFn, lang: str) -> str:
    """Something like an answer: phrases of the closed lists and courtesies, in any order and case."""
    phrases = [*closed(lang), *ANSWER_WORDS[lang].courtesies.split("|"), QUESTIONS["obstacle", lang].text.strip("?¿ ")]
    parts = draw(st.lists(st.sampled_from(phrases), min_size=1, max_size=4))
    text = draw(st.sampled_from([" ", ", ", ". "])).join(parts)
    return draw(st.sampled_from([text, text.upper(), text.capitalize(), f"{text}!", f"  {text} "]))


@given(st.data(), kinds, langs, ways)
def test_a_veto_word_anywhere_forbids_every_guarded_reply(data, kind, lang, by) -> None:
    words = data.draw(said(lang)).split(" ")
    at = data.draw(st.integers(0, len(words)))
    veto = data.draw(st.sampled_from(VETO_WORDS[lang].split()))
    text = " ".join([*words[:at], veto, *words[at:]])
    assert not takes_guarded(read(text, kind, lang, by), kind), text


@given(
    st.data(),
    kinds,
    langs,
    ways,
    st.sampled_from(["?", " ?", " 🚫", "☠️", " (lol)", "…", "...", "\x1b", "\u200b", "\u0336", '"']),
)
def test_a_question_or_an_unknown_mark_at_the_end_keeps_nothing_accepted(data, kind, lang, by, mark) -> None:
    text = data.draw(said(lang)) + mark
    assert not takes_guarded(read(text, kind, lang, by), kind), text


@given(
    st.text(max_size=400), kinds, langs, st.sampled_from(list(AnsweredBy)), st.sampled_from([None, Reply.YES, Reply.NO])
)
def test_any_text_is_read_without_an_error(text, kind, lang, by, pending) -> None:
    assert read(text, kind, lang, by, pending).label


@given(st.text(alphabet=st.characters(categories=["L", "Z"]), min_size=1, max_size=12), kinds, langs, ways)
def test_a_strange_word_beside_a_yes_or_no_is_asked_again(strange, kind, lang, by) -> None:
    words = ANSWER_WORDS[lang]
    listed = " ".join((*closed(lang), words.fillers, words.courtesies, QUESTIONS[kind, lang].text))
    known = set(listed.casefold().replace("'", " ").replace("|", " ").split())
    if set(strange.casefold().split()) <= known | {"over"}:
        return
    for reply in (ANSWER_WORDS[lang].yes.split("|")[2], ANSWER_WORDS[lang].no.split("|")[1]):
        assert not takes_guarded(read(f"{reply} {strange}", kind, lang, by), kind)


@pytest.mark.parametrize("lang", LANGS)
def test_the_closed_lists_are_short_and_have_no_entry_twice(lang) -> None:
    assert len(closed(lang)) <= LISTED == 60
    assert len(set(closed(lang))) == len(closed(lang))
    orders = "|".join(ANSWER_WORDS[lang].orders.values()).split("|")
    assert len(orders) <= LISTED
    assert len(set(orders)) == len(orders)
    assert set(ANSWER_WORDS[lang].orders) == set(Order)


@pytest.mark.parametrize("lang", LANGS)
def test_every_entry_of_the_closed_lists_is_taken_when_typed_and_read_back_when_spoken(lang) -> None:
    known = ANSWER_WORDS[lang]
    for kind, reply, entries in (
        ("obstacle", Reply.YES, f"{known.yes}|{known.passable}"),
        ("presence", Reply.NO, f"{known.no}|{known.absent}"),
        ("target", Reply.YES, known.yes),
        ("target", Reply.NO, known.no),
    ):
        for entry in entries.split("|"):
            assert read(entry, kind, lang).label == reply.value, entry
            assert read(entry, kind, lang, "voice").label == f"read-back:{reply.value}", entry


@given(st.data(), kinds, langs)
def test_speech_never_settles_a_guarded_reply_at_once(data, kind, lang) -> None:
    reading = read(data.draw(said(lang)), kind, lang, "voice")
    assert reading.kind not in (ReadingKind.YES, ReadingKind.NO) or reading.reply not in GUARDED[kind]


@given(langs, langs, st.data())
def test_only_the_questions_language_is_taken(asked, spoken, data) -> None:
    entry = data.draw(st.sampled_from(closed(spoken)))
    if entry in closed(asked):
        return
    assert read(entry, "obstacle", asked).kind is not ReadingKind.YES


@pytest.mark.parametrize(
    ("text", "kind", "lang", "label"),
    [
        ("yes it is safe to fly through, thanks", "obstacle", "en", "read-back:yes"),
        ("well okay, it's fine", "obstacle", "en", "read-back:yes"),
        ("ja, der graue Rauch ist harmlos, danke", "obstacle", "de", "read-back:yes"),
        ("No, nobody, thank you", "presence", "en", "read-back:no"),
        ("bon, la pièce est vide, merci", "presence", "fr", "read-back:no"),
        ("okay", "obstacle", "en", "again"),
        ("roger", "obstacle", "en", "again"),
        ("copy that", "obstacle", "en", "again"),
        ("10-4", "obstacle", "en", "again"),
        ("wilco, go ahead", "obstacle", "en", "again"),
        ("one third of it is safe", "obstacle", "en", "again"),
        ("the nurse tells me yes", "obstacle", "en", "again"),
        ("our crew is fine", "obstacle", "en", "again"),
        ("climb over it", "obstacle", "en", "again"),
        ("yes, hornets live there", "obstacle", "en", "again"),
        ("yes 💀", "obstacle", "en", "again"),
        ("nobody, except one plumber", "presence", "en", "yes"),
        ("nobody told me anything", "presence", "en", "again"),
        ("the fridge is empty", "presence", "en", "again"),
        ("that stuff is poisonous", "obstacle", "en", "no"),
        ("no way, toxic!", "obstacle", "en", "no"),
        ("don't go in there", "obstacle", "en", "no"),
        ("das ist giftig!", "obstacle", "de", "no"),
        ("es toxico", "obstacle", "es", "no"),
        ("c’est dangereux", "obstacle", "fr", "no"),
        ("it isn't dangerous", "obstacle", "en", "again"),
        ("no problem, fly on", "obstacle", "en", "again"),
        ("two men are in there", "presence", "en", "yes"),
        ("hay dos personas", "presence", "es", "yes"),
        ("ich weiß es leider nicht", "obstacle", "de", "unsure"),
        ("?", "obstacle", "en", "unsure"),
        ("stop please", "presence", "en", "order:hold"),
        ("Komm zurück!", "target", "de", "order:return"),
        ("atterris", "obstacle", "fr", "order:land"),
        ("continúa", "obstacle", "es", "order:continue"),
        ("abort the mission", "obstacle", "en", "order:abort"),
        ("we must stop at the bakery", "obstacle", "en", "again"),
        ("land?", "obstacle", "en", "again"),
        ("stand by", "obstacle", "en", "wait"),
        ("which one?", "target", "en", "where"),
        ("zeig mir ein Bild", "obstacle", "de", "show"),
        ("pourquoi ?", "obstacle", "fr", "why"),
        ("say again please", "obstacle", "en", "repeat"),
        ("", "obstacle", "en", "again"),
        ("y" * (LONGEST + 1), "obstacle", "en", "again"),
    ],
)
def test_what_is_said_decides_the_reading(text, kind, lang, label) -> None:
    assert read(text, kind, lang).label == label


@pytest.mark.parametrize(
    ("text", "lang", "label"),
    [
        ("the blue one", "en", "evidence:colour=blue"),
        ("not the red one", "en", "evidence:colour!=red"),
        ("Not the red one, the blue one.", "en", "evidence:colour!=red,colour=blue"),
        ("I mean the big box please", "en", "evidence:size=large"),
        ("no, the small one", "en", "evidence:colour!=red,size=small"),
        ("box 3", "en", "evidence:id=box-3"),
        ("die große", "de", "evidence:size=large"),
        ("nein, die blaue", "de", "evidence:colour=blue"),
        ("pas la rouge, la bleue", "fr", "evidence:colour!=red,colour=blue"),
        ("no la roja", "es", "evidence:colour!=red"),
        ("no, la azul", "es", "evidence:colour=blue"),
        ("the green one", "en", "again"),
        ("red or blue", "en", "again"),
        ("the large red one", "en", "again"),
        ("yes, the blue one", "en", "again"),
        ("the blue one, I think", "en", "again"),
        ("not the small red one", "en", "again"),
        ("big deal", "en", "again"),
        ("the red one 🙃", "en", "again"),
    ],
)
def test_attributes_count_by_closed_patterns(text, lang, label) -> None:
    assert read(text, "target", lang).label == label


def test_evidence_leaves_the_candidates_that_it_fits() -> None:
    question = QUESTIONS["target", "en"]
    assert possible_values(read("the small blue one", "target"), question) == ("box-3",)
    assert possible_values(read("not the red one", "target"), question) == ("box-2", "box-3")


def test_a_no_without_a_comma_in_spanish_speech_is_ambiguous() -> None:
    assert read("no la azul", "target", "es", "voice").kind is not ReadingKind.EVIDENCE


@pytest.mark.parametrize(
    ("text", "kind", "by", "pending", "label"),
    [
        ("yes", "obstacle", "typed", Reply.YES, "yes"),
        ("yes", "obstacle", "voice", Reply.YES, "again"),
        ("Confirm.", "obstacle", "voice", Reply.YES, "yes"),
        ("yes", "presence", "typed", Reply.NO, "no"),
        ("confirm", "presence", "voice", Reply.NO, "no"),
        ("yes please, it is fine", "obstacle", "typed", Reply.YES, "again"),
        ("confirm?", "obstacle", "voice", Reply.YES, "again"),
        ("confirm, I think", "obstacle", "voice", Reply.YES, "again"),
        ("no", "obstacle", "typed", Reply.YES, "no"),
        ("no", "presence", "typed", Reply.NO, "yes"),
        ("nobody", "presence", "typed", Reply.NO, "again"),
        ("no", "target", "typed", Reply.YES, "again"),
        ("No, thank you", "target", "typed", Reply.YES, "again"),
        ("wait, it is toxic", "obstacle", "typed", Reply.YES, "no"),
        ("stop", "obstacle", "voice", Reply.YES, "order:hold"),
        ("y", "obstacle", "key", Reply.YES, "yes"),
        ("n", "presence", "key", Reply.NO, "yes"),
    ],
)
def test_a_read_back_is_confirmed_by_a_plain_yes_only(text, kind, by, pending, label) -> None:
    assert read(text, kind, "en", by, pending).label == label


@given(st.data(), kinds, langs, st.sampled_from([Reply.YES, Reply.NO]), ways)
def test_nothing_but_a_listed_word_confirms(data, kind, lang, pending, by) -> None:
    text = data.draw(said(lang))
    reading = read(text, kind, lang, by, pending)
    if reading.reply is pending and pending in GUARDED[kind]:
        bare = " ".join(text.casefold().translate(str.maketrans(",.!-", "    ")).split())
        assert bare in [w.replace("-", " ") for w in ANSWER_WORDS[lang].yes.split("|")]
        assert by == "typed"


@pytest.mark.parametrize(
    ("key", "lang", "label"),
    [("y", "en", "yes"), ("n", "en", "no"), ("?", "en", "unsure"), ("j", "de", "yes"), ("o", "fr", "yes"),
     ("s", "es", "yes"), ("2", "en", "option:2"), ("j", "en", "again"), ("yes it is", "en", "again"),
     ("5", "en", "again")],
)  # fmt: skip
def test_keys(key, lang, label) -> None:
    assert read(key, "obstacle", lang, "key").label == label


def test_the_vetoes_are_told() -> None:
    assert read("yes, if the fire is out ☠").vetoes == ("if", "fire", "☠")
    assert read("ｙｅｓ").vetoes == ("unusual letters",)


def test_an_unknown_language_is_refused() -> None:
    with pytest.raises(UnknownNameError, match="tlh"):
        read_answer("yes", QUESTIONS["obstacle", "en"], guarded=(), lang="tlh")


def test_the_guard_follows_from_the_query() -> None:
    assert {kind: guarded_replies(QUESTIONS[kind, "en"]) for kind in GUARDED} == GUARDED
