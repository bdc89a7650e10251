"""PY-20: what keeps a scenario from passing: a command that was refused, a wait in vain, nothing that was judged."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
import takt
from machines import MACHINE, new_url, running
from takt.cli import main
from takt.demo import run_demo
from takt.scenario import load_scenario
from test_report import payload

PROGRAM = """from takt import expect
from helper import far

def go(x, place):
    return x.move_absolute(position=place)

def scenario(session):
    x = session.axis("x")
    x.power().wait()
{lines}
    session.run(0.02)

def verify(recording):
    expect.within_limits(recording, "x")
"""
HELPER = """def far(x):
    x.move_absolute(position=2000).wait()
"""


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("machine.yaml").write_text(MACHINE)
    Path("helper.py").write_text(HELPER)
    return tmp_path


def write(*lines: str) -> None:
    Path("program.py").write_text(PROGRAM.format(lines="\n".join(f"    {line}" for line in lines)))


def first_of(page: Path) -> tuple[str, str, dict[str, Any]]:
    """Title and sentence of what a report shows first, and all that it was made of."""
    data, _ = payload(page.read_text(encoding="utf-8"))
    first = data["assertion"] or data["verdicts"][0]
    return first["title"], first["sentence"], data


BROKEN = {
    "waited for": (["go(x, 12).wait()", "go(x, 1500).wait()"], "program.py:5, called from program.py:11", True),
    "in another file": (["far(x)"], "helper.py:2, called from program.py:10", True),
    "in the cycle": (
        ["x.power(enable=False).wait()", "go(x, 5).wait()"],
        "program.py:5, called from program.py:11",
        True,
    ),
    "never asked for": (["go(x, 1500)"], "program.py:5, called from program.py:10", False),
    "never asked for, in the cycle": (["x.power(enable=False).wait()", "x.halt()"], "program.py:11", False),
}


@pytest.mark.parametrize(
    ("case", "where"),
    [*((case, "in process") for case in BROKEN), ("waited for", "over LCM"), ("never asked for", "over LCM")],
)
def test_a_refused_command(case: str, where: str, here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Exit code 1, and the first thing that is said and shown: what was refused, why, where it stands."""
    lines, place, breaks_off = BROKEN[case]
    write(*lines)
    if where == "in process":
        assert main(["run", "program.py", "--report", "out"]) == 1
    else:
        url = new_url()
        with running(here, url):
            assert main(["run", "program.py", "--url", url, "--report", "out"]) == 1
    said = capsys.readouterr()
    assert said.err == ""
    assert said.out.splitlines()[0].startswith("failed  command(x)  x.")
    assert f"({place})" in said.out.splitlines()[0]
    title, sentence, data = first_of(Path("out/report.html"))
    assert title == "command(x)"
    assert re.match(r"x\.\w+.*: .+ \(error \d+\) \(", sentence)
    assert f"({place})" in sentence
    assert [v["passed"] for v in data["verdicts"]] == ([] if breaks_off else [True])
    assert data["assertion"]["lanes"]
    assert takt.Recording.load("out/recording.npz").duration_s > 0
    # Judged again, it is what it was.
    assert main(["report", "out", "--scenario", "program.py", "-o", "again.html"]) == 1
    assert first_of(Path("again.html"))[:2] == (title, sentence)


HEEDED = {
    "waited for": "assert not go(x, 1500).wait_final().done",
    "asked": "command = go(x, 1500)\n    session.run(0.01)\n    assert command.error",
    "looked at": "command = go(x, 1500)\n    session.run(0.01)\n    print(command)",
    "caught": "import contextlib, takt\n    with contextlib.suppress(takt.CommandError):\n        far(x)",
    "aborted by the next one": "go(x, 500)\n    go(x, 20).wait()",
    "failed on the way": "x.move_velocity(velocity=400)\n    session.run(3)\n    x.reset()\n    session.run(0.1)",
}


@pytest.mark.parametrize("case", HEEDED)
def test_a_scenario_that_asks_what_became_of_it(case: str, here: Path) -> None:
    """It knows what it does, as one that tries what is refused; and what failed after it began shows in the states."""
    write(*HEEDED[case].split("\n    "))
    assert main(["run", "program.py"]) == 0


