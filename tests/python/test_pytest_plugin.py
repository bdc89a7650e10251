"""PY-06: the pytest plugin: fixtures for machine, engine and recording; on failure the trace is kept."""

from __future__ import annotations

from collections.abc import Callable
from importlib.metadata import entry_points
from pathlib import Path

import pytest
from takt.pytest_plugin import directory_name
from takt.recording import Recording

pytest_plugins = ["pytester"]

Run = Callable[..., pytest.RunResult]

# Where the package is installed, pytest finds the plugin by itself.
LOADED = any(e.name == "takt" for e in entry_points(group="pytest11"))
ARGUMENTS = () if LOADED else ("-p", "takt.pytest_plugin")

FAKE_ENGINE = """
import numpy as np
import pytest
import takt
from takt.recording import Recording

def curve():
    t = np.arange(100) / 1000
    columns = {"time_s": t, "set_position": t * 10, "actual_position": t * 10}
    return Recording({"x": columns}, {"x": {"actual_position": "mm"}})

class Recorder:
    result = None
    def stop(self):
        if self.result is None:
            self.result = curve()
        return self.result

class Engine:
    log = []
    def __init__(self, machine):
        self.machine = machine
        self.log.append("made")
    def record(self):
        self.log.append("recording")
        return Recorder()
    def close(self):
        self.log.append("closed")

takt.Engine = Engine
"""


