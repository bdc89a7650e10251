"""How signals are called on the live page, and what its address asks for and is not there."""

from __future__ import annotations

import re
from pathlib import Path

from machines import MACHINE
from pages import PATIENCE_S, needs_chromium, opened, served
from playwright.sync_api import Browser, expect

pytestmark = needs_chromium
expect.set_options(timeout=PATIENCE_S * 1000)


def test_names_that_are_not_there_are_said(tmp_path: Path, browser: Browser) -> None:
    (tmp_path / "machine.yaml").write_text(MACHINE)
    asked = "#tab=scope&signals=x.set_position,x.nosuch,q.state,lonely"
    with served(str(tmp_path / "machine.yaml"), "--pace", "paced") as address:
        with opened(browser, address, asked) as page:
            said = "x publishes no nosuch; there is no component q; there is no component lonely"
            expect(page.locator("#banner")).to_have_text(said)
            assert page.evaluate("() => window.takt.scope.signals.map((s) => s.name)") == ["x.set_position"]
        with opened(browser, address, "#tab=scope&signals=x.state") as page:
            expect(page.locator("#legend .entry")).to_have_count(1)
            expect(page.locator("#banner")).to_be_hidden()


def test_units_stand_beside_names_not_in_them(tmp_path: Path, browser: Browser) -> None:
    (tmp_path / "machine.yaml").write_text(MACHINE)
    with (
        served(str(tmp_path / "machine.yaml"), "--pace", "paced") as address,
        opened(browser, address, "#tab=scope&signals=x.voltage_v,x.torque_nm") as page,
    ):
        expect(page.locator("#legend strong")).to_have_text(["torque [Nm]", "voltage [V]"])
        expect(page.locator("#legend .entry span:first-of-type")).to_have_text(["x.torque", "x.voltage"])
        page.fill("#filter", "x torque")
        expect(page.locator("#signals .row.chosen:visible")).to_have_text(re.compile(r"torque[\d.]+ Nm$"))
        page.click("#tab-machine")
        page.locator("#list .row:visible", has=page.locator(".name:text-is('x')")).click()
        label = page.locator("#details label", has_text="voltage")
        expect(label.locator("span")).to_have_text("voltage")
        expect(label.locator("output")).to_have_text(re.compile(r"^[\d.]+ V$"))
