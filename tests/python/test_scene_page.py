"""The machine in three dimensions (PY-27) in a real browser, without a graphics card: the live page and reports."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import takt
from machines import new_url, running
from pages import PATIENCE_S, needs_chromium, opened, served, until
from playwright.sync_api import Browser, Page, expect
from takt import report, view
from takt.ready import EXAMPLES
from takt.report.writing import three_inside
from takt.scene import node_pose
from test_scene import described, with_held

pytestmark = needs_chromium
expect.set_options(timeout=PATIENCE_S * 1000)

LIMITS = "limits: {velocity: 500, acceleration: 5000, jerk: 200000"
MACHINE = f"""name: all_kinds
lcm: {{axis_rate_hz: 250}}
axes:
  - {{name: x, unit: mm, {LIMITS}, lower: 0, upper: 600}}}}
  - {{name: y, unit: mm, {LIMITS}, lower: 0, upper: 600}}}}
  - {{name: z, unit: mm, {LIMITS}, lower: 0, upper: 300}}}}
  - {{name: c, unit: deg, {LIMITS}, lower: -180, upper: 180}}}}
  - {{name: belt_drive, unit: mm, {LIMITS}}}}}
  - {{name: slide, unit: mm, {LIMITS}, lower: -10, upper: 400}}}}
  - {{name: disc, unit: deg, kind: rotary, modulus: 360, {LIMITS}}}}}
groups:
  - name: portal
    axes: [x, y, z, c]
    base: {{x: 50, y: 20, z: 10, c: 30}}
    kinematics: {{gantry: {{axes: [x, y, z, c]}}}}
    tool: {{z: -60}}
    path: {{velocity: 500, acceleration: 5000, jerk: 200000}}
    workspace:
      obstacles: [{{name: post, cylinder: {{radius: 30, height: 300}}, pose: {{x: 300, y: 300}}}}]
      gripper: [{{name: finger, cylinder: {{radius: 8, height: 60}}, pose: {{z: -30}}}}]
belts:
  - {{name: infeed, axis: belt_drive, origin: {{x: 900, z: 50, c: 90}}, lower_limit: 100, upper_limit: 500}}
coordinate_systems: [{{name: upper}}, {{name: lower}}]
parts:
  - {{name: table, columns: 3, rows: 2, positions: [{{coordinate_system: lower, x: 1200, y: 240}}]}}
tracks:
  - {{name: line, part: table, elements: [{{from: {{x: 100, y: 240}}, to: {{x: 600, y: 240}}}}]}}
movers:
  - {{name: m1, reference: table, initial: {{x: 200, y: 240}},
     xy: {{maximum: {{velocity: 1000, acceleration: 5000, jerk: 100000}}}}}}
