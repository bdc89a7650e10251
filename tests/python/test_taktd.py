"""The command line of taktd, as a process of its own."""

import json
import os
import random
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest
import takt

MACHINE = """\
name: two_axes
axes:
  - name: x
    limits: {velocity: 100, acceleration: 1000, jerk: 20000}
  - name: y
    unit: deg
    limits: {velocity: 100, acceleration: 1000, jerk: 20000}
"""

TAKTD = shutil.which("taktd")
pytestmark = pytest.mark.skipif(TAKTD is None, reason="taktd is not on the PATH")


@pytest.fixture
def machine(tmp_path: Path) -> Path:
    path = tmp_path / "machine.yaml"
    path.write_text(MACHINE)
    return path


def taktd(*arguments: object, prefix: tuple[str, ...] = ()) -> subprocess.CompletedProcess[str]:
    command = [*prefix, str(TAKTD), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)


def wait_for_greeting(process: subprocess.Popen[str]) -> None:
    assert process.stdout is not None
    assert "two_axes" in process.stdout.readline()


def test_check_says_ok(machine: Path) -> None:  # EN-01
    result = taktd("--check", machine)
    assert (result.returncode, result.stdout, result.stderr) == (0, "ok\n", "")


def test_check_says_every_problem_with_its_place(machine: Path) -> None:  # EN-01, EN-10
    machine.write_text(MACHINE.replace("jerk: 20000", "jrek: 20000").replace("unit: deg", "unit: 5s\n    colour: red"))
    result = taktd("--check", machine)
    assert result.returncode == 2
    assert result.stdout == ""
    lines = result.stderr.splitlines()
    assert len(lines) >= 3
    assert all(line.startswith(f"{machine}:") for line in lines)


@pytest.mark.parametrize("size", [0, 1, 1000, 10_000_000])
def test_random_bytes_as_machine_file(tmp_path: Path, size: int) -> None:  # EN-10
    path = tmp_path / "random.yaml"
    path.write_bytes(random.Random(size).randbytes(size))
    result = taktd("--check", path)
    assert result.returncode == 2
    assert 1 <= len(result.stderr.splitlines()) <= 250


def test_schema_and_reference_are_json() -> None:  # EN-01, EN-11
    schema = json.loads(taktd("--schema").stdout)
    assert "axes" in schema["properties"]
    reference = json.loads(taktd("--reference").stdout)
    verbs = {(verb["target_kind"], verb["name"]) for verb in reference["verbs"]}
    assert {("axis", "move_absolute"), ("axis", "jog"), ("machine", "stop_all")} <= verbs
    assert {error["id"] for error in reference["errors"]} >= {1, 13, 1000, 2001, 3012, 8001}
    assert all(error["name"] and error["text"] for error in reference["errors"])


def test_version_and_help() -> None:  # EN-01
    assert taktd("--version").stdout.strip()[0].isdigit()
    text = taktd("--help").stdout
    for option in (
        "--cycle-time",
        "--pace",
        "--duration",
        "--lcm-url",
        "--no-lcm",
        "--log",
        "--check",
        "--schema",
        "--version",
    ):
        assert option in text


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["no_such_file.yaml"],
        ["MACHINE", "--no-such-option"],
        ["MACHINE", "--pace", "warp"],
        ["MACHINE", "--cycle-time", "5us"],
        ["MACHINE", "--cycle-time", "nan"],
        ["MACHINE", "--duration", "-1"],
        ["MACHINE", "--duration", "0"],
        ["MACHINE", "--duration", "nan"],
        ["MACHINE", "--cpu", "-1"],
        ["MACHINE", "--lcm-url", ""],
        ["MACHINE", "--no-lcm", "--log", "MACHINE"],
        ["MACHINE", "--lcm-url", "nonsense"],
        ["MACHINE", "--lcm-url", "udpm://239.255.76.67"],
        ["MACHINE", "--no-lcm", "--log", "/no/such/folder/run.lcmlog"],
    ],
)
def test_mistakes_are_one_line_and_exit_code_2(machine: Path, arguments: list[str]) -> None:  # EN-01
    result = taktd(*[machine if argument == "MACHINE" else argument for argument in arguments])
    assert result.returncode == 2
    assert result.stdout == ""
    assert len(result.stderr.splitlines()) == 1
    assert machine.read_text() == MACHINE


