"""The live page in a real browser: values against the engine's, trigger, cursors, connections that break."""

from __future__ import annotations

import contextlib
import re
from pathlib import Path

import numpy as np
import pytest
import takt
from machines import MACHINE, machine_with, new_url, running
from pages import (
    PATIENCE_S,
    TWO_ON_A_LOOP,
    column,
    free_port,
    needs_chromium,
    opened,
    row,
    served,
    until,
    wait_for_cycle,
)
from playwright.sync_api import Browser, expect
from portals import PORTAL

pytestmark = needs_chromium

FULL_RATE = machine_with("{axis_rate_hz: 1000, dead_man_s: 0.5}")
expect.set_options(timeout=PATIENCE_S * 1000)

SAW = (Path(__file__).parents[2] / "python" / "examples" / "flying_saw" / "machine.yaml").read_text()
PLANE = "name: plane\naxes: []\n" + TWO_ON_A_LOOP


def test_values_are_the_engines(tmp_path: Path, browser: Browser) -> None:
    url = new_url()
    chosen = "#tab=scope&signals=x.set_position,x.actual_velocity,x.state,r.set_position"
    with (
        running(tmp_path, url, machine=FULL_RATE),
        served(url) as address,
        opened(browser, address, chosen) as page,
        takt.connect(url) as session,
    ):
        x = session.axis("x")
        until(page, "() => window.takt.scope.store.series.size === 2")
        wait_for_cycle(page, 1)
        record = session.record()
        x.power().wait()
        x.move_absolute(position=123.25).wait()
        recording = record.stop()
        wait_for_cycle(page, recording["x"]["cycle"][-1])
        for field in ("set_position", "actual_velocity", "state"):
            cycles, values = column(page, f"x.{field}")
            np.testing.assert_array_equal(np.diff(cycles), 1)
            at = np.searchsorted(cycles, recording["x"]["cycle"])
            np.testing.assert_array_equal(values[at], recording["x"][field].astype(float))
        expect(page.locator("#legend .entry", has_text="x.set position").locator("output")).to_have_text("123.250")
        expect(page.locator("#legend .entry", has_text="x.state").locator("output")).to_have_text("Standstill")

        page.click("#tab-machine")
        expect(row(page, "x").locator(".state")).to_have_text("Standstill")
        expect(row(page, "x").locator(".place")).to_have_text("123.250 mm")
        expect(row(page, "r").locator(".state")).to_have_text("Disabled")
        x.move_velocity(velocity=12.5)
        expect(row(page, "x").locator(".does")).to_contain_text("move_velocity: velocity: 12.5")
        expect(row(page, "x").locator(".speed")).to_have_text("12.5 mm/s")
        refused = x.move_absolute(position=9999)
        expect(page.locator("#events .event.error").first).to_contain_text(refused.sentence)
        x.move_velocity(velocity=400).wait_final()  # onto the SW limit
        expect(row(page, "x").locator(".waits")).to_contain_text(f"{x.error:04}")
        expect(page.locator("#faults")).to_have_text("x in error")
        row(page, "x").click()
        expect(page.locator("#details label", has_text="homed").locator("output")).to_have_text(
            "yes" if x.homed else "no"
        )


