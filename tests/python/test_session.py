"""PY-02, PY-03: sessions, axes and feedback, the same in process and on a running engine."""

from __future__ import annotations

import inspect
import itertools
import json
import math
import subprocess
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import takt
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from machines import MACHINE, UNKNOWN, new_url, running, taktd
from takt import _core
from takt.arguments import to_text
from takt.session import CLASSES as COMPONENTS

REFERENCE: dict[str, Any] = json.loads(subprocess.check_output([taktd(), "--reference"]))
VERBS = {v["name"]: v for v in REFERENCE["verbs"] if v["target_kind"] == "axis"}
# What has the commands of each kind of component as methods.
CLASSES: dict[str, type] = {"machine": takt.Session, **COMPONENTS}
# Not those that the engine gives to itself, or that feedback objects and heartbeats give.
METHODS = [
    v
    for v in REFERENCE["verbs"]
    if v["target_kind"] != "machine" or v["name"] not in ("fail_all_axes", "release", "renew")
]


@pytest.fixture(params=["in process", "over LCM"])
def session(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[takt.Session]:
    if request.param == "in process":
        with takt.Engine(MACHINE) as engine:
            yield engine
        return
    url = new_url()
    with running(tmp_path, url), takt.connect(url) as remote:
        yield remote


@pytest.fixture
def engine() -> Iterator[takt.Engine]:
    with takt.Engine(MACHINE) as made:
        yield made


# --- the same on both (PY-02) ---


def test_a_scenario_runs_unchanged_on_both(session: takt.Session) -> None:
    """PY-02, PY-03, AX-20, AX-30, AX-31, AX-33, AX-36: commands as methods, feedback objects, published values."""
    x, r = session.axis("x"), session.axis("r")
    assert list(session.axes) == ["x", "r"]
    assert (x.state, x.powered, x.unit, r.unit) == (takt.PlcState.DISABLED, False, "mm", "deg")
    x.power()
    r.power().wait()
    session.wait(lambda: x.powered, 5.0)
    assert x.state is takt.PlcState.STANDSTILL

    recorder = session.record()
    session.mark("off we go", "x")
    move = x.move_absolute(position=50.0, velocity=200.0)
    assert (move.busy, move.done) == (True, False)
    turn = r.move_relative(distance=-90.0)
    assert move.wait() is move
    assert (move.busy, move.done) == (False, True)
    turn.wait()
    assert x.actual_position == pytest.approx(50.0, abs=0.05)
    assert r.actual_position == pytest.approx(270.0, abs=0.05)
    assert x.state is takt.PlcState.STANDSTILL

    ever = x.move_velocity(velocity=100.0).wait(until="reached")
    assert (ever.active, ever.reached) == (True, True)
    assert x.state == "ContinuousMotion"
    start = session.now
    session.run(0.2)
    assert session.now - start == pytest.approx(0.2, abs=0.05)
    halt = x.halt().wait()
    assert halt.done
    assert ever.wait_final().aborted
    with pytest.raises(takt.CommandError, match="aborted by another command"):
        ever.wait()

    recording = recorder.stop()
    assert recorder.stop() is recording
    assert set(recording) == {"x", "r"}
    assert recording.unit("x", "set_velocity") == "mm/s"
    assert recording.unit("r", "set_acceleration") == "deg/s²"
    assert recording.info("r")["modulus"] == 360
    assert recording.info("x")["limits"]["position"] == [-10.0, 1000.0]
    assert "ContinuousMotion" in recording.text("x", "state")
    assert [e.text for e in recording.events if e.kind == "mark"] == ["off we go"]
    assert {"start", "end"} <= {e.kind for e in recording.events if e.component == "x"}
    assert np.all(np.diff(recording["x"]["cycle"]) > 0)


def test_a_bad_command_is_an_error_at_once(session: takt.Session) -> None:
    """EN-22, PY-02: what the engine cannot read comes back as a feedback with a sentence, the same on both."""
    x = session.axis("x")
    x.power().wait()
    nan = x.move_absolute(position=math.nan)
    assert nan.error
    assert nan.error_id == 5
    assert "position: expected a finite number" in nan.sentence
    assert x.move_absolute(position=1.0, velocity=-1.0).error
    assert x.move_absolute(position=1.0, velocity=501.0).error  # AX-06: beyond the axis' own limits
    assert x.move_absolute(position="far").error  # type: ignore[arg-type]
    assert session.command("x", "move_abs").sentence.endswith("did you mean move_absolute?")
    assert session.command("z", "halt").error_id == 3010
    far = x.move_absolute(position=2000.0).wait_final()  # AX-83: this one is found out by the axis
    assert (far.error, far.error_id) == (True, 8)
    with pytest.raises(takt.CommandError, match=r"^x.move_absolute \{position: 2000\.0\}: .*limit, .*\(error 8\)$"):
        far.wait()
    assert x.state is takt.PlcState.STANDSTILL


def test_level_sensitive_commands_are_released(session: takt.Session) -> None:
    """AX-37, AX-39, EN-23: a jog and a held stop act until they are released, also longer than the dead man's time."""
    x = session.axis("x")
    x.power().wait()
    jog = x.jog(forward=True, velocity=50.0).wait(until="active")
    session.run(1.2)
    assert jog.active
    assert x.set_velocity == pytest.approx(50.0)
    jog.release()
    assert jog.wait().done
    assert x.set_velocity == 0
    slow = x.jog(forward=True, velocity=50.0, deceleration=40.0).wait(until="active")
    session.run(0.2)
    slow.release()
    assert slow.wait().done  # though the ramp is longer than the dead man's time
    stop = x.stop(hold=True).wait()
    session.run(1.2)
    assert x.state is takt.PlcState.STOPPING
    assert x.move_relative(distance=1.0).wait_final().error
    stop.release()
    session.wait(lambda: x.state is takt.PlcState.STANDSTILL, 1.0)


def test_waiting_ends_in_time(session: takt.Session) -> None:
    """PY-03: time-outs count engine time and say what was waited for."""
    x = session.axis("x")
    x.power().wait()
    with pytest.raises(takt.TimeoutError, match=r"still active, not reached after 0\.05 s"):
        x.move_absolute(position=900.0, velocity=10.0).wait(0.05, until="reached")
    with pytest.raises(takt.TimeoutError, match=r"the moon: not met within 0\.05 s"):
        session.wait(lambda: False, 0.05, what="the moon")
    with pytest.raises(ValueError, match="until is one of"):
        x.halt().wait(until="soon")  # type: ignore[arg-type]
    session.stop_all(open_loops=True).wait()
    session.wait(lambda: x.state is takt.PlcState.DISABLED, 2.0)


def test_programs_are_called(session: takt.Session) -> None:
    calls: list[float] = []

    @session.program
    def scan() -> None:
        calls.append(session.now)

    session.run(0.1)
    assert len(calls) >= 5
    assert calls == sorted(calls)


def test_a_closed_session_says_so(session: takt.Session) -> None:
    recorder = session.record("x")
    session.run(0.05)
    session.close()
    session.close()
    assert len(recorder.recording["x"]) > 0
    for use in (
        lambda: session.run(1.0),
        lambda: session.run(0),
        lambda: session.axis("x").halt(),
        lambda: session.record(),
        lambda: session.mark("here"),
        lambda: session.program(lambda: None),
        lambda: session.wait(lambda: True),
        session.__enter__,
    ):
        with pytest.raises(takt.ClosedError):
            use()


# --- in process ---


def test_virtual_time_is_the_same_each_time() -> None:
    """EN-06: bit for bit."""

    def once() -> tuple[list[int], bytes]:
        with takt.Engine(MACHINE, journal=True) as engine:
            recorder = engine.record()
            engine.axis("x").power().wait()
            engine.axis("r").power().wait()
            engine.axis("r").move_velocity(velocity=123.4)
            engine.axis("x").move_absolute(position=77.7).wait()
            engine.run(0.5)
            _, hashes = engine.take_hashes()
            return hashes.tolist(), recorder.stop()["r"].tobytes()

    assert once() == once()


def test_every_cycle_is_recorded(engine: takt.Engine) -> None:
    """PY-04: full rate, or one row in so many cycles, of the axes that are named."""
    every = engine.record("x", every=5)
    full = engine.record()
    engine.step(100)
    assert full.stop()["x"]["cycle"].tolist() == list(range(100))
    assert every.stop()["x"]["cycle"].tolist() == list(range(0, 100, 5))
    assert list(every.recording) == ["x"]
    assert full.recording["x"]["time_s"][-1] == pytest.approx(0.099)
    assert full.recording["x"].dtype["loop_closed"] == np.dtype(bool)
    with pytest.raises(takt.TaktError, match="did you mean 'x'"):
        engine.record("x1")


@pytest.mark.parametrize("error", [KeyboardInterrupt, MemoryError])
def test_an_interrupted_end_of_a_recording_is_not_tried_again(
    error: type[BaseException], engine: takt.Engine, monkeypatch: pytest.MonkeyPatch
) -> None:
    """PY-04: the cause comes through `close`, other recordings are ended, and the lost one says that it is lost."""
    other = engine.record("r")
    engine.run(0.1)

    def interrupted(*_: object) -> None:
        raise error

    with monkeypatch.context() as patch:
        patch.setattr("takt.engine.make_recording", interrupted)
        with pytest.raises(error), engine.record("x") as recorder:
            recorder.stop()
    assert not recorder.running
    engine.close()
    assert len(other.recording["r"]) == 100
    for ended in (recorder.stop, lambda: recorder.recording):
        with pytest.raises(takt.TaktError, match="the recording is lost"):
            ended()
    assert repr(recorder) == "<Recorder of x: lost>"


def test_where_loads_really_are_is_known_of_simulated_servos() -> None:
    """EN-11: beside what encoders make of it: play, counts, turns."""
    text = """
name: press
axes:
  - {name: x, unit: deg, kind: rotary, limits: {velocity: 720, acceleration: 7200, jerk: 720000}, supervision: {}}
simulation:
  servos:
    - axis: x
      mechanics: {backlash: 0.5, coulomb_friction: 0.01}
"""
    with takt.Engine(text) as engine:
        x = engine.axis("x")
        recorder = engine.record()
        x.power().wait()
        x.move_relative(distance=500).wait()
        x.move_relative(distance=-20).wait()
        engine.run(0.2)
        table = recorder.stop()["x"]
    assert table["actual_position"][-1] == pytest.approx(120, abs=0.01)
    assert table["true_position"][-1] == pytest.approx(480.25, abs=0.05)  # over all turns, at the other end of the play
    assert table["true_position"].max() == pytest.approx(499.75, abs=0.05)


def test_the_cycle_time_can_be_overruled() -> None:
    """EN-01."""
    with takt.Engine(MACHINE, period=0.002) as engine:
        engine.step(10)
        assert engine.now == pytest.approx(0.02)
    with pytest.raises(takt.ConfigError, match="period"):
        takt.Engine(MACHINE, period=1.0)


def test_a_broken_machine_says_everything(tmp_path: Path) -> None:
    """EN-10: all problems with file, line and column; nothing is started."""
    file = tmp_path / "bad.yaml"
    file.write_text(MACHINE.replace("velocity: 500", "velocitty: 500").replace("kind: rotary", "kind: round"))
    with pytest.raises(takt.ConfigError) as caught:
        takt.Engine(file)
    assert len(caught.value.problems) >= 2
    assert all(problem.startswith(f"{file}:") for problem in caught.value.problems)
    assert "did you mean velocity?" in str(caught.value)
    with pytest.raises(takt.ConfigError, match="cannot be read"):
        takt.Engine(tmp_path / "none.yaml")


@pytest.mark.parametrize("raw", [b"\xff\xfe", b"a: \x04", bytes(range(256)) * 40_000, b"- " * 100_000, b"[" * 100_000])
def test_bytes_that_are_no_machine(raw: bytes, tmp_path: Path) -> None:
    """EN-10: 10 MB of anything is refused with sentences."""
    file = tmp_path / "raw.yaml"
    file.write_bytes(raw)
    with pytest.raises(takt.ConfigError) as caught:
        takt.Engine(file)
    assert len(caught.value.problems) <= 201


def test_more_commands_than_fit_are_refused(engine: takt.Engine) -> None:
    """EN-22: a full queue refuses; nothing is lost that was accepted."""
    feedback = [engine.axis("x").reset() for _ in range(5000)]
    refused = [f for f in feedback if f.error]
    assert refused
    assert {f.error_id for f in refused} == {3012}
    engine.run(0.4)
    assert all(f.final for f in feedback)
    assert engine.figures["commands_refused"] == len(refused)


def test_a_refused_release_is_given_again(engine: takt.Engine) -> None:
    """EN-22: a jog that was let go of ends, though the queue was full at that moment."""
    x = engine.axis("x")
    x.power().wait()
    jog = x.jog(forward=True, velocity=50.0).wait(until="active")
    while not engine.axis("r").reset().error:
        pass
    while not engine.command("machine", "release", {"ticket": 1}).error:  # these have some room of their own
        pass
    assert jog.release().error
    assert jog.wait(2.0).done


def test_programs_must_not_let_time_pass(engine: takt.Engine) -> None:
    engine.program(lambda: engine.run(0.1))
    with pytest.raises(takt.TaktError, match="cannot let time pass"):
        engine.step()


def test_stepping_releases_the_gil(engine: takt.Engine) -> None:
    """PY-08: other threads of Python run while the engine steps."""
    thread = threading.Thread(target=lambda: engine._core.step(400_000))
    thread.start()
    counted = 0
    while thread.is_alive():
        counted += 1
        time.sleep(0)
    thread.join()
    assert counted > 100
    assert engine.cycle == 400_000


def test_shutting_down(engine: takt.Engine) -> None:
    """EN-08: everything stops along its ramp, the loops open, further commands are refused."""
    x = engine.axis("x")
    x.power().wait()
    x.move_velocity(velocity=300.0).wait(until="reached")
    with engine.record("x") as recorder:
        engine.shut_down()
    takt.expect.within_limits(recorder.recording, "x")
    assert x.state is takt.PlcState.DISABLED
    assert x.power().wait_final().error_id == 3015


# --- described once (EN-11) ---


@pytest.mark.parametrize("verb", METHODS, ids=lambda v: f"{v['target_kind']}.{v['name']}")
def test_methods_are_as_described(verb: dict[str, Any]) -> None:
    """EN-11, PY-03: names, defaults, units and meanings of keyword arguments are those of the C++ description."""
    method = getattr(CLASSES[verb["target_kind"]], verb["name"])
    fields = {f["name"]: f for f in verb["arguments"]["fields"]}
    signature = inspect.signature(method)
    assert [p for p in signature.parameters if p != "self"] == list(fields)
    text = " ".join(method.__doc__.split())
    assert " ".join(verb["arguments"]["about"].split()) in text
    for name, field in fields.items():
        parameter = signature.parameters[name]
        assert parameter.kind is inspect.Parameter.KEYWORD_ONLY
        default = inspect.Parameter.empty if field["presence"] == "required" else field.get("default")
        assert parameter.default == (tuple(default) if isinstance(default, list) else default)
        assert field["about"] in text
        assert field.get("unit", "") in text
        assert field.get("range", {}).get("text", "") in text


def test_misspelt_arguments_are_type_errors(engine: takt.Engine) -> None:
    """PY-03."""
    with pytest.raises(TypeError, match="postion"):
        engine.axis("x").move_absolute(postion=1.0)  # type: ignore[call-arg]
    with pytest.raises(TypeError):
        engine.axis("x").move_absolute(1.0)  # type: ignore[misc]


def test_published_fields_are_as_described(engine: takt.Engine) -> None:
    """EN-11: properties, columns and the C++ description name the same fields."""
    for kind, outputs in REFERENCE["outputs"].items():
        assert kind in CLASSES
        names = []
        for field in outputs["fields"]:
            names += [f"{field['name']}_{part['name']}" for part in field["type"].get("fields", ())] or [field["name"]]
        assert [f[0] for f in _core.output_fields(kind)] == names
    for field in REFERENCE["outputs"]["axis"]["fields"]:
        value = getattr(engine.axis("x"), field["name"])
        assert type(value).__name__ in ("float", "int", "bool", "PlcState", "LimitedBy")


# The list of the GT-775x modules, appendix 12.1.
MODULE_ERRORS = {
    "ETime": 1,
    "EDistance": 2,
    "EDev": 3,
    "EBlanding": 4,
    "EParam": 5,
    "EAxStop": 6,
    "EAxis": 7,
    "Ecil": 8,
    "Ehome": 9,
    "Epower": 10,
    "Eerrstop": 11,
    "Econst": 12,
    "EpowerOff": 13,
    "ERRPOS": 2001,
    "ERRLIP": 2004,
    "ERRLIN": 2005,
    "ERRSWP": 2006,
    "ERRSWN": 2007,
    "ERRPOSG": 8001,
}


def test_errors_are_those_of_the_modules() -> None:
    """AX-84: their numbers and names; those of groups have no names there."""
    found = {error["name"]: error["id"] for error in REFERENCE["errors"]}
    assert {name: found.get(name) for name in MODULE_ERRORS} == MODULE_ERRORS
    assert {1000, 1001, 1003, 1004, 1005} <= set(found.values())
    numbers = [error["id"] for error in REFERENCE["errors"]]
    assert numbers == sorted(set(numbers))
    ours = [number for number in numbers if number not in MODULE_ERRORS.values() and number >= 1006]
    others = {17918, 20306, 20307, 20500, 20501}  # PP-40, CAM-12
    assert all(3000 < number < 4000 or number in others for number in ours)


def test_errors_have_texts() -> None:
    """AX-84, AX-23."""
    for error in REFERENCE["errors"]:
        assert takt.error_text(error["id"]) == error["text"]
        assert takt.error_name(error["id"]) == error["name"]
    assert takt.error_text(4711) == "unknown error"


def test_arguments_as_text() -> None:
    assert to_text({"a": 0.1, "b": None, "c": np.float64(1e-7), "d": np.int32(3), "e": True}) == (
        "{a: 0.1, c: 1e-07, d: 3, e: true}"
    )
    assert to_text({"d": takt.Direction.POSITIVE, "t": "on", "q": 'a "b"'}) == '{d: positive, t: "on", q: "a \\"b\\""}'
    assert to_text({"d": "positive"}, {"d": takt.Direction.POSITIVE}) == ""
    assert to_text({}) == ""


@pytest.mark.parametrize("name", ["Cell 😀", "𠮷", "é\u2028", "a\uffff"])
def test_characters_of_all_kinds(name: str) -> None:
    """EN-22: texts with characters beyond U+FFFF reach the engine as they are."""
    limits = {"velocity": 500, "acceleration": 5000, "jerk": 100000}
    with takt.Engine({"name": name, "axes": [{"name": "x", "unit": "mm", "limits": limits}]}) as session:
        assert session.machine["name"] == name
        gear = session.axis("x").gear_in(master=name).wait_final()
        assert gear.sentence == f"master: there is no axis '{name}'; there are x"


@pytest.mark.parametrize("arguments", UNKNOWN)
def test_a_refused_command_as_text(arguments: str, engine: takt.Engine) -> None:
    """EN-22: the names of a refused command are found in any text that the engine reads."""
    gear = engine.command("x", "gear_in", arguments).wait_final()
    assert gear.error_id == 3010
    assert gear.sentence.startswith(f"master: there is no axis '{UNKNOWN[arguments]}'; there are x")


# --- whatever comes in ---


def numbers(field: dict[str, Any]) -> bool:
    kind = field["type"]
    return "real" in (kind["kind"], kind.get("element", {}).get("kind"))


@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, 1e400, 1.7976931348623157e308, -1.7976931348623157e308])
def test_what_is_not_finite_is_refused(verb: str, bad: float, engine: takt.Engine) -> None:
    """EN-22, AX-06: NaN, infinity and what overflows, in each argument of each command."""
    fields = VERBS[verb]["arguments"]["fields"]
    axis = engine.axis("x")
    axis.power().wait()
    samples = {"real": 1.0, "integer": 1, "text": "r"}
    good: dict[str, object] = {
        f["name"]: samples.get(f["type"]["kind"], 1.0) for f in fields if f["presence"] == "required"
    }
    if verb == "jog":
        good["forward"] = True
    for field in filter(numbers, fields):
        feedback = engine.command("x", verb, good | {field["name"]: bad})
        if not math.isfinite(bad):
            assert feedback.error
            assert field["name"] in feedback.sentence
        engine.run(0.02)
        assert feedback.error
        assert math.isfinite(axis.set_position)


