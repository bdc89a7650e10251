"""A report in a real browser: what is seen first, the time that all of it shares, curves that zoom, nobody asked."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import takt
from pages import CHROMIUM, FLAGS, PATIENCE_S, TWO_ON_A_LOOP, needs_chromium
from playwright.sync_api import Browser, Page, expect, sync_playwright
from takt import checks, report
from takt.kinematics import Kinematics

pytestmark = needs_chromium
expect.set_options(timeout=PATIENCE_S * 1000)

CELL = (
    """
name: cell
axes:
  - {name: x, unit: mm, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
  - {name: y, unit: mm, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
  - {name: z, unit: mm, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
  - {name: drive, unit: mm, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
groups:
  - name: gantry
    axes: [x, y, z]
    kinematics: {gantry: {axes: [x, y, z]}}
    path: {velocity: 300, acceleration: 3000, jerk: 60000}
    base: {x: 1000, y: 200}
belts:
  - {name: infeed, axis: drive, origin: {x: 900, y: 400}}
"""
    + TWO_ON_A_LOOP
)


@pytest.fixture(scope="module")
def recording() -> takt.Recording:
    """A mover that has to wait for another one, a portal and a belt that move meanwhile."""
    with takt.Engine(CELL) as engine, engine.record() as recorder:
        gantry, belt, one = engine.group("gantry"), engine.belt("infeed"), engine.mover("one")
        gantry.power().wait()
        gantry.enable().wait()
        for part in [*engine.tracks.values(), *engine.movers.values()]:
            part.enable().wait()
        for mover in engine.movers.values():
            mover.join_track(track="loop", use_orientation=False).wait()
        drive = engine.axis("drive")
        drive.power().wait()
        drive.move_velocity(velocity=50)
        belt.detect(x=30).wait()
        one.move_on_track(track="loop", position=1000)
        gantry.move_linear_absolute(x=60, y=80, z=-20).wait()
        engine.wait(lambda: one.waits_for == 2, 10.0)
        engine.mark("it waits")
        gantry.move_linear_absolute(x=0, y=0, z=0).wait()
    return recorder.recording


@pytest.fixture(scope="module")
def failed(recording: takt.Recording, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of a run of which two of four verdicts failed."""
    verdicts = [
        checks.within_limits(recording, "x"),
        checks.stays(recording, "one.x < 250"),
        checks.within_limits(recording, "y", velocity=100),
        checks.visits_states(recording, "drive", ["Standstill", "ContinuousMotion"]),
    ]
    assert [verdict.passed for verdict in verdicts] == [True, False, False, True]
    page = report.write_report(recording, verdicts, tmp_path_factory.mktemp("failed"), "A cell", {"engine": {"a": 1}})
    return page.html


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield browser
        browser.close()


@contextlib.contextmanager
def opened(browser: Browser, file: Path, dark: bool = False) -> Iterator[Page]:
    """The page from its file. It must not complain, and ask nobody for anything."""
    complaints: list[str] = []
    asked: list[str] = []
    context = browser.new_context(
        viewport={"width": 1440, "height": 860}, color_scheme="dark" if dark else "light", reduced_motion="reduce"
    )
    context.set_offline(True)
    page = context.new_page()
    page.set_default_timeout(PATIENCE_S * 1000)
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on("console", lambda message: complaints.append(message.text) if message.type == "error" else None)
    page.on("request", lambda request: asked.append(request.url) if not request.url.startswith("data:") else None)
    page.goto(file.as_uri())
    page.wait_for_selector("body.ready")
    yield page
    context.close()
    assert complaints == []
    assert asked == [file.as_uri()]


def row_at(recording: takt.Recording, component: str, time_s: float) -> int:
    """The last sample at or before a time."""
    return int(np.searchsorted(recording[component]["time_s"], time_s + 1e-9, side="right")) - 1


def top(page: Page, selector: str) -> float:
    box = page.locator(selector).first.bounding_box()
    assert box is not None
    return box["y"]


def test_the_failing_assertion_is_the_first_thing_seen(browser: Browser, failed: Path) -> None:
    with opened(browser, failed) as page:
        expect(page.locator("#pill")).to_have_text("2 of 4 failed")
        first = page.locator("article.verdict").first
        expect(first).to_be_in_viewport()
        expect(first.locator("strong").first).to_have_text("stays(one)")
        expect(first.locator(".sentence")).to_contain_text("one.x < 250 did not hold")
        others = ("#facts", "#figures", "#passed-section", "#summary-section", "#scene-section", "#curves-section")
        below = top(page, "article.verdict")
        assert top(page, "h1") < below < 120
        assert all(top(page, selector) > below for selector in others)
        # Its curve is there, around the place, with what it must not cross.
        expect(first.locator("canvas")).to_be_in_viewport()
        card = """() => {
            const { verdict, plots } = window.takt.verdicts.cards[0];
            const { plot } = plots.items[0];
            const [x, y] = [plot.scales.x, plot.scales.y];
            const at = (value, scale) => plot.valToPos(value, scale, true);
            const pixel = (t, v) => [...plot.ctx.getImageData(at(t, "x"), at(v, "y"), 1, 1).data];
            const [from, to] = verdict.place;
            return {
                view: verdict.view, x: [x.min, x.max], y: [y.min, y.max],
                at: pixel(from + 0.43 * (to - from), 250 + 0.43 * (y.max - 250)),
                away: pixel(x.min + 0.43 * (from - x.min), y.min + 0.43 * (250 - y.min)),
            };
        }"""
        seen = page.evaluate(card)
        assert seen["x"] == pytest.approx(seen["view"])
        assert seen["y"][0] < 250 < seen["y"][1]
        red, green, _, opaque = seen["at"]
        assert opaque
        assert red > green + 8  # the place is marked
        assert seen["away"] == [0, 0, 0, 0]
        # Others are folded, and draw their curves when they are opened.
        folded = page.locator("details.verdict", has_text="within_limits(x)")
        expect(folded.locator("canvas")).to_have_count(0)
        folded.locator("summary").click()
        expect(folded.locator("canvas").first).to_be_visible()


def test_all_values_come_through(browser: Browser, failed: Path, recording: takt.Recording) -> None:
    """What the page unpacks is what was recorded, to a millionth of the range."""
    with opened(browser, failed) as page:
        script = """(name) => {
            const table = window.takt.recorded.get(name);
            const columns = [...table.fields.keys()].map((field) => [field, [...table.values(field)]]);
            return [[...table.time], Object.fromEntries(columns)];
        }"""
        for name in recording:
            time_s, columns = page.evaluate(script, name)
            np.testing.assert_allclose(time_s, recording[name]["time_s"], rtol=0, atol=1e-9)
            assert tuple(columns) == recording.fields(name)[2:]
            for field, values in columns.items():
                exact = recording[name][field].astype(float)
                exact[np.isinf(exact)] = np.nan  # both are gaps
                room = 1e-6 * max(
                    float(np.ptp(exact[np.isfinite(exact)])) if np.any(np.isfinite(exact)) else 0.0, 1e-30
                )
                shown = np.array(values, dtype=float)
                shown[np.isinf(shown)] = np.nan
                np.testing.assert_allclose(shown, exact, rtol=0, atol=room, err_msg=f"{name}.{field}")


def test_the_slider_moves_the_machine_from_above(browser: Browser, failed: Path, recording: takt.Recording) -> None:
    script = """() => {
        const { model, clock } = window.takt;
        const of = (name, field) => model.liveOf(model.byName.get(name), field);
        return {
            time: clock.time, x: of("one", "x"), y: of("one", "y"), waits: of("one", "waits_for"),
            belt: of("infeed", "position"), tool: model.links.gantry.at(-1)?.slice(3), objects: model.objects.infeed,
            row: { ...model.rows[model.byName.get("one").index] },
        };
    }"""
    gantry = Kinematics(gantry={"axes": ["x", "y", "z"]})
    looks = recording.meta["objects"]["infeed"]
    with opened(browser, failed) as page:
        slider = page.locator("#slider")
        begin, end = recording.start_s, recording.end_s
        for time_s in (begin, begin + 0.3 * (end - begin), begin + 0.7 * (end - begin), end):
            slider.evaluate("(node, t) => { node.value = t; node.dispatchEvent(new Event('input')); }", time_s)
            seen = page.evaluate(script)
            assert seen["time"] == pytest.approx(time_s)
            row = recording["one"][row_at(recording, "one", time_s)]
            assert (seen["x"], seen["y"]) == pytest.approx((row["x"], row["y"]), abs=1e-3)
            assert seen["waits"] == row["waits_for"]
            assert seen["row"] == {
                "state": recording.text("one", "state")[row_at(recording, "one", time_s)],
                "waits": "waits" if row["delay"] or row["waits_for"] else "",
            }
            assert seen["belt"] == pytest.approx(
                recording["infeed"]["position"][row_at(recording, "infeed", time_s)], abs=1e-3
            )
            # Links are of 50 frames a second.
            near = [row_at(recording, "x", t) for t in (time_s - 0.011, time_s, time_s + 0.011)]
            joints = [[recording[axis]["actual_position"][max(row, 0)] for axis in "xyz"] for row in near]
            tips = np.array([gantry.link_places(joint)[-1][3:] for joint in joints]) + np.array([1000, 200, 0])
            assert np.all(np.array(seen["tool"]) >= tips.min(axis=0) - 0.02)
            assert np.all(np.array(seen["tool"]) <= tips.max(axis=0) + 0.02)
            at = int(np.searchsorted(looks["time_s"], time_s + 1e-9, side="right")) - 1
            rows = looks["rows"][looks["first"][at] : looks["first"][at + 1]] if at >= 0 else []
            np.testing.assert_allclose(seen["objects"], rows, atol=1e-3)
        assert len(looks["rows"]) > 5
        # What is drawn: the mover's middle is filled where it is now, and no more where it was.
        pixel = """([x, y]) => {
            const { plan } = window.takt;
            plan.draw();
            const [px, py] = plan.at(x, y).map((v) => v * devicePixelRatio);
            return [...plan.canvas.getContext('2d').getImageData(px, py, 1, 1).data];
        }"""
        page.locator("#scene-section").scroll_into_view_if_needed()
        last, first = recording["one"][-1], recording["one"][0]
        free = page.evaluate(pixel, [430, 330])
        assert page.evaluate(pixel, [float(last["x"]) + 30, float(last["y"]) + 30]) != free
        assert page.evaluate(pixel, [float(first["x"]) - 30, float(first["y"]) + 30]) == free
        slider.evaluate("(node, t) => { node.value = t; node.dispatchEvent(new Event('input')); }", begin)
        assert page.evaluate(pixel, [float(first["x"]) - 30, float(first["y"]) + 30]) != free


def test_one_time_for_everything(browser: Browser, failed: Path, recording: takt.Recording) -> None:
    """Clicks on curves, places of verdicts and keys move the slider, the line in the curves and the machine."""
    with opened(browser, failed) as page:
        now = lambda: float(page.evaluate("() => window.takt.clock.time"))  # noqa: E731
        place = page.evaluate("() => window.takt.verdicts.cards[0].verdict.place")
        assert now() == pytest.approx(place[0])  # where it fails first
        page.locator("article.verdict").nth(1).get_by_role("button", name="Go to place").click()
        second = page.evaluate("() => window.takt.verdicts.cards[1].verdict")
        assert second["components"] == ["y"]
        assert now() == pytest.approx(second["place"][0])
        assert page.evaluate("() => window.takt.curves.plots.window") == pytest.approx(second["view"])
        expect(page.locator("#plan-canvas")).to_be_in_viewport()

        # A click on a curve.
        block = page.locator('article.component[data-name="one"]')
        block.scroll_into_view_if_needed()
        over = block.locator(".u-over").nth(1)
        over.evaluate("(node) => node.scrollIntoView({ block: 'center' })")  # not behind what sticks to the edges
        box = over.bounding_box()
        assert box is not None
        page.mouse.click(box["x"] + 0.25 * box["width"], box["y"] + 20)
        begin, end = second["view"]
        assert now() == pytest.approx(begin + 0.25 * (end - begin), abs=2 * (end - begin) / box["width"])
        line = over.locator(".now").bounding_box()
        assert line is not None
        assert line["x"] == pytest.approx(box["x"] + 0.25 * box["width"], abs=3)
        expect(page.locator("#time")).to_have_text(f"{now():.3f} s")
        x = page.evaluate("() => window.takt.model.liveOf(window.takt.model.byName.get('one'), 'x')")
        assert x == pytest.approx(recording["one"]["x"][row_at(recording, "one", now())], abs=1e-3)

        # Keys: a sample, 0.1 s; and it plays.
        at = now()
        page.keyboard.press("ArrowRight")
        assert now() == pytest.approx(at + 0.001)
        page.keyboard.press("Shift+ArrowLeft")
        assert now() == pytest.approx(at + 0.001 - 0.1)
        page.select_option("#speed", "10")
        page.locator("h1").click()
        page.keyboard.press(" ")
        page.wait_for_function("(t) => window.takt.clock.time === window.takt.clock.to", arg=at)
        page.wait_for_function("() => !window.takt.clock.playing")
        assert now() == pytest.approx(recording.end_s)


def test_curves_zoom(browser: Browser, failed: Path) -> None:
    with opened(browser, failed, dark=True) as page:
        window = lambda: page.evaluate("() => window.takt.curves.plots.window")  # noqa: E731
        whole = window()
        block = page.locator('article.component[data-name="x"]')
        block.scroll_into_view_if_needed()
        over = block.locator(".u-over").nth(1)
        over.evaluate("(node) => node.scrollIntoView({ block: 'center' })")  # not behind what sticks to the edges
        box = over.bounding_box()
        assert box is not None
        time = page.evaluate("() => window.takt.clock.time")
        page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 30)
        page.mouse.down()
        page.mouse.move(box["x"] + 0.75 * box["width"], box["y"] + 30, steps=4)
        page.mouse.up()
        length = whole[1] - whole[0]
        assert window() == pytest.approx([whole[0] + 0.5 * length, whole[0] + 0.75 * length], abs=length / 300)
        scale = page.evaluate(
            "() => { const { x } = window.takt.curves.plots.items[1].plot.scales; return [x.min, x.max]; }"
        )
        assert scale == pytest.approx(window())
        assert page.evaluate("() => window.takt.clock.time") == time  # a drag is no click
        page.mouse.dblclick(box["x"] + 0.5 * box["width"], box["y"] + 30)
        assert window() == pytest.approx(whole)


@pytest.mark.parametrize("empty", [{}, {"x": {"time_s": [], "p": []}}, {"x": {"time_s": [1.0], "p": [2.0]}}], ids=str)
def test_empty_runs_can_be_looked_at(empty: Any, tmp_path: Path, browser: Browser) -> None:
    page_file = tmp_path / "report.html"
    page_file.write_text(report.render(takt.Recording(empty), [], "little"), encoding="utf-8")
    with opened(browser, page_file) as page:
        few = bool(empty) and len(empty["x"]["time_s"]) > 0
        said = "Nothing was judged" if few else "Nothing was recorded"
        expect(page.locator("#trouble")).to_contain_text(said)
        expect(page.locator("#pill")).to_have_text("no verdicts")
        if few:
            expect(page.locator(".component small")).to_have_text("1 samples: nothing to draw")
