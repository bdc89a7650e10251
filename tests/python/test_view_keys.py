"""The live page without a pointer: cursors, zoom, plan and jog by keys."""

from __future__ import annotations

from pathlib import Path

import pytest
import takt
from machines import machine_with, new_url, running
from pages import (
    PATIENCE_S,
    TWO_ON_A_LOOP,
    column,
    needs_chromium,
    opened,
    row,
    served,
    until,
    wait_for_cycle,
)
from playwright.sync_api import Browser, expect

pytestmark = needs_chromium
expect.set_options(timeout=PATIENCE_S * 1000)


def test_cursors_and_zoom(tmp_path: Path, browser: Browser) -> None:
    url = new_url()
    with (
        running(tmp_path, url, machine=machine_with("{axis_rate_hz: 1000}")),
        served(url) as address,
        opened(browser, address, "#tab=scope&signals=x.set_position") as page,
        takt.connect(url) as session,
    ):
        wait_for_cycle(page, session.cycle)
        wait_for_cycle(page, column(page, "x.set_position")[0][0] + 1500)
        page.select_option("#span", "1")
        cursors = lambda: page.evaluate("() => [window.takt.scope.a, window.takt.scope.b]")  # noqa: E731
        window = lambda: page.evaluate("() => { const s = window.takt.scope.shown(); return [s.from, s.to]; }")  # noqa: E731
        span = lambda: float(page.locator("#span").input_value())  # noqa: E731

        # While it runs the window gets shorter and longer.
        before = span()
        page.keyboard.press("+")
        assert span() < before
        page.keyboard.press("-")
        assert span() == before
        assert not page.evaluate("() => window.takt.scope.paused")

        page.keyboard.press("ArrowRight")  # there is no cursor yet
        assert cursors() == [None, None]
        page.keyboard.press("b")  # and no B without A
        assert page.evaluate("() => window.takt.scope.paused")
        begin, end = window()
        middle = cursors()[0]
        assert middle == pytest.approx((begin + end) / 2, abs=1)
        page.keyboard.press("b")
        page.keyboard.press("ArrowRight")
        page.keyboard.press("Shift+ArrowRight")
        step = round((end - begin) / 10)
        assert cursors() == [middle, middle + 1 + step]
        expect(page.locator("#measured thead")).to_contain_text("least between")
        page.keyboard.press("a")
        page.keyboard.press("ArrowLeft")
        assert cursors() == [middle - 1, middle + 1 + step]

        # About the cursor that was picked: it stays where it is on the screen.
        page.keyboard.press("+")
        closer = window()
        assert closer[1] - closer[0] == pytest.approx(0.8 * (end - begin))
        place = (middle - 1 - begin) / (end - begin)
        assert (middle - 1 - closer[0]) / (closer[1] - closer[0]) == pytest.approx(place)
        for _ in range(8):
            page.keyboard.press("Shift+ArrowLeft")  # the window goes along
        assert window()[0] <= cursors()[0] <= window()[1]
        assert window()[0] < closer[0]

        # Not where something is typed.
        page.click("#filter")
        at = cursors()
        page.keyboard.press("ArrowLeft")
        page.keyboard.press("a")
        assert cursors() == at
        assert page.locator("#filter").input_value() == "a"


def test_cursors_and_zoom_stay_where_there_is_something_to_see(tmp_path: Path, browser: Browser) -> None:
    url = new_url()
    with (
        running(tmp_path, url, machine=machine_with("{axis_rate_hz: 1000}")),
        served(url) as address,
        opened(browser, address, "#tab=scope&signals=x.set_position") as page,
        takt.connect(url) as session,
    ):
        wait_for_cycle(page, session.cycle)
        wait_for_cycle(page, column(page, "x.set_position")[0][0] + 1500)
        cursor = lambda: page.evaluate("() => window.takt.scope.a")  # noqa: E731
        window = lambda: page.evaluate("() => { const s = window.takt.scope.shown(); return [s.from, s.to]; }")  # noqa: E731

        # Soon after the start most of the window is empty.
        page.keyboard.press("a")
        cycles = page.evaluate("() => [...[...window.takt.scope.held.store.series.values()][0].cycles]")
        first, last = cycles[0], cycles[-1]
        held = window()
        assert held[0] < first
        assert cursor() == pytest.approx((first + last) / 2, abs=1)

        # No further than the samples, and the window no further than it was or than they are.
        for key, end in (("Shift+ArrowLeft", first), ("Shift+ArrowRight", last)):
            for _ in range(30):
                page.keyboard.press(key)
            assert cursor() == end
        for _ in range(30):
            page.keyboard.press("-")
        assert window() == pytest.approx(held, abs=1)

        # A cursor that was left out of sight comes back.
        page.evaluate("([from, to]) => window.takt.scope.setZoom(from, to)", [first, first + 200])
        page.keyboard.press("ArrowLeft")
        begin, end = window()
        assert begin <= cursor() == last - 1 <= end
        assert end - begin == 200
        page.evaluate("([from, to]) => window.takt.scope.setZoom(from, to)", [first, first + 200])
        page.keyboard.press("+")  # which is about what is seen
        assert window() == pytest.approx([first + 20, first + 180])
        page.keyboard.press("a")
        begin, end = window()
        assert begin <= cursor() <= end