@pytest.fixture
def run(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> Run:
    monkeypatch.delenv("PYTEST_ADDOPTS", raising=False)
    pytester.makeconftest(FAKE_ENGINE)
    pytester.makefile(".yaml", machine="name: fake")

    def runner(source: str, *arguments: str) -> pytest.RunResult:
        pytester.makepyfile(test_it=source)
        return pytester.runpytest_subprocess(*ARGUMENTS, "-p", "no:cacheprovider", *arguments)

    return runner


# PY-06: on failure the trace is kept, and the report says where
def test_a_failing_test_keeps_its_trace(run: Run, pytester: pytest.Pytester) -> None:
    result = run(
        """
        import pytest
        from takt import expect

        pytestmark = pytest.mark.takt_machine("machine.yaml")

        def test_good(engine, recording):
            expect.reaches(recording.stop(), "x", 0.9, tolerance=0.01, by=0.099)

        def test_bad(engine, recording):
            expect.reaches(recording.stop(), "x", 5.0, tolerance=0.01, by=0.099)

        def test_bad_before_the_recording_ended(engine, recording):
            assert engine.machine.name == "other.yaml"
        """
    )
    result.assert_outcomes(passed=1, failed=2)
    bad = pytester.path / "reports" / "test_it.test_bad"
    result.stdout.fnmatch_lines(
        [
            "*MotionAssertionError: reaches(x): x did not reach 5 mm*",
            "*picture: reports/test_it.test_bad/reaches_x_*.png",
            "*Takt traces*",
            "data:    reports/test_it.test_bad/recording1.npz",
            "picture: reports/test_it.test_bad/recording1.png",
        ]
    )
    kept = Recording.load(bad / "recording1.npz")
    assert len(kept["x"]) == 100
    assert (bad / "recording1.png").read_bytes().startswith(b"\x89PNG")
    assert len(list(bad.glob("reaches_x_*.png"))) == 1
    assert (pytester.path / "reports" / "test_it.test_bad_before_the_recording_ended" / "recording1.npz").exists()
    assert not (pytester.path / "reports" / "test_it.test_good").exists()


# PY-06: options
def test_traces_of_passing_tests_and_another_directory(run: Run, pytester: pytest.Pytester) -> None:
    result = run(
        """
        import pytest
        from conftest import curve

        @pytest.mark.parametrize("what", ["a/b", "a:b"])
        def test_good(what, takt_keep):
            assert takt_keep(curve(), "first try") is not None
            rec = curve()
            assert takt_keep(rec) is takt_keep(rec)
            takt_keep(curve(), "first:try")
        """,
        "--takt-keep-traces",
        "--takt-reports",
        "out",
    )
    result.assert_outcomes(passed=2)
    directories = sorted((pytester.path / "out").iterdir())
    assert len(directories) == 2
    for directory in directories:
        assert sorted(p.name for p in directory.iterdir()) == [
            "first_try.npz", "first_try.png", "first_try_2.npz", "first_try_2.png", "recording2.npz", "recording2.png",
        ]  # fmt: skip


# PY-06: every recording that is asserted upon is kept, once
def test_recordings_need_not_be_registered(run: Run, pytester: pytest.Pytester) -> None:
    result = run(
        """
        from conftest import curve
        from takt import expect

        def test_bad():
            rec = curve()
            expect.within_limits(rec, "x", position=(0, 1))
            expect.within_limits(curve(), "x", position=(0, 2))
            expect.within_limits(rec, "x", position=(0, 3))
            assert False
        """
    )
    result.assert_outcomes(failed=1)
    names = sorted(p.name for p in (pytester.path / "reports" / "test_it.test_bad").glob("*.npz"))
    assert names == ["recording1.npz", "recording2.npz"]


# PY-06: fixtures
def test_machines_and_engines(run: Run) -> None:
    result = run(
        """
        import pathlib
        import pytest
        import takt

        @pytest.mark.takt_machine("machine.yaml")
        def test_path(engine):
            assert engine.machine == pathlib.Path(__file__).parent / "machine.yaml"

        def test_the_engine_before_was_closed():
            assert takt.Engine.log == ["made", "closed"]

        @pytest.mark.takt_machine("name: text\\naxes: []\\n")
        def test_text(engine):
            assert engine.machine.startswith("name: text")

        class TestOverride:
            @pytest.fixture
            def machine(self):
                return "my own"

            def test_override(self, engine):
                assert engine.machine == "my own"

        @pytest.mark.takt_machine("nothing.yaml")
        def test_missing(engine):
            pass

        def test_none(engine):
            pass

        @pytest.mark.takt_machine("machine.yaml", changes={"name": "n"})
        def test_more(engine):
            pass
        """
    )
    result.assert_outcomes(passed=4, errors=3)
    result.stdout.fnmatch_lines(
        [
            "*no machine file nothing.yaml beside test_it.py*",
            "*no machine: mark the test with*",
            "*takt_machine('machine.yaml', changes={'name': 'n'}): expected one argument, the machine file*",
        ]
    )


# PY-06: keeping a trace must not hide why the test failed
def test_a_trace_that_cannot_be_kept_says_so(run: Run, pytester: pytest.Pytester) -> None:
    (pytester.path / "blocked").write_text("")
    result = run(
        """
        import pytest
        from conftest import curve

        class Broken:
            def record(self):
                return self

            def stop(self):
                raise RuntimeError("engine gone")

        @pytest.fixture
        def engine():
            return Broken()

        def test_bad(recording, takt_keep):
            takt_keep(curve())
            assert 1 == 2
        """,
        "--takt-reports",
        "blocked",
    )
    result.assert_outcomes(failed=1, errors=1)  # the fixture itself cannot end the recording either
    result.stdout.fnmatch_lines(["*assert 1 == 2*", "*Takt traces*"])
    result.stdout.fnmatch_lines(["a recording could not be ended: engine gone", "'recording1' could not be kept: *"])


def test_plain_tests_are_left_alone(run: Run, pytester: pytest.Pytester) -> None:
    result = run("def test_bad():\n    assert False\n", "--strict-markers")
    result.assert_outcomes(failed=1)
    result.stdout.no_fnmatch_line("*Takt traces*")
    assert not (pytester.path / "reports").exists()
    assert pytester.runpytest_subprocess(*ARGUMENTS, "--markers").stdout.str().count("takt_machine") == 1


@pytest.mark.parametrize(
    ("nodeid", "expected"),
    [
        ("tests/python/test_a.py::test_b", "tests.python.test_a.test_b"),
        ("test_a.py::TestC::test_b", "test_a.TestC.test_b"),
    ],
)
def test_directories_are_named_after_tests(nodeid: str, expected: str) -> None:
    assert directory_name(nodeid) == expected


def test_no_two_tests_share_a_directory() -> None:
    names = {directory_name(f"t.py::test[{v}]") for v in ("a/b", "a:b", "a b", "a-b", "../../x", "x" * 300, "x" * 301)}
    assert len(names) == 7
    assert all(len(n) < 140 and "/" not in n and Path(n).name == n for n in names)