@pytest.mark.parametrize(
    ("name", "url"),
    [
        ("two_axes", "http://example"),
        ("two_axes", ""),
        ('""', "memq://"),
        (r'"a\nb"', "memq://"),
        ("a" * 65, "memq://"),
    ],
)
def test_check_refuses_names_and_urls_that_cannot_be(machine: Path, name: str, url: str) -> None:  # EN-10
    machine.write_text(MACHINE.replace("two_axes", name) + f'lcm: {{url: "{url}"}}\n')
    result = taktd("--check", machine)
    assert result.returncode == 2
    assert len(result.stderr.splitlines()) == 1
    assert "name: expected" in result.stderr or "lcm.url: " in result.stderr


@pytest.mark.parametrize(
    ("usual", "in_file", "option", "joined"),
    [
        ("", "", "", "udpm://239.255.76.67:7667?ttl=0"),
        ("memq://usual", "", "", "memq://usual"),
        ("memq://usual", "memq://file", "", "memq://file"),
        ("memq://usual", "memq://file", "memq://option", "memq://option"),
        ("nonsense", "", "memq://option", "memq://option"),
    ],
)
def test_the_network_of_a_run(
    machine: Path, monkeypatch: pytest.MonkeyPatch, usual: str, in_file: str, option: str, joined: str
) -> None:
    """EN-01: --lcm-url, else the machine file, else LCM_DEFAULT_URL, as clients have it, else the one on this host."""
    monkeypatch.setenv("LCM_DEFAULT_URL", usual)
    if in_file:
        machine.write_text(f'{MACHINE}lcm: {{url: "{in_file}"}}\n')
    options = ["--lcm-url", option] if option else []
    result = taktd(machine, "--duration", 0.01, "--pace", "fast", *options)
    assert result.returncode == 0, result.stderr
    assert result.stdout.splitlines()[0].endswith(f", on {joined}")
    assert result.stdout.count(" on ") == 1