def test_the_scope_is_triggered_pauses_zooms_and_measures(tmp_path: Path, browser: Browser) -> None:
    url = new_url()
    with (
        running(tmp_path, url, machine=FULL_RATE),
        served(url) as address,
        opened(browser, address, "#tab=scope&signals=x.set_position,x.set_velocity") as page,
        takt.connect(url) as session,
    ):
        x = session.axis("x")
        x.power().wait()
        wait_for_cycle(page, 1)
        page.select_option("#span", "0.5")
        page.select_option("#trigger-mode", "single")
        page.select_option("#trigger-signal", "x.set_position")
        page.fill("#trigger-level", "50.5")
        page.press("#trigger-level", "Enter")
        expect(page.locator("#trigger-state")).to_have_text("armed")
        record = session.record()
        x.move_absolute(position=90).wait()
        x.move_absolute(position=0).wait()
        recording = record.stop()
        expect(page.locator("#trigger-state")).to_contain_text("triggered at")
        positions, cycles = recording["x"]["set_position"], recording["x"]["cycle"]
        rising = int(np.flatnonzero((positions[1:] >= 50.5) & (positions[:-1] < 50.5))[0])
        share = (50.5 - positions[rising]) / (positions[rising + 1] - positions[rising])
        held = page.evaluate("() => ({ ...window.takt.scope.held, store: null })")
        assert held["edge"] == pytest.approx(cycles[rising] + share, abs=1e-6)
        assert (held["to"] - held["from"], held["edge"] - held["from"]) == pytest.approx((500, 100))
        assert page.evaluate("() => window.takt.scope.paused")

        # What is held stays, whatever comes after it.
        x.move_absolute(position=400).wait()
        store = page.evaluate(
            "() => window.takt.scope.held.store.value(0, 'set_position', window.takt.scope.held.edge)"
        )
        assert store == positions[rising]

        # Two cursors, by hand, and what is between them.
        box = page.locator("#lanes").bounding_box()
        assert box is not None
        for share in (0.4, 0.7):
            page.mouse.click(box["x"] + share * box["width"], box["y"] + 60)
        a, b = page.evaluate("() => [window.takt.scope.a, window.takt.scope.b]")
        assert held["from"] < a < b < held["to"]
        at = np.searchsorted(cycles, [a, b], side="right") - 1
        measured = page.locator("#measured tbody tr", has_text="x.set_position").locator("td")
        expect(measured.nth(2)).not_to_have_text("\u2013")
        numbers = [float(text.split()[0].replace("\u2212", "-")) for text in measured.all_inner_texts()[1:]]
        expected = [*positions[at], positions[at[1]] - positions[at[0]]]
        np.testing.assert_allclose(numbers[:3], expected, rtol=1e-5, atol=1e-9)
        assert numbers[3] == pytest.approx(expected[2] / ((b - a) * 0.001), rel=1e-5)
        between = positions[np.searchsorted(cycles, a) : np.searchsorted(cycles, b, side="right")]
        np.testing.assert_allclose(numbers[4:6], [between.min(), between.max()], rtol=1e-5)

        # A zoom by dragging, and back.
        page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 40)
        page.mouse.down()
        page.mouse.move(box["x"] + 0.6 * box["width"], box["y"] + 40, steps=3)
        page.mouse.up()
        zoom = page.evaluate("() => window.takt.scope.zoom")
        assert held["from"] < zoom["from"] < zoom["to"] < held["to"]
        page.keyboard.press("Escape")
        assert page.evaluate("() => window.takt.scope.zoom") is None
        page.click("#pause")
        page.select_option("#trigger-mode", "off")
        expect(page.locator("#pause")).to_have_text("Pause")
        until(page, "() => window.takt.scope.shown().to > window.takt.scope.period")


COMMANDED = machine_with("{axis_rate_hz: 1000, dead_man_s: 1}") + "view: {commands: true}\n"


def test_a_page_that_hears_no_engine_says_so_and_refuses_commands(tmp_path: Path, browser: Browser) -> None:
    """The server and the engine go; the server comes back alone. In a narrow window, too, the stops are in sight."""
    url, port = new_url(), free_port()
    with contextlib.ExitStack() as stack:
        engine = stack.enter_context(contextlib.ExitStack())
        server = stack.enter_context(contextlib.ExitStack())
        engine.enter_context(running(tmp_path, url, machine=COMMANDED))
        page = stack.enter_context(opened(browser, server.enter_context(served(url, port=port)), "#tab=machine"))
        expect(page.locator("#state")).to_have_text("live")
        for width in (1440, 700):
            page.set_viewport_size({"width": width, "height": 700})
            box = page.locator("#emergency-stop").bounding_box()
            assert box is not None
            assert box["x"] + box["width"] <= width
        server.close()
        expect(page.locator("#banner")).to_contain_text("the server of this page is gone")
        page.click("#emergency-stop")
        expect(page.locator("#banner")).to_have_text(
            "machine.emergency_stop was not given: the server of this page is gone"
        )
        engine.close()
        server.enter_context(served(url, port=port))
        expect(page.locator("#state")).to_have_text("waiting for an engine")
        until(page, f"() => document.getElementById('banner').textContent === 'no engine is heard on {url}'")
        page.click("#emergency-stop")
        expect(page.locator("#banner")).to_have_text("machine.emergency_stop was not given: no engine is heard")
        frames = page.evaluate("() => window.takt.connection.tries")
        page.wait_for_timeout(6000)  # longer than a page takes a silent server for a living one
        assert page.evaluate("() => window.takt.connection.tries") == frames
        expect(page.locator("#state")).to_have_text("waiting for an engine")


