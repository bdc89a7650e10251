"""`takt demo`: the ready machines, what of each the live page shows at first, and the page beside a scenario."""

from __future__ import annotations

import contextlib
import itertools
import json
import os
import re
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import parse_qs

import pytest
import takt
from machines import MACHINE
from pages import PATIENCE_S, Client, needs_chromium, served
from playwright.sync_api import Browser, expect
from takt.cli import main
from takt.demo import free_url
from takt.ready import ready_machines
from takt.scenario import load_scenario

NAMES = [one.name for one in ready_machines()]
STAYS = "stay until Ctrl-C"
SHORT = """
TAKES_S = 1
VIEW = {"signals": ["x.set_position"]}

def scenario(session):
    x = session.axis("x")
    x.power().wait()
    x.move_absolute(position=50).wait()

def verify(recording):
    assert recording["x"]["set_position"][-1] == 50, "x did not get there"
"""


class Demo:
    """`takt demo` as a process that is given no terminal."""

    def __init__(self, *arguments: str | Path) -> None:
        command = [sys.executable, "-m", "takt", "demo", *map(str, arguments)]
        self.process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        self.said = ""

    def until(self, text: str) -> str:
        """The line that has the text; all until then is in `said`."""
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self.said += line
            if text in line:
                return line
        pytest.fail(f"the demo ended without a word of {text!r}: {self.said}")

    def interrupt(self) -> int:
        """As Ctrl-C on a terminal: all that it has started hears it, too."""
        os.killpg(self.process.pid, signal.SIGINT)
        return self.ended()

    def ended(self) -> int:
        rest, _ = self.process.communicate(timeout=60)
        self.said += rest
        return self.process.returncode


@contextlib.contextmanager
def demo(*arguments: str | Path) -> Iterator[Demo]:
    running = Demo(*arguments)
    try:
        yield running
    finally:
        if running.process.poll() is None:
            running.interrupt()


# --- which there are ---


def test_the_ready_machines_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert {"one_axis", "six_axes", "flying_saw", "pick_cell", "planar_line", "planar_sorter"} <= set(NAMES)
    assert main(["demo"]) == 0
    rows = {line.split()[0]: line for line in capsys.readouterr().out.splitlines() if line.strip()}
    for one in ready_machines():
        assert one.sentence.endswith(".")
        assert one.sentence in rows[one.name]
        assert rows[one.name].endswith(f"  {one.takes_s:.0f} s")


def test_the_readme_lists_them_as_they_introduce_themselves() -> None:
    readme = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
    for one in ready_machines():
        assert f"| `{one.name}` | {one.sentence} | {one.takes_s:.0f} s |" in readme