def test_a_usual_network_that_cannot_be(machine: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LCM_DEFAULT_URL", "nonsense")
    result = taktd(machine, "--duration", 0.01)
    assert result.returncode == 2
    assert result.stderr.startswith("LCM_DEFAULT_URL: LCM URL 'nonsense': expected one like udpm://")
    assert taktd("--check", machine).returncode == 0
    assert " on " not in taktd(machine, "--no-lcm", "--pace", "fast", "--duration", 0.01).stdout


@pytest.mark.skipif(
    subprocess.run(["unshare", "-n", "true"], capture_output=True, check=False).returncode != 0,
    reason="no right to make a network of one's own",
)
def test_absent_network_names_the_route_command(machine: Path) -> None:
    result = taktd(machine, "--duration", 1, prefix=("unshare", "-n"))
    assert result.returncode == 2
    assert result.stdout == ""
    assert len(result.stderr.splitlines()) == 1
    assert "ip route add 224.0.0.0/4 dev lo" in result.stderr


@pytest.mark.parametrize(("cycle_time", "cycles"), [("250us", 40_000), ("1ms", 10_000), ("0.02", 500)])
def test_fast_runs_the_cycles_of_the_duration(machine: Path, cycle_time: str, cycles: int) -> None:  # EN-01
    result = taktd(machine, "--no-lcm", "--pace", "fast", "--duration", 10, "--cycle-time", cycle_time)
    assert result.returncode == 0, result.stderr
    assert f" {cycles} cycles" in result.stdout


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_the_first_signal_ends_in_order(machine: Path, tmp_path: Path, number: signal.Signals) -> None:  # EN-08
    log = tmp_path / "run.lcmlog"
    with subprocess.Popen(
        [str(TAKTD), str(machine), "--no-lcm", "--log", str(log)], stdout=subprocess.PIPE, text=True
    ) as process:
        wait_for_greeting(process)
        time.sleep(0.3)
        process.send_signal(number)
        output, _ = process.communicate(timeout=10)
    assert process.returncode == 0
    assert "stopped, all loops open" in output
    assert log.stat().st_size > 10_000


def start(machine: Path, *arguments: object) -> subprocess.Popen[str]:
    command = [str(TAKTD), str(machine), "--no-lcm", *map(str, arguments)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


@pytest.mark.parametrize("pace", ["paced", "fast"])
def test_a_second_signal_ends_although_the_log_blocks(machine: Path, tmp_path: Path, pace: str) -> None:  # EN-08
    fifo = tmp_path / "fifo"
    os.mkfifo(fifo)
    reader = os.open(fifo, os.O_RDONLY | os.O_NONBLOCK)  # which never reads
    try:
        with start(machine, "--pace", pace, "--log", fifo) as process:
            wait_for_greeting(process)
            time.sleep(1)
            process.send_signal(signal.SIGINT)
            with pytest.raises(subprocess.TimeoutExpired):
                process.wait(timeout=1)
            process.send_signal(signal.SIGINT)
            assert process.wait(timeout=3) == 130
    finally:
        os.close(reader)


def handles(process: subprocess.Popen[str], number: signal.Signals) -> bool:
    """Whether it has come as far as to have a handler for a signal, which would have ended it before."""
    assert process.poll() is None, "it has ended"
    status = Path(f"/proc/{process.pid}/status").read_text()
    return bool(int(status.split("SigCgt:")[1].split()[0], 16) >> (number - 1) & 1)


def test_a_signal_before_the_first_cycle_ends_in_order(machine: Path, tmp_path: Path) -> None:  # EN-08
    fifo = tmp_path / "fifo"
    os.mkfifo(fifo)
    with start(machine, "--log", fifo) as process:
        while not handles(process, signal.SIGINT):
            time.sleep(0.01)
        time.sleep(0.2)  # it waits for a reader of the log
        process.send_signal(signal.SIGINT)
        time.sleep(0.2)
        assert process.poll() is None
        with fifo.open("rb") as reader:
            log = reader.read()
        output, _ = process.communicate(timeout=10)
    assert process.returncode == 0
    assert "stopped, all loops open" in output
    assert log.startswith(b"\xed\xa1\xda\x01")


def test_a_full_disk_is_an_error(machine: Path) -> None:  # EN-07, EN-20
    result = taktd(machine, "--no-lcm", "--pace", "fast", "--duration", 1, "--log", "/dev/full")
    assert result.returncode == 1
    assert result.stderr.splitlines() == ["log file /dev/full is incomplete: No space left on device"]
    assert "the log is incomplete" in result.stdout
    assert "1 the log is incomplete" in taktd("--help").stdout


def test_a_reader_that_goes_is_an_error(machine: Path, tmp_path: Path) -> None:
    fifo = tmp_path / "fifo"
    os.mkfifo(fifo)
    with start(machine, "--pace", "paced", "--duration", 1, "--log", fifo) as process:
        with fifo.open("rb") as reader:
            reader.read(1000)
        output, problem = process.communicate(timeout=10)
    assert process.returncode == 1
    assert problem.splitlines() == [f"log file {fifo} is incomplete: Broken pipe"]
    assert "stopped, all loops open" in output


def test_what_a_machine_file_names_is_no_pipe(tmp_path: Path) -> None:
    """EN-37: what never ends is not waited for; more than there may be is not read."""
    os.mkfifo(tmp_path / "fifo")
    own = "name: m\naxes:\n" + "".join(
        f"  - {{name: {n}, limits: {{velocity: 9, acceleration: 9, jerk: 9}}}}\n" for n in "xyz"
    )
    group = "groups:\n  - name: g\n    axes: [x, y, z]\n    path: {velocity: 1, acceleration: 1, jerk: 1}\n"
    texts = {
        "paths": own + "paths:\n  - {name: p, file: fifo}\n",
        "cams": own + "cams:\n  - {name: c, file: fifo}\n",
        "urdf": own + group + "    kinematics: {serial: {urdf: fifo}}\n",
        "mesh": own
        + group
        + "    kinematics: {gantry: {axes: [x, y, z]}}\n    workspace:\n      obstacles:\n"
        + "        - {name: o, mesh: {file: fifo}}\n",
    }
    for name, text in texts.items():
        file = tmp_path / f"{name}.yaml"
        file.write_text(text)
        done = taktd(file, "--check")
        assert done.returncode == 2, done.stdout + done.stderr
        assert "fifo" in done.stdout + done.stderr
    endless = taktd("/dev/zero", "--check")
    assert endless.returncode == 2
    with pytest.raises(takt.ConfigError, match="8 MB"):
        takt.Engine("/dev/zero")