def test_the_trigger_takes_switches_states_and_what_leaves_rest(tmp_path: Path, browser: Browser) -> None:
    url = new_url()
    with (
        running(tmp_path, url, machine=FULL_RATE),
        served(url) as address,
        opened(browser, address, "#tab=scope&signals=x.set_velocity,x.state,x.loop_closed") as page,
        takt.connect(url) as session,
    ):
        x = session.axis("x")
        wait_for_cycle(page, 1)
        page.select_option("#span", "0.1")

        def armed(signal: str, level: str | None = None, state: str | None = None) -> None:
            wait_for_cycle(page, session.cycle)  # it counts what the page gets from then on, however late that is
            page.select_option("#trigger-mode", "single")
            page.select_option("#trigger-signal", signal)
            if level is not None:
                page.fill("#trigger-level", level)
                page.press("#trigger-level", "Enter")
            if state is not None:
                page.select_option("#trigger-name", label=state)
            expect(page.locator("#trigger-state")).to_have_text("armed")

        def edge() -> float:
            expect(page.locator("#trigger-state")).to_contain_text("triggered at")
            return float(page.evaluate("() => window.takt.scope.held.edge"))

        record = session.record()
        armed("x.loop_closed")
        x.power().wait()
        switched = edge()
        armed("x.set_velocity", level="0")
        x.move_velocity(velocity=50).wait(until="reached")
        started = edge()
        armed("x.state", state="Standstill")
        x.halt().wait()
        stood = edge()
        recording = record.stop()
        table = recording["x"]
        assert (
            table["cycle"][np.argmax(table["loop_closed"])] - 1
            <= switched
            <= table["cycle"][np.argmax(table["loop_closed"])]
        )
        moving = table["cycle"][np.argmax(table["set_velocity"] > 0)]
        assert moving - 1 <= started <= moving
        states = recording.text("x", "state")
        last = np.flatnonzero((states[1:] == "Standstill") & (states[:-1] != "Standstill"))[-1]
        assert stood == pytest.approx(table["cycle"][last + 1])


def test_differences_between_cursors_are_those_of_the_motion(tmp_path: Path, browser: Browser) -> None:
    """Wherever cursors are put at a constant velocity, the slope between them is that."""
    url = new_url()
    with (
        running(tmp_path, url, machine=FULL_RATE),
        served(url) as address,
        opened(browser, address, "#tab=scope&signals=x.set_position") as page,
        takt.connect(url) as session,
    ):
        x = session.axis("x")
        x.power().wait()
        x.move_velocity(velocity=50).wait(until="reached")
        page.select_option("#span", "0.2")
        session.run(1)
        wait_for_cycle(page, session.cycle)
        page.evaluate("() => window.takt.scope.pause(true)")
        begin = page.evaluate("() => window.takt.scope.held.from")
        put = "([a, b]) => { const { scope } = window.takt; scope.setCursor(a); scope.setCursor(b, true); }"
        measured = "([a, b]) => document.getElementById('measured').dataset.key.startsWith(`${a}|${b}|`)"
        for a, b in ((20.3, 60.9), (33.5, 35.49), (150.2, 20.7)):
            page.evaluate(put, [begin + a, begin + b])
            until(page, measured, *page.evaluate("() => [window.takt.scope.a, window.takt.scope.b]"))
            cells = page.locator("#measured tr").nth(1).locator("td")
            assert cells.nth(4).inner_text() == "50 mm/s"
            at_a, at_b, least, largest = (float(cells.nth(i).inner_text().split()[0]) for i in (1, 2, 5, 6))
            assert (least, largest) == (min(at_a, at_b), max(at_a, at_b))


def test_the_scope_by_keyboard(tmp_path: Path, browser: Browser) -> None:
    url = new_url()
    with (
        running(tmp_path, url, machine=FULL_RATE),
        served(url) as address,
        opened(browser, address, "#tab=scope&signals=x.set_position") as page,
    ):
        wait_for_cycle(page, 1)
        page.focus("#filter")
        page.keyboard.type("x.actual_velocity")
        page.keyboard.press("Tab")
        page.keyboard.press("Tab")
        page.keyboard.press(" ")
        until(page, "() => window.takt.scope.signals.some((s) => s.name === 'x.actual_velocity')")
        assert not page.evaluate("() => window.takt.scope.paused")
        page.focus("#tab-machine")
        page.keyboard.press(" ")
        expect(page.locator("#view-machine")).to_be_visible()
        assert not page.evaluate("() => window.takt.scope.paused")