FUZZ = settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
NAMES = st.sampled_from(["x", "r", "machine"]) | st.text()
VERB_NAMES = st.sampled_from([v["name"] for v in REFERENCE["verbs"]]) | st.text()
PIECES = st.sampled_from("{ } [ ] : , ' \" # & * ! | > - ? % @ position velocity ticket 1 1e5 -3 .nan ~ true".split())
TEXTS = st.text() | st.lists(PIECES | st.text(max_size=3), max_size=20).map(" ".join)


@FUZZ
@given(target=NAMES, verb=VERB_NAMES, arguments=TEXTS)
def test_random_text_is_answered(engine: takt.Engine, target: str, verb: str, arguments: str) -> None:
    """EN-22: whatever is asked, there is an answer, and a sentence where it is an error."""
    feedback = engine.command(target, verb, arguments)
    engine.run(0.01)
    assert feedback.sentence or not feedback.error
    assert all(math.isfinite(axis.set_position) for axis in engine.axes.values())


@FUZZ
@given(text=st.text() | st.binary().map(lambda raw: raw.decode("latin-1")))
def test_random_text_is_no_machine(text: str) -> None:
    """EN-10."""
    with pytest.raises(takt.ConfigError):
        takt.Engine(text + "\n")


# --- misuse ---


