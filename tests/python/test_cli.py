"""PY-07: the command line."""

from __future__ import annotations

import errno
import json
import os
import resource
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import lcm
import pytest
import takt
from machines import MACHINE, new_url, running
from takt import msgs
from takt.cli import main
from takt.figures import quantile
from takt.tables import is_possible
from takt.written import write_text

SCENARIO = '''"""Goes and comes back.

More about it."""
from takt import expect

def scenario(session):
    x = session.axis("x")
    x.power().wait()
    x.move_absolute(position=60.0, velocity=300.0).wait()
    x.move_absolute(position=10.0).wait()
    session.run(0.1)

def verify(recording):
    expect.within_limits(recording, "x")
    expect.reaches(recording, "x", 60.0, tolerance=0.05, by=recording.start_s + 1.5)
    expect.visits_states(recording, "x", ["Standstill", "DiscreteMotion"])
'''


@pytest.fixture
def files(tmp_path: Path) -> Path:
    (tmp_path / "machine.yaml").write_text(MACHINE)
    (tmp_path / "there.py").write_text(SCENARIO)
    return tmp_path


def test_check_and_schema(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """PY-07, EN-10: all problems, one line each, exit code 2."""
    good, bad = files / "machine.yaml", files / "bad.yaml"
    assert main(["check", str(good)]) == 0
    assert capsys.readouterr().out == f"{good}: ok\n"
    bad.write_text(MACHINE.replace("unit: mm", "unitt: mm").replace("unit: deg", "unitt: deg"))
    assert main(["check", str(good), str(bad)]) == 2
    captured = capsys.readouterr()
    assert captured.out == f"{good}: ok\n"
    assert [line.startswith(f"{bad}:") for line in captured.err.splitlines()] == [True, True]
    assert main(["schema"]) == 0
    assert json.loads(capsys.readouterr().out)["title"] == "Machine"


@pytest.mark.parametrize("where", ["in process", "over LCM"])
def test_run(where: str, files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """PY-02, PY-06, PY-07: the same verdicts in virtual time and on a running engine; report and recording are
    written."""
    report = files / "report"
    if where == "in process":
        assert main(["run", str(files / "there.py"), "--report", str(report)]) == 0
    else:
        url = new_url()
        with running(files, url):
            assert main(["run", str(files / "there.py"), "--url", url, "--report", str(report)]) == 0
    text = capsys.readouterr().out
    assert "3 passed, 0 failed" in text
    assert "within_limits(x)" in text
    assert "Goes and comes back" in (report / "report.html").read_text()
    assert takt.Recording.load(report / "recording.npz").duration_s > 0.2


def test_pictures_of_the_scenario(files: Path) -> None:
    """PY-06: what a scenario draws itself stands in the report and beside it."""
    drawing = """
def pictures(recording):
    from matplotlib.figure import Figure
    figure = Figure()
    figure.add_subplot().plot(recording["x"]["time_s"], recording["x"]["set_position"])
    return {"x over <time>": figure}
"""
    (files / "there.py").write_text(SCENARIO + drawing)
    assert main(["run", str(files / "there.py"), "--report", str(files / "report")]) == 0
    page = (files / "report" / "report.html").read_text()
    assert "<h2>x over &lt;time&gt;</h2>" in page
    assert 'src="data:image/png;base64,' in page
    assert (files / "report" / "x_over_time_.png").read_bytes().startswith(b"\x89PNG")


def test_run_fails(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """PY-07: exit code 1 where something that was verified is not so."""
    (files / "not.py").write_text(SCENARIO.replace('"x", 60.0', '"x", 61.0') + '    assert False, "plainly"\n')
    assert main(["run", str(files / "not.py"), "--machine", str(files / "machine.yaml")]) == 1
    text = capsys.readouterr().out
    assert "plainly (not.py:17)" in text
    assert "2 passed, 2 failed" in text
    broken = SCENARIO.replace("    session.run(0.1)", "    assert x.actual_position > 1000")
    (files / "broken.py").write_text(broken)
    assert main(["run", str(files / "broken.py"), "--report", str(files / "report")]) == 1
    assert "assert x.actual_position > 1000 (broken.py:11)" in capsys.readouterr().out
    assert takt.Recording.load(files / "report" / "recording.npz").duration_s > 0.2


BAD = {
    "no such file": (["run", "none.py"], "there is no such file"),
    "no scenario": (["run", "empty.py"], "has no function scenario"),
    "syntax": (["run", "syntax.py"], "syntax.py:1: "),
    "mistake": (["run", "mistake.py"], "ZeroDivisionError: division by zero (mistake.py:2)"),
    "no engine": (["run", "there.py", "--url", "udpm://239.255.76.67:19999?ttl=0"], "no engine answers"),
    "wrong url": (["run", "there.py", "--url", "tin can"], "expected one like udpm://"),
    "both": (["run", "there.py", "--url", "a", "--machine", "b"], "give one of them"),
    "machine": (["check", "none.yaml"], "none.yaml: cannot be read"),
    "replay": (["replay", "there.py"], "is not an LCM log"),
    "plot": (["plot", "none.npz"], "none.npz"),
    "replay run": (["replay", "there.lcm", "--run", "5"], "holds 1 run; there is no run 5"),
    "exit": (["run", "exits.py"], "exits.py: ended by exit(7)"),
    "exit at once": (["run", "exits_at_once.py"], "exits_at_once.py: ended by exit(8)"),
    "arguments": (["run", "arguments.py"], "arguments.py: scenario must take one argument, scenario(session)"),
    "pictures": (["run", "pictures.py"], "pictures.py: pictures is no function"),
    "plot where": (["plot", "there.npz", "-o", "nowhere/a.png"], "nowhere/a.png: there is no directory nowhere"),
    "plot what": (["plot", "there.npz", "-o", "a.xyz"], "a.xyz: expected a name that ends in .png or .svg or .pdf"),
    "save what": (["log", "there.lcm", "--save", "a.txt"], "a.txt: expected a name that ends in .npz or .csv"),
    "demo machine": (["demo", "there.py", "--machine", "bad.yaml"], "bad.yaml:3:"),
    "demo start": (["demo", "there.py"], "taktd does not start: "),
    "option": (["check", "--nonsense"], "No such option"),
    "command": (["nonsense"], "No such command"),
}


def _stand_in(taktd: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A taktd that ends at once, found before any other: beside the interpreter."""
    taktd.parent.mkdir()
    taktd.write_text("#!/bin/sh\nexit 1\n")
    taktd.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(taktd.with_name("python")))


@pytest.mark.parametrize("case", BAD)
def test_mistakes_are_one_line(
    case: str, files: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """PY-07: errors in one line with exit code 2."""
    monkeypatch.chdir(files)
    _stand_in(files / "bin" / "taktd", monkeypatch)
    Path("empty.py").write_text("")
    Path("exits.py").write_text("import sys\ndef scenario(session):\n    sys.exit(7)\n")
    Path("exits_at_once.py").write_text("exit(8)\n")
    Path("arguments.py").write_text("def scenario():\n    pass\n")
    Path("pictures.py").write_text(SCENARIO + "pictures = 1\n")
    Path("bad.yaml").write_text(MACHINE.replace("axes:", "axis:"))
    log = lcm.EventLog("there.lcm", "w", overwrite=True)
    log.write_event(1, "nothing", b"")
    log.close()
    Path("syntax.py").write_text("def :\n")
    Path("mistake.py").write_text("def scenario(session):\n    1 / 0\n")
    arguments, sentence = BAD[case]
    assert main(arguments) == 2
    captured = capsys.readouterr()
    assert captured.out == "" or case == "demo start"
    assert sentence in captured.err
    assert not Path("nowhere").exists()
    assert captured.err.count("\n") == 1


def test_a_demo_without_taktd(files: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """PY-07: neither beside the interpreter nor on the path."""
    monkeypatch.setattr(sys, "executable", str(files / "python"))
    monkeypatch.setenv("PATH", str(files))
    assert main(["demo", str(files / "there.py")]) == 2
    assert capsys.readouterr().err.strip().endswith("taktd is not installed (or not on PATH)")


def test_tracebacks_on_request(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """PY-07."""
    (files / "mistake.py").write_text("def scenario(session):\n    1 / 0\n")
    assert main(["--traceback", "run", str(files / "mistake.py")]) == 2
    assert "Traceback" in capsys.readouterr().err


def test_logs(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """PY-07, EN-07: log, replay and plot of what taktd wrote."""
    url = new_url()
    log = files / "run.lcm"
    with running(files, url, "--log", str(log)):
        assert main(["run", str(files / "there.py"), "--url", url]) == 0
    capsys.readouterr()
    assert main(["log", str(log), "--save", str(files / "run.csv")]) == 0
    text = capsys.readouterr().out
    assert "takt/axis/x" in text
    assert "run 0: test, 2 components" in text
    assert (files / "run.csv").read_text().startswith("cycle,time_s,x.set_position [mm]")
    assert main(["replay", str(log)]) == 0
    assert "the same, bit for bit" in capsys.readouterr().out
    assert main(["plot", str(log), "x", "--to", "0.5", "-o", str(files / "x.png")]) == 0
    assert (files / "x.png").read_bytes().startswith(b"\x89PNG")


def test_a_log_with_changed_bytes_is_drawn(files: Path) -> None:
    """PY-04, bad input: a state whose cycle cannot be true is left out."""
    log = lcm.EventLog(str(files / "changed.lcm"), "w", overwrite=True)
    machine = msgs.machine_description()
    machine.text, machine.period_s = MACHINE, 0.001
    log.write_event(1, "takt/machine", machine.encode())
    for cycle, time_ns in ((0, 0), (1, 10**6), (2**60, 2 * 10**6), (-5, 0), (3, 3 * 10**6)):
        state = msgs.axis_state()
        state.name, state.cycle, state.time_ns = "x", cycle, time_ns
        log.write_event(1, "takt/axis/x", state.encode())
    log.close()
    assert takt.read_log(files / "changed.lcm")["x"]["cycle"].tolist() == [0, 1, 3]
    assert main(["plot", str(files / "changed.lcm"), "-o", str(files / "a.svg")]) == 0
    assert (files / "a.svg").read_text().startswith("<?xml")


def test_states_of_a_period_that_is_no_whole_number_of_ns() -> None:
    """Cycles and times of the engine differ by what its period was rounded; after a day that is many cycles."""
    state = msgs.axis_state()
    state.cycle = 3000 * 86_400
    state.time_ns = state.cycle * 333_333
    assert is_possible(state, 1 / 3000)
    state.cycle += 1000
    assert not is_possible(state, 1 / 3000)


def test_a_log_with_changed_numbers_says_so(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Bad input."""
    log = lcm.EventLog(str(files / "changed.lcm"), "w", overwrite=True)
    machine = msgs.machine_description()
    machine.text, machine.period_s = MACHINE, 0.001
    log.write_event(1, "takt/machine", machine.encode())
    state = msgs.axis_state()
    state.name, state.buffered_commands = "x", -9
    log.write_event(1, "takt/axis/x", state.encode())
    log.close()
    assert main(["plot", str(files / "changed.lcm")]) == 2
    assert "x.buffered_commands holds a number that no engine publishes" in capsys.readouterr().err


def test_quantiles() -> None:
    """EN-05: inside a bucket in proportion, never beyond the longest time; the last bucket is known by that alone."""
    buckets = [0] * 32
    buckets[10] = 100
    assert quantile({"buckets": buckets, "count": 100, "max": 2000}, 0.5) == 1536
    assert quantile({"buckets": buckets, "count": 100, "max": 1100}, 0.99) == 1100
    buckets[31] = 100
    assert quantile({"buckets": buckets, "count": 200, "max": 2**40}, 0.99) == 2**40


def test_bench(capsys: pytest.CaptureFixture[str]) -> None:
    """PY-07, PY-08: prints what it measures; how fast it must be is for ./dev bench."""
    assert main(["bench", "--axes", "2", "--cycles", "2000"]) == 0
    text = capsys.readouterr().out
    assert "idle" in text
    assert "moving" in text


def test_as_a_module(files: Path) -> None:
    run = [sys.executable, "-m", "takt"]
    done = subprocess.run([*run, "--help"], capture_output=True, text=True, check=True)
    for command in ("check", "run", "replay", "plot", "bench", "schema", "log"):
        assert f"  {command} " in done.stdout
    done = subprocess.run([*run, "check", str(files / "none.yaml")], capture_output=True, text=True)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)


@pytest.mark.parametrize("where", ["a pipe without a reader", "an encoding without ²"])
def test_a_run_does_not_depend_on_its_output(where: str, files: Path) -> None:
    """PY-06, PY-07: the report is written, and the exit code is that of the run."""
    failing = SCENARIO.replace('"x", 60.0', '"x", 61.0')
    (files / "not.py").write_text(failing)
    reader, writer = os.pipe()
    if where == "a pipe without a reader":
        os.close(reader)
    env = os.environ | {"PYTHONIOENCODING": "ascii" if where.startswith("an encoding") else "utf-8"}
    for name, code in (("there", 0), ("not", 1)):
        command = [sys.executable, "-m", "takt", "run", f"{name}.py", "--report", name]
        ran = subprocess.run(command, cwd=files, stdout=writer, stderr=subprocess.PIPE, text=True, check=False, env=env)
        assert (ran.returncode, ran.stderr) == (code, "")
        assert (files / name / "report.html").is_file()
    os.close(writer)
    if where != "a pipe without a reader":
        with os.fdopen(reader, encoding="ascii") as said:
            assert "acceleration limit of 5000 mm/s?" in said.read()


def test_a_report_that_cannot_be_made_leaves_the_verdicts(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """PY-07: they are printed before the mistake of `pictures`."""
    (files / "there.py").write_text(SCENARIO + "def pictures(recording):\n    return 1 / 0\n")
    assert main(["run", str(files / "there.py"), "--report", str(files / "report")]) == 2
    captured = capsys.readouterr()
    assert "3 passed, 0 failed" in captured.out
    assert "ZeroDivisionError" in captured.err


def test_names_of_files_that_are_no_utf8(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """PY-07, PY-24, CAM-92: every byte that Python cannot decode is shown as U+FFFD."""
    name = os.fsdecode(b"m\xe4")
    folder = files / name
    folder.mkdir()
    machine, scenario, cam = (folder / f"{name}.{ending}" for ending in ("yaml", "py", "csv"))
    machine.write_text(MACHINE)
    scenario.write_text(
        "def scenario(session, d=1.0):\n    session.run(0.1)\ndef verify(recording):\n    assert False\n"
    )
    cam.write_text("x,y\n0,0\n1,1\n2,1\n")
    assert main(["check", str(machine)]) == 0
    report = folder / "report"
    assert main(["run", str(scenario), "--machine", str(machine), "--report", str(report)]) == 1
    assert "assert False (m\ufffd.py:4)" in (report / "report.html").read_text()
    (folder / "recording.npz").write_bytes((report / "recording.npz").read_bytes())
    for command, file in (
        (["report", str(report / "recording.npz")], report / "recording.html"),
        (["report", str(report), str(folder)], None),
        (["plot", str(report / "recording.npz"), "x", "-o", str(folder / f"{name}.png")], folder / f"{name}.png"),
        (["export", str(report), "--parquet", str(folder / f"{name}.parquet")], folder / f"{name}.parquet"),
        (["cam", str(cam), "--yaml", str(folder / "cam.yaml")], folder / "cam.yaml"),
    ):
        assert main(command) == 0, capsys.readouterr().err
        assert file is None or file.is_file()
    assert 'name: "m\ufffd"' in (folder / "cam.yaml").read_text()
    sweep = ["sweep", str(scenario), "--machine", str(machine), "--grid", "d=1,2", "-o", str(folder / name)]
    assert main([*sweep, "--workers", "1"]) == 1
    assert "m\ufffd.py" in (folder / name / "sweep.html").read_text()
    machine.write_text("name: [")
    assert main(["check", str(machine)]) == 2
    assert "m\ufffd.yaml:1:" in capsys.readouterr().err


@pytest.mark.parametrize("cam", ["points: [{x: 0, y: 0}, {x: 1, y: 1}]", "file: points.csv"])
def test_a_run_in_a_folder_whose_name_is_no_utf8(cam: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """PY-07, CAM-04: names that are relative to it are found."""
    folder = tmp_path / os.fsdecode(b"m\xe4")
    folder.mkdir()
    monkeypatch.chdir(folder)
    Path("points.csv").write_text("x,y\n0,0\n1,1\n")
    Path("machine.yaml").write_text(
        f"{MACHINE}cams: [{{name: c, {cam}}}]\n"
        "groups: [{name: g, axes: [x, r], kinematics: {gantry: {axes: [x, c]}},\n"
        "          path: {velocity: 300, acceleration: 3000, jerk: 60000}}]\n"
    )
    Path("there.py").write_text(SCENARIO)
    assert main(["check", "machine.yaml"]) == 0
    assert main(["run", "there.py", "--report", "report"]) == 0
    assert Path("report/report.html").is_file()


def test_a_log_whose_name_is_no_utf8(files: Path) -> None:
    """PY-06, PY-07."""
    url = new_url()
    log = files / os.fsdecode(b"l\xe4.log")
    with running(files, url, "--log", str(log)), takt.connect(url) as session:
        session.axis("x").power().wait()
    assert main(["replay", str(log)]) == 0
    assert main(["report", str(log)]) == 0
    assert "l\ufffd.log" in log.with_suffix(".html").read_text()


@pytest.fixture
def full_disk() -> Iterator[None]:
    """Files end at 20 kB."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.parametrize(
    ("command", "target"),
    [
        (["run", "there.py", "--report", "report"], "report/recording.npz"),
        (["report", "kept.npz", "-o", "page.html"], "page.html"),
        (["report", "kept.npz", "kept.npz", "-o", "page.html"], "page.html"),
        (["plot", "kept.npz", "-o", "picture.png"], "picture.png"),
        (["export", "kept.npz", "--csv", "kept.csv"], "kept.csv"),
        (["export", "kept.npz", "--mcap", "kept.mcap"], "kept.mcap"),
        (["export", "kept.npz", "--parquet", "kept.parquet"], "kept.parquet"),
        (["cam", "cam.csv", "--csv", "points.csv", "--count", "9000"], "points.csv"),
    ],
)
def test_a_full_disk_is_named_and_leaves_no_half_files(
    command: list[str],
    target: str,
    files: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    request: pytest.FixtureRequest,
) -> None:
    """PY-07: the file that was there stays as it was."""
    monkeypatch.chdir(files)
    assert main(["run", "there.py", "--report", "report"]) == 0
    shutil.copy("report/recording.npz", "kept.npz")
    Path("cam.csv").write_text("x,y\n0,0\n1,1\n2,1\n")
    if target != "report/recording.npz":
        Path(target).write_text("before")
    before, listed = Path(target).read_bytes(), sorted(files.rglob("*"))
    request.getfixturevalue("full_disk")
    assert main(command) == 2
    assert capsys.readouterr().err == f"takt: {target}: File too large\n"
    assert Path(target).read_bytes() == before
    assert sorted(files.rglob("*")) == listed


@pytest.fixture
def own_folder() -> Iterator[Path]:
    """A folder of a user other than root, as which the test runs, too."""
    with tempfile.TemporaryDirectory() as name:
        if os.geteuid() != 0:
            yield Path(name)
            return
        os.chown(name, 65534, 65534)
        os.seteuid(65534)
        try:
            yield Path(name)
        finally:
            os.seteuid(0)


def test_a_write_protected_file_is_not_written(own_folder: Path) -> None:
    """PY-07: also where its folder takes other files."""
    target = own_folder / "kept.csv"
    target.write_text("before")
    target.chmod(0o444)
    with pytest.raises(PermissionError, match=r"Permission denied: '.*/kept\.csv'$"):
        write_text(target, "after")
    assert target.read_text() == "before"
    assert [*own_folder.iterdir()] == [target]


def test_written_files_keep_their_links_owner_and_group(tmp_path: Path) -> None:
    """PY-07: the file is the same, with another content."""
    target, link, symbolic = (tmp_path / name for name in ("a.csv", "b.csv", "c.csv"))
    target.write_text("before")
    link.hardlink_to(target)
    symbolic.symlink_to(target)
    write_text(symbolic, "after")
    assert link.read_text() == "after"
    assert link.samefile(target)
    assert symbolic.is_symlink()
    if os.geteuid() == 0:
        for owner in ((65534, 65534), (0, 65534)):
            other = tmp_path / f"{owner[0]}.csv"
            other.write_text("before")
            os.chown(other, *owner)
            other.chmod(0o640)
            write_text(other, "after")
            status = other.stat()
            assert (status.st_uid, status.st_gid, status.st_mode & 0o777) == (*owner, 0o640)
            assert other.read_text() == "after"


@pytest.mark.parametrize("number", [errno.EBUSY, errno.EPERM])
def test_a_file_that_cannot_be_replaced_is_written(
    number: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """PY-07: as one that is mounted by itself into a container."""

    def refused(path: Path, target: Path) -> Path:
        raise OSError(number, os.strerror(number), str(path), None, str(target))

    monkeypatch.setattr(Path, "replace", refused)
    target = tmp_path / "mounted.csv"
    target.write_text("before, and longer")
    write_text(target, "after")
    assert target.read_text() == "after"
    assert [*tmp_path.iterdir()] == [target]


def test_errors_of_writing_name_one_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, full_disk: None) -> None:
    """PY-07: the one that was to be written."""
    target = tmp_path / "kept.csv"
    with pytest.raises(OSError, match=r"File too large: '.*/kept\.csv'$"):
        write_text(target, "x" * 30_000)

    def broken(path: Path, target: Path) -> Path:
        raise OSError(errno.EIO, os.strerror(errno.EIO), str(path), None, str(target))

    monkeypatch.setattr(Path, "replace", broken)
    with pytest.raises(OSError, match=r"Input/output error: '.*/kept\.csv'$"):
        write_text(target, "x")
    assert not [*tmp_path.iterdir()]


def test_a_mistake_within_a_library_is_placed_in_the_scenario(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """PY-07: the line of the scenario, also from which its own modules were called."""
    (files / "helper.py").write_text("import json\ndef read():\n    return json.loads('x')\n")
    (files / "mistake.py").write_text(
        "import helper\ndef scenario(session):\n    helper.read()\ndef verify(r):\n    1\n"
    )
    assert main(["run", str(files / "mistake.py"), "--machine", str(files / "machine.yaml")]) == 2
    said = capsys.readouterr().err
    assert said.startswith("takt: JSONDecodeError: ")
    assert said.endswith("helper.py:3)\n")


@pytest.mark.parametrize("mistake", ["importlib.import_module('no_module')", "numpy.random.default_rng().choice([])"])
def test_a_mistake_is_not_placed_in_files_that_there_are_not(
    mistake: str, files: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """PY-07, PY-24: frames of frozen modules and of compiled sources have no absolute name."""
    monkeypatch.chdir(files)
    (files / "mistake.py").write_text(
        f"import importlib, numpy\n\ndef scenario(session, d=1.0):\n    {mistake}\n\ndef verify(recording):\n    1\n"
    )
    assert main(["run", "mistake.py"]) == 2
    assert capsys.readouterr().err.endswith(" (mistake.py:4)\n")
    assert main(["sweep", "mistake.py", "--grid", "d=1,2", "--workers", "1", "-o", "swept"]) == 1
    assert " (mistake.py:4)" in Path("swept/runs.csv").read_text()


def test_names_of_outputs_keep_what_is_no_ending(files: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """PY-06, PY-07: runs whose names differ behind the last dot have pages and pictures of their own."""
    monkeypatch.chdir(files)
    assert main(["run", "there.py", "--report", "run.v1"]) == 0
    for name in ("log.00", "log.01", "a.b.npz"):
        shutil.copy("run.v1/recording.npz", name)
        assert main(["plot", name, "x"]) == main(["report", name]) == 0
    assert main(["plot", "run.v1", "x"]) == 0
    assert main(["report", "log.00", "a.b.npz"]) == 0
    made = {"log.00", "log.01", "a.b", "log.00_and_a.b", "run.v1"}
    assert {path.stem for path in files.glob("*.html")} == made - {"run.v1"}
    assert {path.stem for path in files.glob("*.png")} == made - {"log.00_and_a.b"}
    monkeypatch.chdir("run.v1")
    assert main(["plot", ".", "x"]) == 0
    assert Path("run.v1.png").is_file()


def test_names_of_outputs_are_those_of_links(files: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """PY-06, PY-07: runs that are given as links to folders of one name have pages and pictures of their own."""
    monkeypatch.chdir(files)
    for link, number in (("monday", 1), ("tuesday", 2)):
        assert main(["run", "there.py", "--report", f"{number}/report"]) == 0
        Path(link).symlink_to(f"{number}/report")
        assert main(["plot", link, "x"]) == 0
    assert main(["report", "monday", "tuesday"]) == 0
    assert {path.name for path in files.glob("*.png")} == {"monday.png", "tuesday.png"}
    assert [path.name for path in files.glob("*.html")] == ["monday_and_tuesday.html"]


@pytest.mark.parametrize(
    ("command", "text"),
    [
        (["cam", "own.yaml", "--yaml", "own.yaml"], "points: [{x: 0, y: 0}, {x: 1, y: 1}, {x: 2, y: 1}]\n"),
        (["cam", "own.csv", "--csv", "./own.csv"], "x,y\n0,0\n1,1\n2,1\n"),
        (["track", "own.svg", "--plot", "own.svg"], "<svg/>"),
        (["path", "own.csv", "--csv", "own.csv"], "x,y,z\n1,0,0\n"),
    ],
)
def test_an_input_is_not_written(
    command: list[str], text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """PY-07: whatever the two are called."""
    monkeypatch.chdir(tmp_path)
    Path(command[1]).write_text(text)
    assert main(command) == 2
    assert "is a file that is read, so it is not written" in capsys.readouterr().err
    assert Path(command[1]).read_text() == text


@pytest.mark.parametrize("command", [["cam", "d/machine.yaml"], ["cam", "cam.csv", "--machine", "d/machine.yaml"]])
@pytest.mark.parametrize("target", ["points.csv", "elements.csv"])
def test_a_file_that_a_machine_names_is_not_written(
    target: str, command: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """PY-07, CAM-04: the tables of its cams and paths, whose names are relative to its folder."""
    monkeypatch.chdir(tmp_path)
    Path("cam.csv").write_text(points := "x,y\n0,0\n1,1\n2,1\n")
    Path("d").mkdir()
    Path("d/points.csv").write_text(points)
    Path("d/elements.csv").write_text(elements := "x,y,z\n1,0,0\n")
    Path("d/machine.yaml").write_text(
        f"{MACHINE}paths: [{{name: p, file: elements.csv}}]\n"
        "cams: [{name: c, x_unit: mm, y_unit: mm, file: points.csv}]\n"
    )
    if command[1] == "cam.csv":
        command = [*command, "--axis", "x"]
    assert main([*command, "--csv", f"d/{target}"]) == 2
    assert (
        capsys.readouterr().err == f"takt: d/{target}: is a file that is read, so it is not written: give another one\n"
    )
    assert (Path("d/points.csv").read_text(), Path("d/elements.csv").read_text()) == (points, elements)