def test_connections_that_break(tmp_path: Path, browser: Browser) -> None:
    """The server goes and comes; the engine goes, comes back, and is another machine then."""
    url, port = new_url(), free_port()
    with contextlib.ExitStack() as stack:
        engine = stack.enter_context(contextlib.ExitStack())
        server = stack.enter_context(contextlib.ExitStack())
        address = server.enter_context(served(url, port=port))
        page = stack.enter_context(opened(browser, address, "#tab=scope&signals=x.set_position,r.state"))
        expect(page.locator("#banner")).to_have_text(f"no engine is heard on {url}")
        engine.enter_context(running(tmp_path, url, machine=FULL_RATE))
        expect(page.locator("#state")).to_have_text("live")
        expect(page.locator("#banner")).to_be_hidden()
        wait_for_cycle(page, 10)
        before, _ = column(page, "x.set_position")

        server.close()
        expect(page.locator("#banner")).to_contain_text("the server of this page is gone")
        server.enter_context(served(url, port=port))
        expect(page.locator("#state")).to_have_text("live")
        expect(page.locator("#banner")).to_be_hidden()
        wait_for_cycle(page, int(before[-1]) + 2000)
        after, _ = column(page, "x.set_position")
        assert after[0] == before[0]  # the page goes on where it was
        assert page.evaluate("() => window.takt.scope.signals.map((s) => s.name)") == ["x.set_position", "r.state"]

        engine.close()
        expect(page.locator("#banner")).to_contain_text("the engine is gone")
        expect(page.locator("#state")).to_have_text("engine gone")
        engine.enter_context(running(tmp_path, url, machine=FULL_RATE))
        expect(page.locator("#state")).to_have_text("live")
        expect(page.locator("#banner")).to_be_hidden()
        wait_for_cycle(page, 10)
        again, _ = column(page, "x.set_position")
        np.testing.assert_array_equal(np.diff(again), 1)  # nothing of the engine before
        assert page.evaluate("() => window.takt.scope.signals.map((s) => s.name)") == ["x.set_position", "r.state"]

        engine.close()
        engine.enter_context(
            running(tmp_path, url, machine=MACHINE.replace("name: test", "name: another").replace("name: x", "name: y"))
        )
        expect(page.locator("#machine-name")).to_have_text("another")
        assert page.evaluate("() => window.takt.scope.signals.map((s) => s.name)") == ["r.state"]
        page.click("#tab-machine")
        expect(row(page, "y").locator(".state")).to_have_text("Disabled")
        expect(row(page, "x")).to_have_count(0)


def test_a_page_that_was_slow_has_lost_nothing(tmp_path: Path, browser: Browser) -> None:
    url = new_url()
    with (
        running(tmp_path, url, machine=FULL_RATE),
        served(url) as address,
        opened(browser, address, "#tab=scope&signals=x.set_position") as slow,
        opened(browser, address, "#tab=scope&signals=x.actual_position,r.actual_position") as other,
    ):
        wait_for_cycle(slow, 10)
        slow.evaluate("() => { const end = performance.now() + 4000; while (performance.now() < end); }")
        wait_for_cycle(other, 10)
        cycle = int(column(other, "r.actual_position")[0][-1])
        wait_for_cycle(slow, cycle)
        for page, name in ((slow, "x.set_position"), (other, "x.actual_position"), (other, "r.actual_position")):
            np.testing.assert_array_equal(np.diff(column(page, name)[0]), 1)
            assert page.evaluate("() => [window.takt.model.health.lost, window.takt.model.health.skipped]") == [0, 0]


def test_what_cursors_measure_is_seen_whole_in_a_narrow_window(tmp_path: Path, browser: Browser) -> None:
    url = new_url()
    chosen = "#tab=scope&signals=x.set_position,x.set_velocity,x.actual_velocity,x.state,r.set_position"
    with (
        running(tmp_path, url, machine=FULL_RATE),
        served(url) as address,
        opened(browser, address, chosen) as page,
    ):
        wait_for_cycle(page, 1)
        page.set_viewport_size({"width": 900, "height": 860})
        page.keyboard.press("a")
        page.keyboard.press("b")
        page.keyboard.press("ArrowLeft")
        expect(page.locator("#measured th").last).to_have_text("largest between")
        expect(page.locator("#measured td").nth(3)).not_to_be_empty()
        assert page.locator("#measured").evaluate("(box) => box.scrollWidth <= box.clientWidth")


def test_nothing_is_drawn_where_nothing_was_received(tmp_path: Path, browser: Browser) -> None:
    """Neither curves nor bands of states."""
    url = new_url()
    with (
        running(tmp_path, url, machine=FULL_RATE),
        served(url) as address,
        opened(browser, address, "#tab=scope&signals=x.set_position,x.state") as page,
    ):
        wait_for_cycle(page, 1)
        first = column(page, "x.state")[0][0]
        wait_for_cycle(page, first + 1200)
        script = """() => {
            const { scope } = window.takt;
            scope.setSpan(1);
            scope.pause(true);
            const { store, from } = scope.held;
            const [index, series] = [...store.series][0];
            const rows = [...series.cycles.keys()].filter((i) => Math.abs(series.cycles[i] - from - 500) > 100);
            const kept = (column) => Float64Array.from(rows, (i) => column[i]);
            const columns = new Map([...series.columns].map(([field, column]) => [field, kept(column)]));
            store.series.set(index, series.constructor.of(kept(series.cycles), columns));
            scope.draw();
            const { canvas, inner, ratio } = scope.drawing;
            const inkAt = (lane, part) => {
                const at = Math.round((64 + part * inner) * ratio);
                const [top, height] = [lane.top * ratio + 4, lane.height * ratio - 8];
                const { data } = canvas.getContext("2d").getImageData(at, top, 1, height);
                return [...data.keys()].some((i) => i % 4 === 0 && data[i] < 200);
            };
            return scope.layout.lanes.map((lane) => [0.21, 0.43, 0.57, 0.79].map((part) => inkAt(lane, part)));
        }"""
        assert page.evaluate(script) == [[True, False, False, True]] * 2