def test_what_is_no_number_or_name_is_said_in_a_sentence(engine: takt.Engine) -> None:
    any_kind: Any = takt.Engine  # whatever types say
    any_engine: Any = engine
    x = any_engine.axis("x")
    wrong: list[tuple[Any, type[Exception], str]] = [
        (lambda: any_kind(MACHINE, period="1"), TypeError, "a period is a number of seconds, not '1'"),
        (lambda: any_kind(""), takt.ConfigError, "the path of the machine file is empty"),
        (lambda: any_kind(5), TypeError, "a machine is the path of a file, its text, or a dict, not 5"),
        (lambda: any_engine.axis(None), TypeError, "an axis goes by its name, not by None"),
        (lambda: any_engine.step(1.5), TypeError, "a number of cycles is a whole number, not 1.5"),
        (lambda: any_engine.step(-1), ValueError, "a number of cycles is a whole number from 0 on, not -1"),
        (lambda: any_engine.run(math.nan), ValueError, "a duration is a number of seconds from 0 on, not nan"),
        (lambda: any_engine.run("1"), TypeError, "a duration is a number of seconds, not '1'"),
        (lambda: any_engine.record(every=1.5), TypeError, "every is a whole number, not 1.5"),
        (
            lambda: any_engine.wait(lambda: False, math.nan),
            ValueError,
            "a timeout is a number of seconds from 0 on, not nan",
        ),
        (lambda: any_engine.wait(None), TypeError, "a condition is a function, not None"),
        (lambda: x.power().wait("active"), TypeError, "a timeout is a number of seconds, not 'active'"),
        (lambda: any_engine.program(None), TypeError, "a program is a function, not None"),
        (lambda: any_engine.command(5, "halt"), TypeError, "the target of a command is a text, not 5"),
        (lambda: any_engine.command("x", 6), TypeError, "the verb of a command is a text, not 6"),
        (
            lambda: any_engine.command("x", "halt", 7),
            TypeError,
            "the arguments of a command are a mapping or a text, not 7",
        ),
        (
            lambda: any_engine.command("x", "move_absolute", {"position: 1, velocity": 3}),
            ValueError,
            "'position: 1, velocity' is no name of an argument",
        ),
    ]
    for use, kind, sentence in wrong:
        with pytest.raises(kind) as raised:
            use()
        assert str(raised.value) == sentence


