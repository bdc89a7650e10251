"""pytest for machines.

    @pytest.mark.takt_machine("machine.yaml")          # beside the test file
    def test_it_gets_there(engine, recording):
        ...
        rec = recording.stop()
        expect.reaches(rec, "x", 100.0, tolerance=0.01, by=2.0)

If a test fails, recordings that it asserts upon, that the fixture `recording` makes or that it passes to
`takt_keep` are kept: data (.npz) and picture (.png) in a directory of the test's own under --takt-reports. The
failure report names the files.
"""

from __future__ import annotations

import hashlib
import itertools
import re
from collections.abc import Callable, Generator, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from takt import expect
from takt.recording import Recording
from takt.verdict import Verdict

if TYPE_CHECKING:
    from takt.session import Recorder

Keep = Callable[..., Recording]


class _Kept:
    """The recordings that one test used, in order of use."""

    def __init__(self, directory: Path) -> None:
        self.directory = directory
        self.recordings: list[tuple[str, Recording]] = []
        self.running: list[Recorder] = []

    def add(self, recording: Recording, name: str | None = None) -> Recording:
        if not any(known is recording for _, known in self.recordings):
            self.recordings.append((name or f"recording{len(self.recordings) + 1}", recording))
        return recording

    def observe(self, recording: Recording, verdict: Verdict) -> None:
        self.add(recording)

    def write(self) -> list[str]:
        """Saves all recordings. Returns a line for each file, or with the reason why there is none."""
        lines = []
        for recorder in self.running:
            try:
                self.add(recorder.stop())
            except Exception as error:  # a failed engine must not hide the failure of the test
                lines.append(f"a recording could not be ended: {error}")
        stems: set[str] = set()
        for name, recording in self.recordings:
            stem = wanted = re.sub(r"[^\w.-]+", "_", name)[:80]
            for number in itertools.count(2):
                if stem not in stems:
                    break
                stem = f"{wanted}_{number}"
            stems.add(stem)
            try:
                lines.append(f"data:    {recording.save(self.directory / f'{stem}.npz')}")
                from takt import plot

                if any(recording.fields(c)[2:] for c in recording.components):
                    figure = plot.draw(recording, title=name)
                    lines.append(f"picture: {plot.save(figure, self.directory / f'{stem}.png')}")
            except Exception as error:
                lines.append(f"'{name}' could not be kept: {error}")
        return lines


_KEPT = pytest.StashKey[_Kept]()


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("takt", "motion engine")
    group.addoption(
        "--takt-reports",
        metavar="DIR",
        default="reports",
        help="where traces of failing tests go (default: %(default)s)",
    )
    group.addoption("--takt-keep-traces", action="store_true", help="keep the traces of passing tests as well")


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line(
        "markers",
        "takt_machine(path_or_text): the machine of the fixtures machine and engine; "
        "a path is relative to the test file",
    )


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item, nextitem: pytest.Item | None) -> Generator[None, object, object]:
    """Directs pictures of a test to its own directory, and remembers the recordings that it asserts upon."""
    kept = _Kept(Path(item.config.getoption("--takt-reports")) / directory_name(item.nodeid))
    item.stash[_KEPT] = kept
    before, expect.pictures = expect.pictures, kept.directory
    expect.observers.append(kept.observe)
    try:
        return (yield)
    finally:
        expect.observers.remove(kept.observe)
        expect.pictures = before
        del item.stash[_KEPT]


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item, call: pytest.CallInfo[None]
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    report = yield
    always = report.when == "call" and item.config.getoption("--takt-keep-traces")
    if (report.failed or always) and _KEPT in item.stash:
        lines = item.stash[_KEPT].write()
        if lines:
            report.sections.append(("Takt traces", "\n".join(lines)))
    return report


@pytest.fixture
def takt_keep(request: pytest.FixtureRequest) -> Keep:
    """takt_keep(recording, name=None) -> recording: keeps its trace if the test fails."""
    return request.node.stash[_KEPT].add  # type: ignore[no-any-return]


@pytest.fixture
def machine(request: pytest.FixtureRequest) -> str | Path:
    """The machine file (or its text) of the test, as named by the marker takt_machine. Override it to use
    another."""
    marker = request.node.get_closest_marker("takt_machine")
    if marker is not None and (len(marker.args) != 1 or marker.kwargs):
        given = ", ".join([*map(repr, marker.args), *(f"{name}={value!r}" for name, value in marker.kwargs.items())])
        pytest.fail(
            f"takt_machine({given}): expected one argument, the machine file or its text; for engines made otherwise "
            "override the fixture engine",
            pytrace=False,
        )
    if marker is None:
        pytest.fail(
            'no machine: mark the test with @pytest.mark.takt_machine("machine.yaml") or override the fixture machine',
            pytrace=False,
        )
    named: str | Path = marker.args[0]
    if isinstance(named, str) and "\n" in named:
        return named
    beside = request.path.parent / named
    path = beside if beside.exists() else request.config.rootpath / named
    if not path.exists():
        pytest.fail(
            f"no machine file {named} beside {request.path.name} or in {request.config.rootpath}",
            pytrace=False,
        )
    return path


@pytest.fixture
def engine(machine: str | Path) -> Iterator[Any]:
    """takt.Engine(machine), in virtual time, closed after the test."""
    import takt

    made = takt.Engine(machine)
    try:
        yield made
    finally:
        close = getattr(made, "close", None)
        if close is not None:
            close()


@pytest.fixture
def recording(request: pytest.FixtureRequest, engine: Any) -> Iterator[Recorder]:
    """Records the engine from the start of the test: recording.stop() returns the Recording."""
    recorder: Recorder = engine.record()
    request.node.stash[_KEPT].running.append(recorder)
    yield recorder
    recorder.stop()


def directory_name(nodeid: str) -> str:
    """Returns a readable and unique directory name for a test, also if its name has characters that file names cannot
    have."""
    readable = re.sub(r"[^\w.-]+", "-", nodeid.replace(".py::", ".").replace("::", ".").replace("/", ".")).strip("-.")
    if len(readable) > 120 or readable != nodeid.replace(".py::", ".").replace("::", ".").replace("/", "."):
        readable = f"{readable[:120]}-{hashlib.sha256(nodeid.encode()).hexdigest()[:6]}"
    return readable