def test_a_thousand_axes(tmp_path: Path, browser: Browser) -> None:
    axes = "".join(
        f"  - {{name: axis_{i:04}, limits: {{velocity: 100, acceleration: 1000, jerk: 20000}}}}\n" for i in range(1000)
    )
    url = new_url()
    with (
        running(tmp_path, url, machine=f"name: many\nlcm: {{axis_rate_hz: 10}}\naxes:\n{axes}"),
        served(url) as address,
        opened(browser, address) as page,
        takt.connect(url, timeout=PATIENCE_S) as session,
    ):
        until(page, "() => window.takt.model.rows.filter(Boolean).length === 1000")
        assert page.locator("#list .row").count() < 60  # only those in sight
        session.axis("axis_0777").power().wait()
        page.fill("#list-filter", "777")
        expect(row(page, "axis_0777").locator(".state")).to_have_text("Standstill")
        expect(page.locator("#list-count")).to_have_text("1 of 1000")
        page.fill("#list-filter", "")
        page.locator("#list").evaluate("(box) => (box.scrollTop = box.scrollHeight)")
        expect(row(page, "axis_0999").locator(".state")).to_have_text("Disabled")
        page.click("#tab-scope")
        page.fill("#filter", "0500 set position")
        page.locator("#signals .row:visible", has_text="set position").click()
        until(page, "() => window.takt.scope.signals.some((s) => s.name === 'axis_0500.set_position')")


def test_the_plan_shows_movers_where_they_are(tmp_path: Path, browser: Browser) -> None:
    url = new_url()
    with (
        running(tmp_path, url, machine=PLANE),
        served(url) as address,
        opened(browser, address, "#tab=plan") as page,
        takt.connect(url) as session,
    ):
        for feedback in [
            *(t.enable() for t in session.tracks.values()),
            *(m.enable() for m in session.movers.values()),
        ]:
            feedback.wait()
        for mover in session.movers.values():
            mover.join_track(track="loop", use_orientation=False).wait()
        one, two = session.mover("one"), session.mover("two")
        one.move_on_track(track="loop", position=1000)  # two is in its way, and it waits
        session.wait(lambda: one.waits_for == 2 and one.x > 200 and one.track_velocity == 0, PATIENCE_S)
        script = """() => {
            const { model } = window.takt;
            return ["x", "y", "waits_for"].map((field) => model.liveOf(model.byName.get("one"), field));
        }"""
        until(
            page,
            "([x]) => Math.abs(window.takt.model.liveOf(window.takt.model.byName.get('one'), 'x') - x) < 1e-9",
            one.x,
        )
        assert page.evaluate(script) == pytest.approx([one.x, one.y, 2])
        # Its middle is filled on the canvas; a place without anything is not.
        pixel = """([x, y]) => {
            const { plan } = window.takt;
            const [px, py] = plan.at(x, y);
            const ratio = devicePixelRatio;
            return [...plan.canvas.getContext('2d').getImageData(px * ratio, py * ratio, 1, 1).data];
        }"""
        free = page.evaluate(pixel, [one.x + 20, one.y + 250])
        for mover in (one, two):
            assert page.evaluate(pixel, [mover.x + 30, mover.y + 30]) != free
        page.click("#tab-machine")
        expect(row(page, "one").locator(".waits")).to_contain_text("waits for two")
        expect(page.locator("#waiting-count")).to_have_text("1 waiting")


GROUND = """
name: ground
axes: []
tracks: [{name: later}]
movers: [{name: one, xy: {maximum: {velocity: 200, acceleration: 2000, jerk: 40000}}}, {name: two, initial: {y: 300}}]
planar_groups: [{name: group, movers: [one, two]}]
"""