def test_programs_that_wait_for_changes(engine: takt.Engine) -> None:
    """PY-24, PY-08: called where a value changed since the last call, at the time asked for, or when woken; looks are
    those of a program that is called at each of them."""
    calls: list[int] = []
    states: list[tuple[int, takt.PlcState]] = []
    asks: list[float | None] = [None]

    def scan() -> float | None:
        calls.append(engine.cycle)
        return asks[0]

    engine.program(scan, every=5, on=["x.state"])
    engine.program(lambda: states.append((engine.cycle, engine.axis("x").state)), every=5)
    engine.step(12)
    assert calls == [0]  # nothing has changed since
    engine.axis("x").power()
    engine.step(400)
    seen = [after[0] for before, after in itertools.pairwise(states) if before[1] != after[1]]
    assert seen
    assert calls == [0, *seen]

    calls.clear()
    engine.wake(scan)
    asks[0] = 12 * engine.period
    begin = engine.cycle
    engine.step(41)
    first = begin + -begin % 5
    assert calls == [first, first + 15, first + 30]  # the first look that is not before the time

    for wrong, kind, sentence in (
        (["x.stat"], takt.TaktError, "'x' publishes no 'stat'; did you mean 'state'?"),
        (["state"], takt.TaktError, "'state' is not of the form component.field"),
        ("x.state", TypeError, "on is a list of published values, not the text 'x.state'"),
    ):
        with pytest.raises(kind) as raised:
            engine.program(scan, on=wrong)
        assert str(raised.value) == sentence
    asks[0] = -1
    engine.wake(scan)
    with pytest.raises(TypeError, match="a program with `on` returns s until its next call, or None, not -1"):
        engine.step(10)


