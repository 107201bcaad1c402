"""The page in a real browser."""

from __future__ import annotations

from dataclasses import replace

import pytest

from mintpilot import run_mission
from mintpilot.cli.demos import demo_path
from mintpilot.console import Role
from mintpilot.core.inputs import Answered, Ordered
from mintpilot.core.query import Order, Reply, Standing

from .pages import ASKED, SECOND, WHICH, console, opened, poll_until, ready, stays_here

pytestmark = pytest.mark.xdist_group("browser")


def axe(page) -> list[str]:
    """What axe-core finds, as one line each."""
    from axe_playwright_python.sync_playwright import Axe

    found = Axe().run(page).response["violations"]
    return [f"{v['id']}: {v['nodes'][0]['html'][:160]}" for v in found]


@pytest.mark.long
def test_a_flown_mission_is_shown_and_nothing_leaves_the_machine(browser):
    with console() as one:
        run_mission(demo_path("fire-warehouse"), vehicle="kinematic", progress=one.record)
        with opened(browser, one.url(Role.WATCH), bypass_csp=True) as seen:
            page = seen.page
            page.wait_for_selector(".verdict")
            page.wait_for_selector("#steps li.done")
            page.click("#reasons summary h2")
            page.wait_for_selector(".tree .node")
            assert page.locator("#gaps li").count() >= 2
            assert page.locator("#gaps li.asked").count() >= 1
            assert page.locator("#log li.line-answer").count() >= 1
            assert "east" in page.get_attribute("#map", "aria-label")
            colours = page.evaluate(
                "() => new Set(new Uint32Array(document.querySelector('#map').getContext('2d')"
                ".getImageData(0, 0, 600, 300).data.buffer)).size"
            )
            assert colours > 5
            assert axe(page) == []
            assert seen.errors == []
            assert stays_here(seen, one)


@pytest.mark.long
def test_clicks_keys_and_words_answer(browser):
    with console() as one, opened(browser, one.url()) as seen:
        page = seen.page
        one.show(ASKED, 30.0)
        ready(page)
        assert page.inner_text("#card .text") == ASKED.text
        assert ASKED.yes_means in page.inner_text("#card .yes")
        page.click("#card .answer.no")
        clicked = poll_until(one, seen.page, lambda e: isinstance(e, Answered))
        assert (clicked.question, clicked.answer.reply, clicked.answer.by) == ("q1", Reply.NO, "key")
        one.withdraw("q1", "it was answered")
        page.wait_for_selector("#card", state="hidden")

        one.show(SECOND, 30.0)
        ready(page)
        page.keyboard.press("y")
        pressed = poll_until(one, seen.page, lambda e: isinstance(e, Answered))
        assert (pressed.question, pressed.answer.reply) == ("q2", Reply.YES)
        one.withdraw("q2", "it was answered")

        one.show(ASKED, 30.0)
        ready(page)
        page.fill("#words", "it is safe, fly through it")
        page.keyboard.press("Enter")
        said = poll_until(one, seen.page, lambda e: isinstance(e, Answered))
        assert said.answer.by == "typed"
        one.show(replace(ASKED, read_back=replace(said.answer, reply=Reply.YES, standing=Standing.UNCONFIRMED)), 20.0)
        page.wait_for_selector(".understood")
        page.locator("#ask").focus()
        page.wait_for_timeout(650)
        page.keyboard.press("y")
        confirmed = poll_until(one, seen.page, lambda e: isinstance(e, Answered))
        assert (confirmed.answer.reply, confirmed.answer.standing) == (Reply.YES, Standing.CONFIRMED)

        page.click("#orders .hold")
        assert poll_until(one, seen.page, lambda e: isinstance(e, Ordered)).order is Order.HOLD
        assert seen.errors == []
        assert stays_here(seen, one)


@pytest.mark.slow
def test_this_one_is_an_answer(browser):
    with console() as one, opened(browser, one.url()) as seen:
        one.show(WHICH, 30.0)
        ready(seen.page)
        seen.page.click(".candidates li:nth-child(2) button")
        meant = poll_until(one, seen.page, lambda e: isinstance(e, Answered))
        assert meant.answer.standing is Standing.UNCONFIRMED
        assert meant.answer.also


@pytest.mark.slow
def test_planted_markup_stays_text(browser):
    planted = "<img src=x onerror=\"document.title='owned'\"><script>document.title='owned'</script>"
    gap = replace(ASKED.gaps[0], description=planted)
    with console() as one, opened(browser, one.url()) as seen:
        one.tell(planted)
        one.show(replace(ASKED, text=planted, yes_means=planted, no_means=planted, gaps=(gap,)), 30.0)
        ready(seen.page)
        assert seen.page.inner_text("#card .text") == planted
        assert seen.page.locator("#card img, #card script, #log img, #log script").count() == 0
        assert seen.page.title() != "owned"
        one.withdraw("q1", planted)
        seen.page.wait_for_selector("#card", state="hidden")
        assert seen.page.locator("img").count() == 0
        assert seen.errors == []