def test_the_plan_knows_tracks_that_commands_made_and_what_is_reserved(tmp_path: Path, browser: Browser) -> None:
    url = new_url()
    with (
        running(tmp_path, url, machine=GROUND),
        served(url) as address,
        opened(browser, address, "#tab=plan") as page,
        takt.connect(url) as session,
    ):
        one, two, later = session.mover("one"), session.mover("two"), session.track("later")
        for feedback in (one.enable(), two.enable(), session.planar_group("group").enable()):
            feedback.wait()
        later.append_line(start_x=0, start_y=500, end_x=800, end_y=500).wait()
        until(page, "() => window.takt.model.shapes.get('later')?.points.length > 6")
        points = np.reshape(page.evaluate("() => window.takt.model.shapes.get('later').points"), (-1, 3))
        np.testing.assert_allclose(points[[0, -1]], [[0, 0, 500], [800, 800, 500]], atol=0.01)
        assert np.all(np.diff(points[:, 0]) <= 10.01)
        one.move_to_position(x=700, y=100)
        field = "(name) => window.takt.model.liveOf(window.takt.model.byName.get('one'), name)"
        until(page, f"() => ({field})('reserved_upper_x') === 756.5 && ({field})('x') > 100")
        assert page.evaluate(field, "reserved_upper_y") == 156.5
        assert page.evaluate(field, "target_x") == 700
        session.wait(lambda: one.x == 700, 10)
        until(page, f"() => ({field})('reserved_lower_x') === 643.5")
        later.clear().wait()
        until(page, "() => window.takt.model.shapes.get('later').points.length === 0")


def test_the_plan_knows_routes_and_how_far_they_are(tmp_path: Path, browser: Browser) -> None:
    url = new_url()
    stators = ", ".join(f"{{x: {240 * x}, y: {240 * y}}}" for x in range(3) for y in range(2))
    text = "name: floor\naxes: []\nmovers: [{name: one, initial: {x: 60, y: 60}}]\n"
    text += f"environments: [{{name: floor, stators: [{stators}]}}]\n"
    with (
        running(tmp_path, url, machine=text),
        served(url) as address,
        opened(browser, address, "#tab=plan") as page,
        takt.connect(url) as session,
    ):
        one = session.mover("one")
        one.enable().wait()
        places = [[60, 60], [180, 60], [300, 60], [420, 60], [420, 180]]
        there = one.set_route(first=one.route_visit, visits=[{"x": x, "y": y} for x, y in places])
        session.command("machine", "start_routes", {"velocity": 300}).wait()
        session.wait(lambda: one.x > 100, 5)
        session.command("machine", "hold_routes").wait()
        session.wait(lambda: one.delay == "release", 5)
        ahead = f"window.takt.plan.surface.ahead('one', {one.route_visit}, {one.route_visit + 1})"
        until(page, f"() => window.takt.model.routes.get('one')?.points.length === {2 * len(places)}")
        found = page.evaluate(f"() => {ahead}")
        assert found["granted"] + found["later"] == places[one.route_visit + 1 :]
        assert len(found["granted"]) == 1
        session.command("machine", "hold_routes", {"hold": False}).wait()
        there.wait()
        until(page, "() => window.takt.model.routes.get('one').points.length === 0")


def test_cams_show_the_point_in_force(tmp_path: Path, browser: Browser) -> None:
    url = new_url()
    with (
        running(tmp_path, url, machine=SAW),
        served(url) as address,
        opened(browser, address, "#tab=cams", dark=True) as page,
        takt.connect(url) as session,
    ):
        web, cutter = session.axis("web"), session.flex_cam("cutter")
        web.power().wait()
        cutter.control(regulator_on=True).wait()
        session.wait(lambda: cutter.axis_enabled)
        web.move_velocity(velocity=300)
        cutter.control(sync_cam=True).wait()
        web.halt().wait()
        session.run(0.3)
        card = page.locator(".cam").first
        expect(card.locator("header .soft")).to_contain_text("product_600")
        expect(card.locator("output")).to_have_text(
            f"x {cutter.set_x_position:.3f} mm   y {cutter.set_y_position:.3f} mm"
        )
        expect(card.locator("p")).to_have_text(
            f"master {cutter.mp01_set_master_position:.3f} mm   slave {cutter.mp02_set_slave_position:.3f} mm, "
            f"measured {cutter.actual_slave_position:.3f} mm"
        )
        expect(card.get_by_role("button")).to_have_count(0)  # the machine file does not let the page command
        shown = page.evaluate("() => window.takt.model.machine.cams[0]")
        table, x = session.cam("product_600"), np.array(shown["x"])
        inside = np.abs(x[:, None] - table.joints).min(axis=1) > 1e-3  # x has nine digits, and the jerk jumps at joints
        for curve, values in zip(shown["curves"], table.at(x), strict=True):  # position, velocity, acceleration, jerk
            np.testing.assert_allclose(np.array(curve)[inside], values[inside], atol=1e-6 * np.abs(values).max())

        # The cam that is asked for and not in force yet: of another slot, then one put into the slot that runs.
        expect(card.locator("header .soft")).not_to_contain_text("next:")
        expect(page.locator(".cam:visible")).to_have_count(2)
        cutter.control(cam_table=2)
        expect(card.locator("header .soft")).to_contain_text("next: product_450")
        expect(page.locator(".cam:visible")).to_have_count(1)  # it is drawn there, and not by itself
        cutter.control(cam_table=1)
        expect(card.locator("header .soft")).not_to_contain_text("next:")
        made = session.cam("product_450")
        cutter.load_cam(1, made, name="other").wait()
        expect(card.locator("header .soft")).to_contain_text("product_600  ·  next: other")
        until(page, "() => window.takt.model.madeCams.get(3)?.name === 'other'")
        other, prepared = page.evaluate("() => [window.takt.model.madeCams.get(3), window.takt.model.machine.cams[1]]")
        assert (other["x"], other["curves"]) == (prepared["x"], prepared["curves"])
        web.move_velocity(velocity=300)
        session.wait(lambda: cutter.cam_number == 3)
        web.halt().wait()
        expect(card.locator("header .soft")).to_have_text(re.compile("^other"))
        expect(card.locator("output")).to_contain_text(" mm   y ")