def test_a_name_that_is_no_text() -> None:
    """PY-07: what could not be read is told once."""
    text = (
        "name: m\naxes: [{name: 5, limits: {velocity: 1, acceleration: 1, jerk: 1}}]\ncams: [{name: 7, points: []}]\n"
    )
    with pytest.raises(takt.ConfigError) as refused:
        takt.Engine(text)
    assert [problem.split(", which")[0] for problem in refused.value.problems if "name" in problem] == [
        "machine:2:15: axes[0].name: expected text, found '5'",
        "machine:3:15: cams[0].name: expected text, found '7'",
    ]


def test_what_is_woken_is_a_program(engine: takt.Engine) -> None:
    """PY-24: another function is refused, not ignored."""
    with pytest.raises(takt.TaktError, match=r"<built-in function print> is no program of this session"):
        engine.wake(print)


def test_marks_belong_to_components(engine: takt.Engine) -> None:
    """PY-02: names that there are not, and objects, are refused as `record` does."""
    with engine.record() as recorder:
        engine.mark("here", axis="x")
        engine.mark("there")
        with pytest.raises(takt.TaktError, match="no axis or other component 'xx'; did you mean 'x'"):
            engine.mark("nowhere", axis="xx")
        with pytest.raises(TypeError, match="goes by its name, not by <Axis"):
            engine.mark("nowhere", axis=engine.axis("x"))  # type: ignore[arg-type]
        engine.step()
    assert [event[1:3] for event in recorder.recording.events] == [("x", "here"), ("", "there")]


def test_programs_and_conditions_every_so_many_cycles(engine: takt.Engine) -> None:
    """PY-24: what need not look into every cycle holds the engine up less."""
    seen: list[int] = []
    every: list[int] = []
    asked: list[int] = []
    engine.program(lambda: seen.append(engine.cycle), every=5)
    engine.step(12)
    assert seen == [0, 5, 10]
    engine.program(lambda: every.append(engine.cycle))
    engine.step(4)
    assert (seen, every) == ([0, 5, 10, 15], [12, 13, 14, 15])
    engine.wait(lambda: asked.append(engine.cycle) or engine.cycle >= 30, every=7)
    assert asked[-1] >= 30
    for wrong in (0, -1, 1.5, True):
        with pytest.raises((ValueError, TypeError)):
            engine.program(lambda: None, every=wrong)  # type: ignore[arg-type]