@pytest.mark.parametrize(
    ("given", "nearest"), [("pickcell", "pick_cell"), ("saw", "flying_saw"), ("qqq", ", ".join(NAMES))]
)
@pytest.mark.parametrize("command", ["demo", "run"])
def test_an_unknown_name_is_told_the_nearest_ones(
    given: str, nearest: str, command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([command, given]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.startswith(f"takt: {given}: neither a scenario file nor a ready machine; the nearest: {nearest}")
    assert said.err.count("\n") == 1


def test_one_runs_by_its_name_in_virtual_time(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "six_axes"]) == 0
    assert " 0 failed; " in capsys.readouterr().out


@pytest.mark.parametrize("name", NAMES)
def test_each_is_right_and_introduces_itself(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    """Loaded one after the other in one process, too: several have a judge.py or pictures.py beside them."""
    (ready,) = (one for one in ready_machines() if one.name == name)
    scenario = load_scenario(ready.scenario)
    assert main(["check", str(scenario.machine)]) == 0
    assert capsys.readouterr().out.endswith("ok\n")
    assert (scenario.title + ".", scenario.takes_s) == (ready.sentence, ready.takes_s)
    assert scenario.verify is not None
    for function in (scenario.scenario, scenario.pictures):
        for used in getattr(function, "__globals__", {}).values():
            beside = getattr(sys.modules.get(getattr(used, "__module__", "")), "__file__", None) or "examples"
            if "examples" in Path(beside).parts and beside != "examples":
                assert Path(beside).parent.name == name


@needs_chromium
@pytest.mark.parametrize("name", NAMES)
def test_the_page_shows_what_the_scenario_asks_for(name: str, browser: Browser) -> None:
    (ready,) = (one for one in ready_machines() if one.name == name)
    scenario = load_scenario(ready.scenario)
    asked = parse_qs(scenario.view)
    with served(str(scenario.machine), "--pace", "paced") as address:
        page = browser.new_page()
        page.goto(f"{address}#{scenario.view}")
        page.wait_for_function("() => window.takt?.scope.signals.length > 0", timeout=PATIENCE_S * 1000)
        assert page.evaluate("() => window.takt.scope.signals.map((s) => s.name)") == asked["signals"][0].split(",")
        assert page.get_attribute(f"#tab-{asked['tab'][0]}", "aria-selected") == "true"
        page.close()


@pytest.mark.parametrize(
    ("constant", "sentence"),
    [
        ('VIEW = {"tabs": "scope"}', 'VIEW must be like {"tab": "scope", "signals": ["x.set_position"]}'),
        ('VIEW = {"signals": "x.set_position"}', 'VIEW must be like {"tab": "scope", "signals": ["x.set_position"]}'),
        ("TAKES_S = 'long'", "TAKES_S must be a number of seconds above 0, found 'long'"),
        ("TAKES_S = 0", "TAKES_S must be a number of seconds above 0, found 0"),
    ],
)
def test_bad_constants_of_a_scenario(
    constant: str, sentence: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "scenario.py"
    file.write_text(f"{SHORT}\n{constant}\n")
    assert main(["demo", str(file)]) == 2
    assert capsys.readouterr().err == f"takt: {file}: {sentence}\n"


# --- the page beside it ---


@needs_chromium
def test_a_demo_with_the_page(tmp_path: Path, browser: Browser) -> None:
    """The scenario waits for the page, which sees all of it; the engine stays for whoever wants to jog, and what is
    done then is no part of the verdicts."""
    with demo("one_axis", "--view", "--no-browser", "--stay", "--pace", "paced", "--report", tmp_path) as running:
        address = running.until("the live page: ").split()[3]
        page = browser.new_page()
        page.set_default_timeout(PATIENCE_S * 1000)
        page.goto(address)
        running.until(STAYS)
        assert "no page was opened" not in running.said
        assert "11 passed, 0 failed" in running.said
        assert (tmp_path / "report.html").exists()
        assert (tmp_path / "one_axis.png").exists()

        # All of it came to the page: it stood at first, then it was powered and went to its places.
        script = """(field) => {
            const series = window.takt.scope.store.series.get(0);
            return [...series.columns.get(field).subarray(0, series.end)];
        }"""
        states, places = page.evaluate(script, "state"), page.evaluate(script, "set_position")
        codes = page.evaluate("() => window.takt.model.field(window.takt.model.components[0], 'state').names")
        seen = [codes[str(int(a))] for a, b in itertools.pairwise(states) if a != b]
        assert seen[:4] == ["Disabled", "Standstill", "Homing", "Standstill"]
        assert places[0] == 0
        assert max(places) == pytest.approx(550, abs=1e-6)

        page.click("#tab-machine")
        row = page.locator("#list .row:visible", has=page.locator(".name:text-is('x')"))
        row.click()
        page.click("#details-commands button:text-is('On')")
        expect(row.locator(".state")).to_have_text("Standstill", timeout=PATIENCE_S * 1000)
        page.close()
        assert running.interrupt() == 0
    assert "journal" not in running.said
    assert takt.Recording.load(tmp_path / "recording.npz")["x"]["state"][-1] == 0


def test_a_demo_without_a_terminal_ends_by_itself(tmp_path: Path) -> None:
    (tmp_path / "machine.yaml").write_text(MACHINE)
    (tmp_path / "there.py").write_text(SHORT)
    arguments = ("--view", "--no-browser", "--pace", "paced", "--report", tmp_path / "report")
    with demo(tmp_path / "there.py", *arguments) as running:
        address, _, shown = running.until("the live page: ").split()[3].partition("#")
        assert shown == "signals=x.set_position"
        with Client(address):
            running.until("scenario done")
        assert running.ended() == 0
    assert STAYS not in running.said
    kept = json.loads(re.findall(r'id="data">(.*?)</script>', (tmp_path / "report" / "report.html").read_text())[0])
    shown = kept["meta"]["engine"]
    assert "cycles" in shown
    assert "commands" in shown
    for name, text in shown.items():  # the report says what the terminal does
        assert re.search(rf"^{name}  {re.escape(text)}$", running.said, re.MULTILINE)
    assert "the same, bit for bit" in running.said


def test_a_demo_whose_scenario_breaks_off_is_judged_too(tmp_path: Path) -> None:
    (tmp_path / "machine.yaml").write_text(MACHINE)
    (tmp_path / "there.py").write_text(
        SHORT.replace("position=50).wait()", "position=50).wait()\n    assert x.error, 'no'")
    )
    with demo(tmp_path / "there.py", "--pace", "paced", "--report", tmp_path / "report") as running:
        assert running.ended() == 1
    assert re.search(r"failed +assert\(x\) +no \(there.py:9\) at [\d.]+ s", running.said)
    assert "0 passed, 1 failed" in running.said
    assert '"assertion":{"title":"assert(x)"' in (tmp_path / "report" / "report.html").read_text()


def test_a_verdict_is_the_exit_code_however_long_the_page_stays(tmp_path: Path) -> None:
    (tmp_path / "machine.yaml").write_text(MACHINE)
    (tmp_path / "there.py").write_text(SHORT.replace("== 50", "== 51"))
    arguments = ("--view", "--no-browser", "--stay", "--pace", "paced", "--report", tmp_path / "report")
    with demo(tmp_path / "there.py", *arguments) as running:
        with Client(running.until("the live page: ").split()[3].partition("#")[0]):
            running.until(STAYS)
        assert running.interrupt() == 1
    assert "x did not get there (there.py:" in " ".join(running.said.split())


def test_a_demo_takes_a_port_that_is_free(monkeypatch: pytest.MonkeyPatch) -> None:
    """Another program may have the port that it would take."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("", 0))
        taken = other.getsockname()[1]
        monkeypatch.setattr("random.sample", lambda ports, count: [taken, *range(ports[0], ports[0] + count - 1)])
        assert f":{taken}?" not in free_url()
        monkeypatch.setattr("random.sample", lambda ports, count: [taken] * count)
        with pytest.raises(takt.ConnectionError, match="Address already in use"):
            free_url()