def test_a_cam_is_edited_by_dragging_and_put_into_force(tmp_path: Path, browser: Browser) -> None:  # CAM-88
    url = new_url()
    with (
        running(tmp_path, url, machine=f"{SAW}view: {{commands: true}}\n"),
        served(url) as address,
        opened(browser, address, "#tab=cams") as page,
        takt.connect(url) as session,
    ):
        web, cutter = session.axis("web"), session.flex_cam("cutter")
        web.power().wait()
        cutter.control(regulator_on=True)
        session.wait(lambda: cutter.axis_enabled)
        web.move_velocity(velocity=300)
        cutter.control(sync_cam=True).wait()
        card = page.locator(".cam").first
        edit = card.get_by_role("button", name="Edit")
        edit.click()
        knot = "() => { const [{ edit }] = window.takt.cams.cards; return edit?.knots[3]; }"  # the highest point
        page.wait_for_function("() => window.takt.cams.cards[0].view")  # drawn
        before = page.evaluate(knot)
        x, y = page.evaluate(
            "() => { const [{ view, edit, canvas }] = window.takt.cams.cards; const b = canvas.getBoundingClientRect();"
            " return [b.x + view.across(edit.knots[3][0]), b.y + view.down(edit.knots[3][1])]; }"
        )
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x + 4, y + 12, steps=3)
        page.mouse.up()
        after = page.evaluate(knot)
        assert after[0] > before[0]
        low, high = page.evaluate("() => window.takt.cams.cards[0].view.range")
        assert 0 < before[1] - after[1] < 0.15 * (high - low)  # 12 pixels of some 190
        assert after[2:] == before[2:]
        put = card.get_by_role("button", name="Put into force")
        put.click()
        session.wait(lambda: cutter.cam_number == 3)
        drawn = page.evaluate("() => window.takt.model.madeCams.get(3)")
        assert drawn["name"] == "product_600 edited"
        assert drawn["knots"][3] == pytest.approx(after)
        expect(card.locator("header .soft")).to_contain_text("product_600 edited")
        back = cutter.cam_in_force.points
        assert [back.x[3], back.y[3]] == pytest.approx(after[:2])

        # Again, from the edited one, under the same name; a linear cam has no slopes that could stay.
        edit.click()
        expect(put).to_be_enabled()
        put.click()
        session.wait(lambda: cutter.cam_number == 4)
        assert cutter.cam_in_force.name == "product_600 edited"
        cutter.load_cam(1, {"name": "saw teeth", "interpolation": "linear", "cyclic": True, "points": [
            {"x": 0, "y": 0}, {"x": 300, "y": 200}, {"x": 600, "y": 0}]})  # fmt: skip
        session.wait(lambda: cutter.cam_number == 5)
        expect(edit).to_be_disabled()
        expect(edit).to_have_attribute("title", "its slope has steps, or it has more than 60 joints")