def test_keys_go_to_the_scope_after_clicks(tmp_path: Path, browser: Browser) -> None:
    """But what the keyboard itself has reached keeps them."""
    url = new_url()
    with (
        running(tmp_path, url, machine=machine_with("{axis_rate_hz: 1000}")),
        served(url) as address,
        opened(browser, address, "#tab=scope&signals=x.set_position") as page,
        takt.connect(url) as session,
    ):
        wait_for_cycle(page, session.cycle)
        paused = lambda: page.evaluate("() => window.takt.scope.paused")  # noqa: E731
        shown = lambda: page.evaluate("() => window.takt.scope.signals.map((signal) => signal.name)")  # noqa: E731

        page.fill("#filter", "x.set_velocity")
        page.locator("#signals .row:visible", has_text="set velocity").first.click()
        assert shown() == ["x.set_position", "x.set_velocity"]
        page.keyboard.press(" ")
        assert paused()
        assert shown() == ["x.set_position", "x.set_velocity"]
        page.click("#pause")
        assert not paused()

        for select, choice in (("#span", "5"), ("#trigger-mode", "normal")):
            page.locator(select).dispatch_event("pointerdown", {"bubbles": True})
            page.focus(select)
            page.select_option(select, choice)
            page.keyboard.press("a")
            assert paused()
            assert page.evaluate("() => window.takt.scope.a") is not None
            page.keyboard.press("Escape")
            page.keyboard.press(" ")
            assert not paused()

        # Reached by Tab a row is toggled again and again, and a select goes from choice to choice.
        page.focus("#filter")
        page.keyboard.press("Tab")
        page.keyboard.press("Tab")
        for names in (["x.set_position"], ["x.set_position", "x.set_velocity"]):
            page.keyboard.press(" ")
            assert shown() == names
        page.focus("#span")
        page.keyboard.press("ArrowDown")
        page.keyboard.press("ArrowDown")
        assert page.locator("#span").input_value() == "20"
        assert not paused()


def test_the_plan(tmp_path: Path, browser: Browser) -> None:
    (tmp_path / "machine.yaml").write_text("name: plane\naxes: []\n" + TWO_ON_A_LOOP)
    with (
        served(str(tmp_path / "machine.yaml"), "--pace", "paced") as address,
        opened(browser, address, "#tab=plan") as page,
    ):
        until(page, "() => window.takt.plan.camera")
        camera = lambda: page.evaluate("() => ({ ...window.takt.plan.camera, w: window.takt.plan.width })")  # noqa: E731
        first = camera()
        page.keyboard.press("ArrowRight")
        page.keyboard.press("ArrowUp")
        moved = camera()
        assert moved["x"] - first["x"] == pytest.approx(0.1 * first["w"] / first["scale"])
        assert moved["y"] > first["y"]
        page.keyboard.press("+")
        assert camera()["scale"] == pytest.approx(first["scale"] / 0.8)
        page.keyboard.press("-")
        assert camera()["scale"] == pytest.approx(first["scale"])
        page.keyboard.press("0")
        until(page, "() => window.takt.plan.camera")
        assert camera()["x"] == pytest.approx(first["x"], abs=1)


@pytest.mark.parametrize("ends", ["the key is let go", "the focus is lost"])
def test_jogging(ends: str, tmp_path: Path, browser: Browser) -> None:  # EN-23
    url = new_url()
    machine = machine_with("{dead_man_s: 60}") + "view: {commands: true}\n"
    with (
        running(tmp_path, url, machine=machine),
        served(url) as address,
        opened(browser, address) as page,
        takt.connect(url) as session,
    ):
        x = session.axis("x")
        row(page, "x").click()
        page.click("#details-commands button:text-is('On')")
        session.wait(lambda: x.state is takt.PlcState.STANDSTILL, 10.0)
        page.fill("#details-commands input", "12")
        page.locator("#details-commands button", has_text="jog ▶").focus()
        page.keyboard.down(" ")
        session.wait(lambda: x.set_velocity == pytest.approx(12.0), 10.0)
        session.run(0.5)
        assert x.set_velocity == pytest.approx(12.0)
        if ends == "the key is let go":
            page.keyboard.up(" ")
        else:
            page.locator("#details-commands input").focus()
        session.wait(lambda: x.state is takt.PlcState.STANDSTILL, 10.0)
