"""The pictures of the live page and of a report in docs/images: examples, and what pages show, in a real browser.

build/venv/bin/python -m tools.page_pictures docs/images [NAME ...]
"""

from __future__ import annotations

import contextlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from playwright.sync_api import Page, sync_playwright
from takt import Engine, checks
from takt.demo import free_url, taktd
from takt.report import compare, keep, write_comparison, write_report
from takt.scenario import load_scenario, run_scenario
from takt.sweep import sweep
from takt.view.server import serving

from tools import page_blocks
from tools.browser import CHROMIUM, FLAGS

ROOT = Path(__file__).resolve().parents[1]
SIZE = {"width": 1400, "height": 820}
COMMANDED = "+commands"  # the example with a page that may command

# Name of the picture: example, or page and the folder of its files, dark, what the address says, s of engine time from
# the beginning of the scenario; what is done on the page before the picture is taken.
PICTURES: dict[str, tuple[str, bool, str, float, str]] = {
    "view_scope": (
        "flying_saw",
        False,
        "tab=scope&signals=web.set_velocity,saw.set_velocity,saw.set_position,saw.actual_position,"
        "saw.set_acceleration,saw.following_error,saw.state,cutter.state,cutter.cam_synchronised",
        11.5,
        """() => {
            const { scope } = window.takt;
            scope.pause(true);
            scope.a = scope.held.to - 4200;
            scope.b = scope.held.to - 2750;
        }""",
    ),
    "view_one_axis": (
        "one_axis",
        False,
        "tab=scope&signals=x.set_position,x.actual_position,x.set_velocity,x.set_acceleration,x.state",
        12.8,
        "",
    ),
    "view_plan": ("pick_cell", False, "tab=plan", 12.0, ""),
    "view_3d": ("delta_cell", True, "tab=3d", 12.0, ""),
    "view_movers": ("planar_line", True, "tab=plan", 50.0, ""),
    "view_machine": ("pick_cell", True, "tab=machine", 12.0, ""),
    "view_first": (
        "tutorial/gear",
        False,
        "tab=scope&signals=web.set_position,knife.set_position,web.set_velocity,knife.set_velocity,knife.state,"
        "knife.in_step",
        1.25,
        """() => {
            const { scope } = window.takt;
            scope.pause(true);
            scope.setSpan(2);
        }""",
    ),
    "view_cams": ("flying_saw", False, "tab=cams", 9.3, ""),
    "view_cam_edit": (
        "flying_saw" + COMMANDED,
        False,
        "tab=cams",
        6.5,
        """() => {
            const [card] = window.takt.cams.cards;
            card.buttons.begin.click();
            const { edit } = card;
            const [x, y] = edit.knots[3];
            edit.drag(3, x - 12, y - 25);
        }""",
    ),
}

# Of the report of a run that failed: dark, what is done on the page before the picture is taken.
REPORTS: dict[str, tuple[bool, str]] = {
    "report": (False, ""),
    "report_above": (
        True,
        """() => {
            document.getElementById("scene-section").scrollIntoView();
            window.takt.clock.set(window.takt.clock.from + 15.37);
        }""",
    ),
    "report_3d": (
        False,
        """() => {
            document.getElementById("scene-section").scrollIntoView();
            window.takt.clock.set(window.takt.clock.from + 15.37);
            window.takt.scene.open("space");
        }""",
    ),
}


PARTS = {"report_3d": "#scene-section"}  # of pages, by themselves

COMPARISON = "compare"  # of two runs
SWEEP = "sweep"
SHOWN = """() => {
    document.querySelectorAll("#differences tr").forEach((row, i) => { row.hidden = i > 7; });
    for (const id of ["verdicts-section", "facts-section", "same"]) document.getElementById(id).hidden = true;
    scrollTo(0, 0);
}"""


@contextlib.contextmanager
def machine_of(name: str) -> Iterator[Path]:
    """The folder with the machine and the scenario of an example, or of a page."""
    page, _, folder = name.partition("/")
    if not folder and not name.endswith(COMMANDED):
        yield ROOT / "python" / "examples" / name
        return
    if not folder:
        with tempfile.TemporaryDirectory() as directory:
            copy = Path(directory) / "machine"
            shutil.copytree(ROOT / "python" / "examples" / name.removesuffix(COMMANDED), copy)
            with (copy / "machine.yaml").open("a", encoding="utf-8") as file:
                file.write("view: {commands: true}\n")
            yield copy
        return
    with tempfile.TemporaryDirectory() as directory:
        page_blocks.unpack(ROOT / "docs" / f"{page}.md", Path(directory))
        yield Path(directory) / folder