def test_engine_figures(tmp_path: Path, browser: Browser) -> None:
    url = new_url()
    with (
        running(tmp_path, url, machine=FULL_RATE, pace="real"),
        served(url) as address,
        opened(browser, address, "#tab=engine") as page,
        takt.connect(url) as session,
    ):
        session.axis("x").power().wait()
        card = lambda title: page.locator(".figure", has_text=re.compile(f"{title}$")).locator("b")  # noqa: E731
        expect(card("cycle")).to_have_text("1 ms")
        expect(card("pace")).to_have_text("real time")
        expect(card("commands")).to_have_text("1")
        expect(card("clients")).to_have_text("1")
        expect(card("states lost on the way")).to_have_text("0")
        expect(page.locator("#histogram-latency-note")).to_contain_text("median")
        session.run(0.5)
        engine = page.evaluate("() => window.takt.model.engine")
        figures = session.figures
        assert engine["execution"]["count"] <= figures["execution"]["count"] + 500
        assert engine["execution"]["max"] <= max(figures["execution"]["max"], engine["execution"]["max"])
        assert len(engine["latency"]["buckets"]) == 32


@pytest.mark.parametrize(("how", "dead_man"), [("let go", 60), ("hangs", 3)])
def test_jogging_by_hand(how: str, dead_man: float, tmp_path: Path, browser: Browser) -> None:  # EN-23
    url = new_url()
    machine = machine_with(f"{{dead_man_s: {dead_man}}}") + "view: {commands: true}\n"
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
        page.locator("#details-commands button", has_text="jog ▶").hover()
        for _ in range(2):
            page.mouse.down()
            session.wait(lambda: x.set_velocity == pytest.approx(12.0), 10.0)
            session.run(0.5 if how == "let go" else 4.0)
            assert x.set_velocity == pytest.approx(12.0)
            if how == "let go":
                page.mouse.up()
                session.wait(lambda: x.state is takt.PlcState.STANDSTILL, 10.0)
            else:
                page.evaluate("() => { const end = performance.now() + 8000; while (performance.now() < end); }")
                assert x.set_velocity == 0  # when the page woke up the axis stood long since
                page.mouse.up()
        page.click("#emergency-stop")
        session.wait(lambda: x.state is takt.PlcState.DISABLED, 10.0)


def test_groups_are_jogged_by_hand(tmp_path: Path, browser: Browser) -> None:
    """GR-48, EN-23: along an axis of a coordinate system, and one axis, as long as the button is held."""
    url = new_url()
    with (
        running(
            tmp_path, url, machine=PORTAL.replace("dead_man_s: 0.3", "dead_man_s: 60") + "view: {commands: true}\n"
        ),
        served(url) as address,
        opened(browser, address) as page,
        takt.connect(url) as session,
    ):
        gantry = session.group("gantry")
        row(page, "gantry").click()
        page.click("#details-commands button:text-is('On')")
        session.wait(lambda: session.axis("x").loop_closed, 10.0)
        page.click("#details-commands button:text-is('Enable')")
        session.wait(lambda: gantry.state is takt.GroupState.GROUP_STANDBY, 10.0)
        page.fill("#details-commands input", "12")
        for system, axis, moved, speed in (("wcs", "x", "y", -12.0), ("acs", "a3", "z", 12.0)):
            page.select_option("#details-commands select[title='Coordinate system']", system)
            page.select_option("#details-commands select[title='Axis']", axis)
            page.locator("#details-commands button", has_text="jog ▶").hover()
            page.mouse.down()
            session.wait(
                lambda moved=moved, speed=speed: session.axis(moved).set_velocity == pytest.approx(speed), 10.0
            )
            page.mouse.up()
            session.wait(lambda: gantry.state is takt.GroupState.GROUP_STANDBY, 10.0)


def test_memory_is_bounded(tmp_path: Path, browser: Browser) -> None:
    """Rings of the page move on; what they hold does not grow."""
    url = new_url()
    with (
        running(tmp_path, url, machine=FULL_RATE),
        served(url) as address,
        opened(browser, address, "#tab=scope&signals=x.set_position") as page,
    ):
        wait_for_cycle(page, 10)
        script = """() => {
            const { scope } = window.takt;
            const series = scope.store.series.get(0);
            const before = series.cycles.length;
            const rows = series.moved + series.end;
            for (let k = 0; k < 200; ++k) {
                const cycles = Float64Array.from({ length: 5000 }, (_, i) => 1e9 + 5000 * k + i);
                series.append(cycles, new Map([["set_position", cycles]]));
            }
            const held = [...series.cycles.subarray(0, series.end)];
            const rises = held.every((cycle, i) => !i || cycle > held[i - 1]);
            const appended = series.moved + series.end - rows;
            const found = [series.find(1e9 + 999000), series.at("set_position", 1e9 + 999000.5)];
            return [before, series.cycles.length, series.end, appended, held.at(-1), rises, ...found];
        }"""
        before, length, end, appended, last, rises, found, value = page.evaluate(script)
        assert before == length >= end
        assert appended == 1_000_000
        assert rises
        assert last >= 1e9 + 999_999
        assert value == 1e9 + 999_000
        assert found < end
