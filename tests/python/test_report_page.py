"""A report in a real browser: what is seen first, the time that all of it shares, curves that zoom, nobody asked."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import takt
from motion_curves import one_axis
from pages import PATIENCE_S, TWO_ON_A_LOOP, needs_chromium
from playwright.sync_api import Browser, Page, expect
from takt import checks, report
from takt.failed_assertion import FailedAssertion
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


def test_a_plain_assertion_has_its_curve_and_its_place(
    browser: Browser, recording: takt.Recording, tmp_path: Path
) -> None:
    """And where it names nothing, at least the place, which all curves of the machine then show."""
    (mark,) = (event.time_s for event in recording.events if event.text == "it waits")
    for components, shown in (({"one"}, 1), (set(), 0)):
        assertion = FailedAssertion("no (a.py:1)", mark, frozenset(components), frozenset({"x"})).verdict(recording)
        file = tmp_path / "report.html"
        file.write_text(report.render(recording, [], "t", assertion=assertion), encoding="utf-8")
        with opened(browser, file) as page:
            expect(page.locator("#pill")).to_have_text("1 of 1 failed")
            first = page.locator("article.verdict").first
            expect(first.locator("strong").first).to_have_text("assert(one)" if components else "assert")
            expect(first.locator(".sentence")).to_have_text("no (a.py:1)")
            expect(first.locator("canvas")).to_have_count(shown)
            assert page.evaluate("() => window.takt.clock.time") == pytest.approx(mark)
            first.get_by_role("button", name="Go to place").click()
            begin, end = page.evaluate("() => window.takt.curves.plots.window")
            assert begin < mark < end
            assert end - begin < 1.01


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


def blue(page: Page, plots: str, times: list[float]) -> list[list[bool]]:
    """Of each of these plots: whether something blue, as the first curve is, stands at these times."""
    script = """([plots, times]) => eval(plots).map(({ plot: u }) => times.map((time) => {
        const { data } = u.ctx.getImageData(Math.round(u.valToPos(time, "x", true)), u.bbox.top, 1, u.bbox.height);
        for (let i = 0; i < data.length; i += 4) if (data[i + 2] > data[i] + 60 && data[i + 3] > 128) return true;
        return false;
    }))"""
    found: list[list[bool]] = page.evaluate(script, [plots, times])
    return found


def test_nothing_is_drawn_where_samples_are_missing(browser: Browser, tmp_path: Path) -> None:
    """Curves, bands of states and the curves of verdicts end there; what was recorded at a lower rate does not."""
    whole = one_axis()
    x = whole["x"]
    tables = {"x": np.delete(x, range(400, 600)), "slow": x[::20]}
    of_both = {
        "info": {name: whole.info("x") for name in tables},
        "names": {name: {"state": whole.names("x", "state")} for name in tables},
    }
    units = {name: {field: whole.unit("x", field) for field in whole.fields("x")[2:]} for name in tables}
    holed = takt.Recording(tables, units, **of_both)
    verdicts = [
        checks.within_limits(holed, "x", velocity=100),
        checks.stays(holed, "x.state == Standstill"),
        checks.keeps_distance(holed, "x", "slow", 1.0),
        checks.stays(holed, "slow.set_position < 50"),
    ]
    assert not any(verdicts)
    file = tmp_path / "report.html"
    file.write_text(report.render(holed, verdicts, "holed"), encoding="utf-8")
    with opened(browser, file) as page:
        page.evaluate("() => { for (const block of window.takt.curves.blocks.values()) block.make(); }")
        page.evaluate("() => { for (const card of window.takt.verdicts.cards) window.takt.verdicts.make(card); }")
        times = [0.3, 0.41, 0.5, 0.59, 0.7]
        of = lambda name: f"takt.curves.plots.items.filter(({{ node }}) => node.closest('[data-name={name}]'))"  # noqa: E731
        positions, *_, states = blue(page, of("x"), times)
        assert positions == states == [True, False, False, False, True]
        page.evaluate("() => { for (const { plots } of window.takt.verdicts.cards) plots.zoom(0.2, 0.8); }")
        seen = [blue(page, f"takt.verdicts.cards[{i}].plots.items", times)[0] for i in range(4)]
        assert seen == [[True, False, False, False, True]] * 3 + [[True] * 5]


def test_a_broken_limit_is_seen_however_far_away_it_is(browser: Browser, tmp_path: Path) -> None:
    """Of a curve that does not change, too; where all is well and 0, its axis has a range for people."""
    rec = takt.Recording({"x": {"time_s": np.arange(50) * 0.01, "still": np.full(50, 0.7), "nothing": np.zeros(50)}})
    conditions = {"x.still < 0.1": 0.1, "x.still > 30": 30.0, "x.nothing == 2": 2.0, "x.nothing < 400": None}
    file = tmp_path / "report.html"
    file.write_text(report.render(rec, [checks.stays(rec, condition) for condition in conditions], "t"), "utf-8")
    with opened(browser, file) as page:
        page.evaluate("() => window.takt.verdicts.cards.forEach((card) => window.takt.verdicts.make(card))")
        script = "() => window.takt.verdicts.cards.map(({ plots }) => plots.items[0].plot.scales.y)"
        for seen, limit in zip(page.evaluate(script), conditions.values(), strict=True):
            low, high = seen["min"], seen["max"]
            assert (low, high) == (-1, 1) if limit is None else low < limit < high


def test_curves_of_a_mover_can_be_told_apart(browser: Browser, failed: Path) -> None:
    """As those of an axis: each thing has its colour, and what is commanded is dashed beside what was measured."""
    with opened(browser, failed) as page:
        page.evaluate("() => window.takt.curves.blocks.get('one').make()")
        script = """() => {
            const buttons = [...document.querySelectorAll("[data-name=one] .legend button")];
            return Object.fromEntries(buttons.map((button) => {
                const line = button.querySelector("i");
                return [button.querySelector("span").textContent, [line.style.borderColor, line.className]];
            }));
        }"""
        looks = {label: tuple(look) for label, look in page.evaluate(script).items()}
        places = ["x", "actual x", "track position"]
        assert len({looks[label] for label in places}) == len(places)
        assert [looks[label][1] for label in places] == ["dashed", "", ""]


def test_the_summary_is_seen_whole_on_a_narrow_page(browser: Browser, failed: Path) -> None:
    with opened(browser, failed) as page:
        page.set_viewport_size({"width": 800, "height": 900})
        box = page.locator("#summary-section .scroll")
        assert box.evaluate("(node) => node.scrollWidth <= node.clientWidth")
        expect(page.locator("#summary tr", has_text="one").locator("td").last).to_have_text("0")


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
            expect(page.locator(".component small")).to_have_text("1 sample: nothing to draw")