def test_several_refused_commands_are_counted(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write("go(x, 1500)", "go(x, 1600)", "session.axis('r').halt()")
    assert main(["run", "program.py"]) == 1
    first = capsys.readouterr().out.splitlines()[0]
    assert "x.move_absolute {position: 1500}" in first
    assert first.endswith("nothing asked what became of it, and 2 commands more")


def test_a_wait_in_vain(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write("session.wait(lambda: x.set_position > 10, 0.5, what='x beyond 10')")
    assert main(["run", "program.py", "--report", "out"]) == 1
    assert "failed  wait  x beyond 10: not met within 0.5 s (program.py:10) at 0.6" in capsys.readouterr().out
    assert first_of(Path("out/report.html"))[0] == "wait"


VERIFY = {
    "False": ("return False", "verify returned False (judged.py:5)"),
    "numpy's False": ("return recording['x']['set_position'].max() > 1000", "verify returned False (judged.py:5)"),
    "nothing": ("pass", "nothing was judged: verify has no assertion, and returns no True (judged.py:5)"),
    "a value": ("return recording.duration_s", "nothing was judged: verify has no assertion"),
    "a print": ("print(recording)", "nothing was judged: verify has no assertion"),
}
JUDGES = {
    "True": "return True",
    "numpy's True": "return recording['x']['set_position'].max() < 1000",
    "an assertion of motion": "expect.within_limits(recording, 'x')",
    "a plain one": "assert recording.duration_s > 0",
    "one of a function": "long(recording)",
    "one of another file": "helper.far_away(recording)",
    "one of another file's class": "helper.Far.away(recording)",
    "one of a static method": "Still.judge(recording)",
    "one of a method": "Judge().long(recording)",
    "one inside": "[check() for check in [lambda: long(recording)]]",
}
JUDGED = """import helper
from takt import expect
def scenario(session):
    session.axis("x").power().wait()
def verify(recording):
    {line}
def long(recording):
    assert recording.duration_s > 0
class Judge:
    def long(self, recording):
        assert recording.duration_s > 0
class Still:
    @staticmethod
    def judge(recording):
        assert recording.duration_s > 0
"""
JUDGED_HELPER = """def far_away(recording):
    assert recording.duration_s > 0
class Far:
    @classmethod
    def away(cls, recording):
        assert recording.duration_s > 0
"""


@pytest.mark.parametrize("case", VERIFY)
def test_verify_does_not_pass(case: str, here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    line, sentence = VERIFY[case]
    Path("judged.py").write_text(JUDGED.format(line=line))
    assert main(["run", "judged.py", "--report", "out"]) == 1
    said = capsys.readouterr().out
    assert f"failed  verify  {sentence}" in said
    assert "0 passed, 1 failed" in said
    title, shown, _ = first_of(Path("out/report.html"))
    assert title == "verify"
    assert shown.startswith(sentence)
    assert main(["report", "out", "--scenario", "judged.py", "-o", "again.html"]) == 1


@pytest.mark.parametrize("case", JUDGES)
def test_verify_judges(case: str, here: Path) -> None:
    Path("helper.py").write_text(JUDGED_HELPER)
    Path("judged.py").write_text(JUDGED.format(line=JUDGES[case]))
    assert main(["run", "judged.py"]) == 0


def test_a_scenario_with_a_dataclass(here: Path) -> None:
    Path("data.py").write_text(
        "from __future__ import annotations\nfrom dataclasses import dataclass\n"
        "@dataclass\nclass Place:\n    x: float\ndef scenario(session):\n    session.run(Place(0.1).x)\n"
        "def verify(recording):\n    return True\n"
    )
    assert main(["run", "data.py"]) == 0


def test_packages_beside_two_scenarios(here: Path) -> None:
    """PY-20: a package of one scenario is not taken for that of another."""
    for name in ("first", "second"):
        package = here / name / "helpers"
        package.mkdir(parents=True)
        (package / "__init__.py").write_text("")
        (package / "names.py").write_text(f"NAME = '{name}'")
        (here / name / "s.py").write_text(
            "from helpers.names import NAME\nmachine = {}\n__doc__ = NAME\ndef scenario(session): pass\n"
        )
        assert load_scenario(here / name / "s.py").title == name


def test_without_verify(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A scenario may judge itself; one that does not has not passed."""
    Path("plain.py").write_text("def scenario(session):\n    session.run(0.1)\n")
    assert main(["run", "plain.py"]) == 1
    assert "nothing was judged: plain.py has no verify(recording)" in capsys.readouterr().out
    Path("plain.py").write_text("def scenario(session):\n    session.run(0.1)\n    assert session.now > 0\n")
    assert main(["run", "plain.py"]) == 0


def test_a_demo(here: Path) -> None:
    """On a taktd of its own."""
    write("go(x, 1500)")
    result = run_demo(load_scenario("program.py"), Path("machine.yaml"), Path("out"), lambda _: None, "paced")
    assert not result.passed
    assert result.outcome.assertion is not None
    assert "program.py:5, called from program.py:10" in result.outcome.complaint


def test_output_into_a_pipe_is_plain(
    here: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Neither wrapped at a width, nor padded, nor coloured."""
    monkeypatch.setattr("takt.cli.out.width", 40)
    write("go(x, 1500)")
    assert main(["run", "program.py"]) == 1
    assert main(["demo"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert any(len(line) > 150 for line in lines)
    assert all(line == line.strip() and "   " not in line and "\x1b" not in line for line in lines)