@contextlib.contextmanager
def running(folder: Path) -> Iterator[tuple[str, str]]:
    """The machine of a folder on a taktd of its own: its LCM network, and the address of its page."""
    url = free_url()
    with (
        tempfile.TemporaryDirectory() as directory,
        serving(url) as address,
        taktd(folder / "machine.yaml", url, None, "paced", Path(directory)),
    ):
        yield url, address


@contextlib.contextmanager
def playing(folder: Path, url: str) -> Iterator[None]:
    """Its scenario."""
    command = [sys.executable, "-m", "takt", "run", str(folder / "scenario.py"), "--url", url]
    scenario = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        yield
    finally:
        scenario.kill()
        scenario.wait()


def take(name: str, target: Path) -> None:
    example, dark, hash_, seconds, before = PICTURES[name]
    with machine_of(example) as folder, running(folder) as (url, address), sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        page: Page = browser.new_page(viewport=SIZE, color_scheme="dark" if dark else "light")  # type: ignore[arg-type]
        page.goto(f"{address}#{hash_}")
        page.wait_for_selector("body.ready", timeout=60_000)
        with playing(folder, url):
            page.wait_for_function("() => window.takt.model.events.length", timeout=60_000)
            page.wait_for_function(
                "(s) => window.takt.model.now > s + window.takt.model.events[0][0] * window.takt.model.period",
                arg=seconds,
                timeout=600_000,
            )
            if before:
                page.evaluate(before)
                time.sleep(0.5)
            page.screenshot(path=str(target))
        browser.close()


def take_report(name: str, target: Path) -> None:
    dark, before = REPORTS.get(name, (False, SHOWN if name == COMPARISON else ""))
    with tempfile.TemporaryDirectory() as directory, sync_playwright() as playwright:
        report = {COMPARISON: two_runs, SWEEP: swept}.get(name, failed)(Path(directory))
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        page: Page = browser.new_page(viewport=SIZE, color_scheme="dark" if dark else "light")  # type: ignore[arg-type]
        page.goto(report.as_uri())
        page.wait_for_selector("body.ready", timeout=60_000)
        if before:
            page.evaluate(before)
        page.wait_for_timeout(1000)
        if name in PARTS:
            page.wait_for_function("() => window.takt.space.frames > 1")
            page.locator(PARTS[name]).screenshot(path=str(target))
        else:
            page.screenshot(path=str(target))
        browser.close()


def failed(directory: Path) -> Path:
    """The report of the picking Delta, of which more is asked than it does."""
    scenario = load_scenario(ROOT / "python" / "examples" / "pick_cell" / "scenario.py")
    with Engine(scenario.machine) as engine:
        outcome = run_scenario(scenario, engine)
    verdict = checks.stays(outcome.recording, "|arm_2.following_error| < 0.1")
    return write_report(outcome.recording, [verdict, *outcome.verdicts], directory, scenario.title).html


def two_runs(directory: Path) -> Path:
    """Two runs of the ready axis, one with half its jerk."""
    scenario = load_scenario(ROOT / "python" / "examples" / "one_axis" / "scenario.py")
    text = scenario.machine.read_text(encoding="utf-8")
    runs = []
    for machine in (text, text.replace("jerk: 100000", "jerk: 50000")):
        with Engine(machine) as engine:
            outcome = run_scenario(scenario, engine)
        runs.append(keep(outcome.recording, scenario.title, outcome.verdicts, outcome.assertion))
    before, after = runs
    return write_comparison(compare(before, after, ("before", "after")), directory / "compare.html")


def swept(directory: Path) -> Path:
    """The sweep of its page."""
    page_blocks.unpack(ROOT / "docs" / "sweeps.md", directory)
    grid, sample = ["velocity=100:400:4"], ["axes.ram.limits.acceleration=uniform:2000:8000:25"]
    before = Path.cwd()
    os.chdir(directory)  # whose name the commands of the page would say otherwise
    try:
        return sweep("scenario.py", grid, sample, "sweep").page.resolve()
    finally:
        os.chdir(before)


def main() -> int:
    folder, *names = sys.argv[1:]
    for name in names or [*PICTURES, *REPORTS, COMPARISON, SWEEP]:
        (take if name in PICTURES else take_report)(name, Path(folder) / f"{name}.png")
        print(Path(folder) / f"{name}.png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