@pytest.mark.long
def test_a_lost_link_is_said_and_loses_no_answer(browser):
    links, down = [], []

    def through(link) -> None:
        if down:
            link.close()
            return
        link.connect_to_server()
        links.append(link)

    with (
        console() as one,
        opened(browser, one.url(), before=lambda page: page.route_web_socket("**/live", through)) as seen,
    ):
        page = seen.page
        one.show(ASKED, 60.0)
        ready(page)
        down.append(True)
        links[-1].close()
        page.wait_for_selector("#link.lost")
        assert "LINK LOST" in page.inner_text("#link")
        page.keyboard.press("n")
        assert one.poll(1.0) == () or all(not isinstance(e, Answered) for e in one.poll(1.0))
        down.clear()
        answered = poll_until(one, seen.page, lambda e: isinstance(e, Answered))
        assert answered.answer.reply is Reply.NO
        page.wait_for_selector("#link.up", state="attached")
        assert page.inner_text("#link") == ""


@pytest.mark.long
def test_what_was_pressed_without_a_link_survives_a_reload_and_goes_to_no_other_mission(browser):
    down = [True]
    before = lambda page: page.route_web_socket(  # noqa: E731
        "**/live", lambda link: link.close() if down and links else links.append(link.connect_to_server())
    )
    links: list[object] = []
    with console() as one, opened(browser, one.url(), before=before) as seen:
        page = seen.page
        one.show(ASKED, 60.0)
        ready(page)
        links[-1].close()
        page.wait_for_selector("#link.lost")
        page.keyboard.press("n")
        page.reload()
        down.clear()
        assert poll_until(one, page, lambda e: isinstance(e, Answered)).answer.reply is Reply.NO
        waiting = "() => Object.entries(sessionStorage).filter(([key]) => key.startsWith('waiting'))"
        page.wait_for_timeout(500)
        assert page.evaluate(waiting) == [[f"waiting {one.url().split('#')[1]}", "[]"]]


@pytest.mark.slow
def test_a_reload_shows_the_question_again_and_keeps_the_seat(browser):
    with console() as one, opened(browser, one.url()) as seen:
        one.show(ASKED, 60.0)
        ready(seen.page)
        seen.page.reload()
        ready(seen.page)
        seen.page.keyboard.press("n")
        assert poll_until(one, seen.page, lambda e: isinstance(e, Answered)).answer.reply is Reply.NO


@pytest.mark.slow
def test_a_second_browser_watches_and_takes_over_explicitly(browser):
    with console() as one, opened(browser, one.url()) as first, opened(browser, one.url()) as second:
        first.page.wait_for_selector("#role.on")
        one.show(ASKED, 60.0)
        second.page.wait_for_selector("#card .answer.yes:disabled")
        second.page.keyboard.press("y")
        second.page.click("#seat")
        ready(second.page)
        first.page.wait_for_selector("#card .answer.yes:disabled")
        second.page.keyboard.press("n")
        assert poll_until(one, second.page, lambda e: isinstance(e, Answered)).answer.reply is Reply.NO


@pytest.mark.slow
def test_a_watcher_cannot_answer_and_a_wrong_token_sees_nothing(browser):
    with console() as one:
        one.show(ASKED, 60.0)
        with opened(browser, one.url(Role.WATCH)) as watcher:
            watcher.page.wait_for_selector("#card .answer.yes:disabled")
            assert watcher.page.locator("#orders button:not(:disabled)").count() == 0
        with opened(browser, one.url().split("#")[0] + "#wrong") as stranger:
            stranger.page.wait_for_selector("#link.refused")
            assert not stranger.page.is_visible("#card")
        assert all(not isinstance(event, Answered | Ordered) for event in one.poll(1.0))


@pytest.mark.slow
@pytest.mark.parametrize("lang", ["en", "de", "fr", "es"])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_telephone_shows_all_of_it(browser, lang, scheme):
    size = {"width": 360, "height": 740}
    with console() as one, opened(browser, one.url(), viewport=size, color_scheme=scheme, bypass_csp=True) as seen:
        page = seen.page
        one.show(ASKED, 60.0)
        ready(page)
        page.select_option("#lang", lang)
        assert page.evaluate("() => document.documentElement.scrollWidth") <= 360
        page.evaluate("() => { document.documentElement.style.fontSize = '200%' }")
        assert page.evaluate("() => document.documentElement.scrollWidth") <= 360, "twice as large"
        page.evaluate("() => { document.documentElement.style.fontSize = '' }")
        for button in page.locator("#card .answer, #orders button").all():
            assert button.bounding_box()["height"] >= 40
        assert axe(page) == []
        assert seen.errors == []