"""
# How many pixels are not of the background, which is that of the corner; and how many colours there are.
DRAWN = """() => {
    const { space } = window.takt;
    space.draw();
    const gl = space.renderer.getContext();
    const [w, h] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
    const pixels = new Uint8Array(4 * w * h);
    gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    const colours = new Map();
    for (let i = 0; i < pixels.length; i += 4) {
        const colour = (pixels[i] << 16) | (pixels[i + 1] << 8) | pixels[i + 2];
        colours.set(colour, (colours.get(colour) ?? 0) + 1);
    }
    const most = Math.max(...colours.values());
    return { share: 1 - most / (w * h), colours: colours.size };
}"""
# Where the page has put everything, and what it made that of, at one time.
PLACED = """() => {
    const { space, model } = window.takt;
    space.draw();
    const live = {};
    for (const component of model.components) {
        const { live: fields } = model.kinds[component.kind];
        live[component.name] = Object.fromEntries(fields.map((field) => [field, model.liveOf(component, field)]));
    }
    const rows = (matrix) => matrix.clone().transpose().elements;
    const nodes = space.nodes.map(({ node, root }) => [node.name, root.visible, rows(root.matrix)]);
    return { nodes, live, poses: model.poses };
}"""


ORBIT = """() => {
    const { around, above, distance, target } = window.takt.space.orbit;
    return [around, above, distance, ...target.toArray()];
}"""
FOLLOWED = """() => {
    const { model, space } = window.takt;
    space.draw();
    return [model.poses.portal.at(-1), space.orbit.target.toArray()];
}"""
ARRIVED = """() => {
    const { model } = window.takt;
    return Math.abs(model.liveOf(model.byName.get("x"), "actual_position") - 200) < 0.1;
}"""


def open_3d(page: Page) -> None:
    until(page, "() => window.takt.space?.frames > 1")


@contextlib.contextmanager
def report_page(browser: Browser, file: Path, dark: bool = False) -> Iterator[Page]:
    """A report from its file, offline. It must not fail, and ask for nothing that is not inside."""
    failures: list[str] = []
    asked: list[str] = []
    context = browser.new_context(viewport={"width": 1440, "height": 860}, color_scheme="dark" if dark else "light")
    context.set_offline(True)
    page = context.new_page()
    page.set_default_timeout(PATIENCE_S * 1000)
    page.on("pageerror", lambda error: failures.append(str(error)))
    page.on("request", lambda request: asked.append(request.url))
    page.goto(file.as_uri())
    page.wait_for_selector("body.ready")
    yield page
    context.close()
    assert failures == []
    assert [url for url in asked if not url.startswith(("data:", "blob:"))] == [file.as_uri()]


def agrees(seen: Mapping[str, Any], scene: Mapping[str, Any]) -> int:
    """Whether the page puts every node where Python does from the same numbers. How many are to be seen."""
    nodes = {node["name"]: node for node in scene["nodes"]}
    assert {name for name, _, _ in seen["nodes"]} == set(nodes)
    links = {group: np.array(poses, float) for group, poses in seen["poses"].items()}
    count = 0
    for name, visible, elements in seen["nodes"]:
        if not visible:
            continue
        count += 1
        expected = node_pose(scene, nodes[name], links, lambda component, field: seen["live"][component][field])
        np.testing.assert_allclose(np.reshape(elements, (4, 4)), expected, atol=2e-2, err_msg=name)
    return count


def test_the_live_page_draws_what_python_describes(tmp_path: Path, browser: Browser) -> None:
    url = new_url()
    with (
        running(tmp_path, url, machine=MACHINE),
        served(url) as address,
        opened(browser, address, "#tab=3d") as page,
        takt.connect(url) as session,
    ):
        for axis, target in {"x": 120.0, "y": 80.0, "z": 30.0, "c": 40.0, "slide": 200.0, "disc": 77.0}.items():
            session.axis(axis).power().wait()
            session.axis(axis).move_absolute(position=target)
        session.axis("belt_drive").power().wait()
        session.axis("belt_drive").move_velocity(velocity=100)
        open_3d(page)
        until(page, "() => window.takt.space.nodes.every(({ root }) => root.visible)")
        scene = described(MACHINE).scene
        seen = page.evaluate(PLACED)
        assert agrees(seen, scene) == len(scene["nodes"])
        drawn = page.evaluate(DRAWN)
        assert drawn["share"] > 0.03
        assert drawn["colours"] > 50

        # By keys and the mouse.
        orbit = lambda: page.evaluate(ORBIT)  # noqa: E731
        page.keyboard.press("t")
        assert orbit()[1] == pytest.approx(np.pi / 2, abs=0.01)
        page.keyboard.press("f")
        assert orbit()[:2] == pytest.approx([-np.pi / 2, 0])
        page.keyboard.press("ArrowUp")
        assert orbit()[1] > 0.1
        before = orbit()
        page.keyboard.press("+")
        assert orbit()[2] == pytest.approx(0.8 * before[2])
        page.keyboard.press("Shift+ArrowLeft")
        assert np.linalg.norm(np.subtract(orbit()[3:], before[3:])) > 1
        box = page.locator("#space-canvas").bounding_box()
        assert box is not None
        middle = (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
        before = orbit()
        page.mouse.move(*middle)
        page.mouse.down()
        page.mouse.move(middle[0] + 100, middle[1] - 20, steps=3)
        page.mouse.up()
        assert orbit()[0] == pytest.approx(before[0] - 0.6)
        assert orbit()[3:] == pytest.approx(before[3:])
        page.mouse.wheel(0, -100)
        until(page, "([distance]) => window.takt.space.orbit.distance < distance", before[2])
        page.keyboard.press("0")
        page.keyboard.press("p")

        # It follows a tool, and a mover.
        page.select_option("#space-follow", "portal")
        session.axis("x").move_absolute(position=200).wait()
        until(page, ARRIVED)
        tool = page.evaluate(FOLLOWED)
        assert tool[1] == pytest.approx(tool[0][:3], abs=1e-3)
        page.select_option("#space-follow", "m1")
        until(page, "() => Math.abs(window.takt.space.orbit.target.x - 1400) < 1")

        # A path that is refused: what would meet what, in red.
        portal = session.group("portal")
        for axis in portal.members:
            axis.halt().wait()
        portal.enable().wait()
        portal.move_linear_absolute(coordinate_system="mcs", x=400, y=520, z=0).wait_final()
        expect(page.locator("#space-refused")).to_contain_text("portal: finger would meet post")
        red = """() => window.takt.space.nodes.flatMap(({ meshes }) => meshes)
            .filter((mesh) => mesh.material === window.takt.space.material("bad")).map((mesh) => mesh.userData.part)"""
        assert sorted(page.evaluate(red)) == ["finger", "post"]


@pytest.fixture(scope="module")
def recording() -> takt.Recording:
    with takt.Engine(MACHINE) as session:
        recorder = session.record()
        for axis, target in {"x": 120.0, "y": 80.0, "z": 30.0, "c": 40.0, "slide": 200.0, "disc": 77.0}.items():
            session.axis(axis).power()
            session.run(0.05)
            session.axis(axis).move_absolute(position=target)
        session.run(1.0)
        return recorder.stop()


def test_the_report_draws_any_time(browser: Browser, recording: takt.Recording, tmp_path: Path) -> None:
    file = tmp_path / "report.html"
    file.write_text(report.render(recording, [], "t"), encoding="utf-8")
    scene = described(MACHINE).scene
    with report_page(browser, file, dark=True) as page:
        assert page.evaluate("() => window.takt.space.three === undefined")  # not before it is asked for
        page.locator("#scene-tabs").get_by_text("3D").click()
        open_3d(page)
        for share in (0.0, 0.4, 1.0):
            page.evaluate("(s) => { const c = window.takt.clock; c.set(c.from + s * (c.to - c.from)); }", share)
            seen = page.evaluate(PLACED)
            assert agrees(seen, scene) == len(scene["nodes"])
            time_s = page.evaluate("() => window.takt.clock.time")
            row = np.searchsorted(recording["slide"]["time_s"], time_s + 1e-9, side="right") - 1
            assert seen["live"]["slide"]["actual_position"] == pytest.approx(
                recording["slide"]["actual_position"][row], abs=1e-3
            )
        assert page.evaluate(DRAWN)["share"] > 0.03
        # Keys of the camera do not move the time once the picture was clicked.
        time_s = page.evaluate("() => window.takt.clock.time")
        page.locator("#space-canvas").click()
        page.keyboard.press("ArrowLeft")
        assert page.evaluate("() => window.takt.clock.time") == time_s
        page.locator("#scene-tabs").get_by_text("From above").click()
        expect(page.locator("#plan-canvas")).to_be_visible()


def test_what_a_module_holds_goes_with_the_tool(browser: Browser, tmp_path: Path) -> None:
    with takt.Engine(EXAMPLES / "pick_cell" / "machine.yaml") as session:
        recorder = session.record()
        session.run(0.2)
        recording = with_held(recorder.stop(), 0.1, 1.0)
    file = tmp_path / "report.html"
    file.write_text(report.render(recording, [], "t"), encoding="utf-8")
    scene = described((EXAMPLES / "pick_cell" / "machine.yaml").read_text()).scene
    with report_page(browser, file) as page:
        page.locator("#scene-tabs").get_by_text("3D").click()
        open_3d(page)
        counts = []
        for time_s in (0.05, 0.15, 0.05):
            page.evaluate("(s) => window.takt.clock.set(s)", time_s)
            seen = page.evaluate(PLACED)
            counts.append(agrees(seen, scene))
            assert {name: shown for name, shown, _ in seen["nodes"]}["picker.held"] == (time_s > 0.1)
        assert counts == [len(scene["nodes"]) - 1, len(scene["nodes"]), len(scene["nodes"]) - 1]


def test_a_machine_of_axes_alone_is_drawn_and_small(browser: Browser, tmp_path: Path) -> None:
    text = f"name: one\naxes:\n  - {{name: x, unit: mm, {LIMITS}}}}}\n"
    with takt.Engine(text) as session:
        recorder = session.record()
        session.axis("x").power().wait()
        session.axis("x").move_absolute(position=50).wait()
        recording = recorder.stop()
    file = tmp_path / "report.html"
    page_text = report.render(recording, [], "t")
    file.write_text(page_text, encoding="utf-8")
    assert page_text.count(three_inside()) == 1
    assert len(three_inside()) < 280_000
    with report_page(browser, file) as page:
        expect(page.locator("#scene-tabs button:visible")).to_have_text(["3D"])
        page.locator("#scene-section").scroll_into_view_if_needed()
        open_3d(page)
        assert page.evaluate(DRAWN)["share"] > 0.03
    del recording.meta["machine_file"]  # without its machine there is nothing to draw, and nothing to draw with
    assert three_inside() not in report.render(recording, [], "t")


def test_a_browser_without_webgl_says_so(browser: Browser, recording: takt.Recording, tmp_path: Path) -> None:
    file = tmp_path / "report.html"
    file.write_text(report.render(recording, [], "t"), encoding="utf-8")
    with report_page(browser, file) as page:
        page.evaluate(
            """() => {
            const get = HTMLCanvasElement.prototype.getContext;
            HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
                return kind.startsWith("webgl") ? null : get.call(this, kind, ...more);
            };
        }"""
        )
        page.locator("#scene-tabs").get_by_text("3D").click()
        expect(page.locator("#space-empty")).to_contain_text("This browser cannot draw in three dimensions")
        page.locator("#scene-tabs").get_by_text("From above").click()
        expect(page.locator("#plan-canvas")).to_be_visible()


def test_the_library_says_whose_it_is() -> None:
    folder = Path(view.__file__).parent / "page" / "three"
    assert "The MIT License" in (folder / "LICENSE").read_text()
    version = re.search(r"three.js 0\.(\d+)\.\d+", (folder / "README.md").read_text())
    assert version is not None
    assert f'"{version[1]}"' in (folder / "three.core.min.js").read_text(encoding="utf-8")[:300]
